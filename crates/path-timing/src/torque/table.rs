//! Tables within the torque of their motors.

use core::cell::Cell;

use super::{Dynamics, Lack, TorqueLimits, passes, slowed};
use crate::departure::{Speeds, Within};
use crate::number::larger_or_nan;
use crate::passes::segment_s;
use crate::place::Place;
use crate::planner::lay_all;
use crate::reciprocals::Reciprocals;
use crate::{Accuracy, Axes, AxisLimits, Knot, Path, PlanError, Rows, Span, Table};

/// A position-velocity-time table with which no motor gives more torque than it has.
///
/// It is run at its own feed, or evenly slower: a feed that changes from row to row, as that of a
/// [`Playback`](crate::Playback), takes accelerations of its own, for which no torque is planned.
#[derive(Debug, Clone, Copy)]
pub struct TorqueTable<'a, A: Axes> {
    table: Table<'a, A>,
}

impl<'a, A: Axes> TorqueTable<'a, A> {
    /// The rows in their order.
    #[must_use]
    pub fn rows(&self) -> Rows<'a, A> {
        self.table.rows()
    }

    /// The segments in their order.
    pub fn spans(&self) -> impl Iterator<Item = Span<A>> + use<'a, A> {
        self.table.spans()
    }

    /// Seconds from the first row to the last.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.table.duration_s()
    }
}

impl<D: Dynamics> TorqueLimits<D> {
    /// Plans the fastest table along paths, as [`Table::plan`] does, that keeps the limits of the
    /// axes and the torques of the motors. Jerk is not limited: `limits` with a jerk are planned
    /// without it.
    ///
    /// Where an axis has no limit of its own, give it a speed and an acceleration that it never
    /// reaches; knots are dense where these make the motion slow.
    ///
    /// # Errors
    /// [`PlanError`]; [`PlanError::Overload`] where a motor cannot hold what it carries against
    /// gravity and friction.
    pub fn plan<'a, P: Path<Axes = D::Axes>>(
        &self,
        paths: impl IntoIterator<Item = P>,
        limits: <D::Axes as Axes>::Of<AxisLimits>,
        segments: impl Fn(&P) -> u32,
        knots: &'a mut [Knot<D::Axes>],
    ) -> Result<TorqueTable<'a, D::Axes>, PlanError<P::Error>> {
        let limits = Reciprocals::checked(&limits)?;
        let lay = |place: &Place<'_, P>, free: &mut [Knot<D::Axes>]| {
            place.lay_resolved(segments(place.leg.path()), |segments| {
                place.lay_plainly(&limits, segments, 0.0, free)
            })
        };
        let knots = lay_all(paths.into_iter(), &limits, knots, lay)?;
        let Some([stretch, duration_s]) = self.time(&limits, knots)? else {
            return Err(overload(knots));
        };
        let table = Table::new(knots, limits, duration_s);
        Ok(TorqueTable {
            table: Table { stretch, ..table },
        })
    }

    /// Plans as [`plan`](Self::plan) does, with segments that keep a departure at any speeds, as
    /// [`Table::plan_within_at_any_feed`] makes them, and twice as many until the time changes by
    /// no more than `accuracy` allows.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan_within<'a, P: Path<Axes = D::Axes>>(
        &self,
        paths: impl IntoIterator<Item = P> + Clone,
        limits: <D::Axes as Axes>::Of<AxisLimits>,
        accuracy: Accuracy,
        departure: impl Fn(&P, &Span<D::Axes>) -> f64,
        knots: &'a mut [Knot<D::Axes>],
    ) -> Result<TorqueTable<'a, D::Axes>, PlanError<P::Error>> {
        accuracy.check()?;
        let limits = Reciprocals::checked(&limits)?;
        let within = Within {
            min_segments: accuracy.min_segments,
            allowed: accuracy.max_departure,
            speeds: Speeds::Any,
            departure,
            is_plain: true,
            planned: Cell::new(0),
        };
        let mut coarse_s = f64::INFINITY;
        let mut doublings = 0;
        loop {
            let lay = |place: &Place<'_, P>, free: &mut [Knot<D::Axes>]| {
                within.lay(place, &limits, doublings, free)
            };
            let laid = lay_all(paths.clone().into_iter(), &limits, knots, lay)?;
            let used = laid.len();
            doublings = doublings.saturating_add(1);
            let Some([stretch, duration_s]) = self.time(&limits, laid)? else {
                continue;
            };
            let best_s = duration_s - (coarse_s - duration_s).max(0.0);
            let ratio = accuracy.max_time_ratio;
            if !ratio.is_finite() || duration_s <= best_s * ratio {
                let (own, _) = knots.split_at(used.min(knots.len()));
                let table = Table::new(own, limits, duration_s);
                return Ok(TorqueTable {
                    table: Table { stretch, ..table },
                });
            }
            coarse_s = duration_s;
        }
    }

    /// Finds the speeds of knots; by what the table is then slowed, and its time. None where
    /// segments are so long that nothing is known of the torques between their ends.
    fn time<E>(
        &self,
        limits: &Reciprocals<D::Axes>,
        knots: &mut [Knot<D::Axes>],
    ) -> Result<Option<[f64; 2]>, PlanError<E>> {
        passes::fastest(self, limits, knots);
        let duration_s = check_moves(knots)?;
        let table = Table::new(knots, *limits, duration_s);
        let found = slowed(|speed| {
            let slower = table.at_speed(speed);
            slower.map_or(f64::NAN, |table| {
                let spans = table.spans().map(|span| self.utilisation(&span));
                spans.fold(0.0, larger_or_nan)
            })
        });
        match found.map(|speed| table.at_speed(speed)) {
            Ok(Ok(table)) => Ok(Some([table.stretch, table.duration_s()])),
            Err(Lack::Unknown) => Ok(None),
            _ => Err(overload(knots)),
        }
    }
}

/// The time of the knots' speeds, all of which let the machine move.
fn check_moves<A: Axes, E>(knots: &[Knot<A>]) -> Result<f64, PlanError<E>> {
    let mut time_s = 0.0;
    for (from, to) in knots.iter().zip(knots.iter().skip(1)) {
        let segment_s = segment_s(from, to);
        if !segment_s.is_finite() {
            return Err(overload(knots));
        }
        time_s += segment_s;
    }
    Ok(time_s)
}

/// The place at which no speed is low enough.
fn overload<A: Axes, E>(knots: &[Knot<A>]) -> PlanError<E> {
    let mut leg = 0_usize;
    for (from, to) in knots.iter().zip(knots.iter().skip(1)) {
        leg = leg.saturating_add(usize::from(from.ends_leg));
        if to.ds > 0.0 && !segment_s(from, to).is_finite() {
            return PlanError::Overload {
                leg,
                s: from.next_start(),
            };
        }
    }
    PlanError::Overload { leg: 0, s: 0.0 }
}
