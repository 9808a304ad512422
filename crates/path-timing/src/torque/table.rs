//! Tables within the torque of their motors.

use core::cell::Cell;
use core::convert::Infallible;

use super::laden::Laden;
use super::{Dynamics, Lack, MORE, TorqueLimits, passes, slowed};
use crate::accuracy::Planned;
use crate::departure::{Speeds, Within};
use crate::knots::span;
use crate::number::larger_or_nan;
use crate::passes::segment_s;
use crate::place::Place;
use crate::planner::{check_single_segments, lay_all};
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
    fn new(knots: &'a [Knot<A>], limits: Reciprocals<A>, planned: Planned) -> Self {
        let table = Table::new(knots, limits, planned.duration_s);
        let stretch = planned.stretch;
        Self {
            table: Table { stretch, ..table },
        }
    }

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
    /// A leg with a segment that is too long for its torques to be bounded has twice the segments,
    /// or four times as many and so on.
    ///
    /// # Errors
    /// [`PlanError`]; [`PlanError::Overload`] where a motor cannot hold what it carries against
    /// gravity and friction, [`PlanError::TooCoarse`] where there is no memory for as many segments
    /// as its torques need.
    pub fn plan<'a, P: Path<Axes = D::Axes>>(
        &self,
        paths: impl IntoIterator<Item = P>,
        limits: <D::Axes as Axes>::Of<AxisLimits>,
        segments: impl Fn(&P) -> u32,
        knots: &'a mut [Knot<D::Axes>],
    ) -> Result<TorqueTable<'a, D::Axes>, PlanError<P::Error>> {
        let limits = self.reached(&limits)?;
        let lay = |place: &Place<'_, P>, free: &mut [Knot<D::Axes>]| {
            place.lay_resolved(segments(place.leg.path()), |segments| {
                let laid = place.lay_plainly(&limits, segments, 0.0, free)?;
                place.check_known(laid, free, |from, to| self.is_known(from, to))?;
                Ok(laid)
            })
        };
        let knots = lay_all(paths.into_iter(), &limits, knots, lay)?;
        let Some(planned) = self.time(&limits, knots)? else {
            return Err(self.too_coarse(&Table::new(knots, limits, 0.0)));
        };
        check_single_segments(&Laden(self), &limits, knots)?;
        Ok(TorqueTable::new(knots, limits, planned))
    }

    /// Plans as [`plan`](Self::plan) does, with segments that keep a departure at any speeds, as
    /// [`Table::plan_within_at_any_feed`] makes them.
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
        let limits = self.reached(&limits)?;
        let within = Within {
            min_segments: accuracy.min_segments,
            allowed: accuracy.max_departure,
            speeds: Speeds::Any,
            departure,
            is_plain: true,
            planned: Cell::new(0),
        };
        let lay = |doublings, knots: &mut [Knot<D::Axes>]| {
            let lay = |place: &Place<'_, P>, free: &mut [Knot<D::Axes>]| {
                within.lay(place, &limits, doublings, free)
            };
            let own = lay_all(paths.clone().into_iter(), &limits, knots, lay)?;
            Ok((own.len(), self.time(&limits, own)?))
        };
        let coarser_s = |knots: &mut [Knot<D::Axes>]| match self.time::<Infallible>(&limits, knots)
        {
            Ok(Some(planned)) => planned.duration_s,
            _ => f64::INFINITY,
        };
        let (knots, planned) = accuracy.plan(&limits, &Laden(self), knots, lay, coarser_s)?;
        Ok(TorqueTable::new(knots, limits, planned))
    }

    /// Finds the speeds of knots; what the table then takes. None where segments are so long that
    /// nothing is known of the torques between their ends.
    ///
    /// Segments that ask for more between their ends are planned anew with less of the torques,
    /// until the rest is little, and slowing the whole costs as little: where gravity helps a fast
    /// motion, a slower one asks for more.
    fn time<E>(
        &self,
        limits: &Reciprocals<D::Axes>,
        knots: &mut [Knot<D::Axes>],
    ) -> Result<Option<Planned>, PlanError<E>> {
        leave_all(knots);
        for _ in 0..ROUNDS_OF_SHARES {
            passes::fastest(self, limits, knots);
            let Ok(duration_s) = check_moves::<_, E>(knots) else {
                leave_all(knots);
                passes::fastest(self, limits, knots);
                break;
            };
            let most = self.lower_shares(knots);
            if most <= 1.0 + LITTLE {
                let table = Table::new(knots, *limits, duration_s);
                let slower = self.slow(&table, most);
                if let Some(slower) = slower.ok().filter(|slower| slower.stretch <= 1.0 + LITTLE) {
                    return Ok(Some(slower));
                }
            }
        }
        let table = Table::new(knots, *limits, check_moves(knots)?);
        match self.slow(&table, self.asked(&table)) {
            Ok(slower) => Ok(Some(slower)),
            Err(Lack::Unknown) => Ok(None),
            Err(Lack::Torque) => Err(overload(knots)),
        }
    }

    /// What a table that asks for so much at `most` takes, slowed until no motor lacks torque.
    fn slow(&self, table: &Table<'_, D::Axes>, most: f64) -> Result<Planned, Lack> {
        let slower = |speed| table.at_speed(speed);
        let speed = slowed(most, |speed| {
            slower(speed).map_or(f64::NAN, |table| self.asked(&table))
        })?;
        let table = slower(speed).map_err(|_| Lack::Torque)?;
        Ok(Planned {
            stretch: table.stretch,
            duration_s: table.duration_s(),
        })
    }

    /// The largest part of its torque that a motor is asked for.
    fn asked(&self, table: &Table<'_, D::Axes>) -> f64 {
        let spans = table.spans().map(|span| self.utilisation(&span));
        spans.fold(0.0, larger_or_nan)
    }

    /// The first segment between whose ends nothing is known of the torques.
    fn too_coarse<E>(&self, table: &Table<'_, D::Axes>) -> PlanError<E> {
        let unknown = |span: &Span<_>| !self.utilisation(span).is_finite();
        let (mut leg, mut s) = (0, 0.0);
        if let Some(Span {
            s: [from, _],
            rows: [_, to],
        }) = table.spans().find(unknown)
        {
            (leg, s) = (to.leg, from);
        }
        PlanError::TooCoarse { leg, s }
    }

    /// Leaves each segment that asks for more than there is a smaller share of the torques: that with
    /// which it would not have, as far as one round goes. What was asked at most, as a part of what
    /// there is.
    fn lower_shares(&self, knots: &mut [Knot<D::Axes>]) -> f64 {
        let mut most = 0.0;
        let mut rest = knots.iter_mut();
        let Some(mut from) = rest.next() else {
            return most;
        };
        for to in rest {
            if to.ds > 0.0 {
                let speeds = [from.speed, to.speed];
                let span = span([from, to], speeds, segment_s(from, to));
                let asked = self.utilisation(&span);
                let less = 1.0 + (asked - 1.0).max(0.0) * MORE;
                to.set_share(to.share() / less.min(MOST_AT_ONCE));
                most = larger_or_nan(most, asked);
            }
            from = to;
        }
        most
    }
}

/// Leaves each segment all of the torques.
fn leave_all<A: Axes>(knots: &mut [Knot<A>]) {
    for knot in knots {
        knot.set_share(1.0);
    }
}

/// What a segment's share of the torques is divided by at most in a round: a cubic that asks for
/// much between its ends, or for more than can be bounded, may ask for little a little slower.
const MOST_AT_ONCE: f64 = 1.2;

/// Rounds in which segments are left less of the torques.
const ROUNDS_OF_SHARES: u32 = 8;

/// A part of a torque, or of the speed, by which a whole table is slowed.
const LITTLE: f64 = 1e-3;

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
