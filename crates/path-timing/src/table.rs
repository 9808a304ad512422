//! Position-velocity-time tables along paths.

use core::cell::Cell;
use core::convert::Infallible;

use crate::accuracy::Planned;
use crate::departure::{Speeds, Within};
use crate::number::SMALLEST;
use crate::passes::fastest;
use crate::place::Place;
use crate::planner::{check_single_segments, duration, lay_all, time};
use crate::reciprocals::Reciprocals;
use crate::rows::Rows;
use crate::stepping::OfAxes;
use crate::stretch::stretch_between;
use crate::{Accuracy, Axes, AxisLimits, Knot, Path, PlanError, Span};

/// A position-velocity-time table along one path or several: every axis runs a cubic from each row
/// to the next, with the positions and slopes of the path at the rows.
///
/// It is a fastest table that keeps the limits of all axes. What is limited is the cubic itself:
/// its peak speed inside, its acceleration at both ends. With the path speeds w₀, w₁ at the ends of
/// a segment of length Δs, its duration is 2κΔs / (w₀ + w₁), with a κ from 5/6 to 6/5 for which an
/// axis at its limit of acceleration stays there, and none of a limit of jerk is used up by how the
/// path bends; 1 where a torque or a tool is limited, without jerk with fewer than 16 segments, and
/// in single precision. At the end of each path the machine does what that path's
/// [`corner`](Path::corner) says.
///
/// Where an axis has a limit of jerk: between rows a cubic has one jerk; at a row its acceleration
/// steps, which counts as a jerk over the time between the middles of the segments, and so does
/// what it changes by from one middle to the next: over many rows no more than the limit is left.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a, A: Axes> {
    pub(crate) knots: &'a [Knot<A>],
    pub(crate) limits: Reciprocals<A>,
    /// By what all times are multiplied.
    pub(crate) stretch: f64,
    pub(crate) duration_s: f64,
}

impl<'a, A: Axes> Table<'a, A> {
    /// Plans the table in memory of the caller: a knot for each row. `segments` says how many a
    /// path has: they are at least 2 from rest to rest, or from a slow corner to another, and up to
    /// 64 times as many where the slopes at the ends of one do not tell how the path goes between
    /// them.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan<P: Path<Axes = A>>(
        paths: impl IntoIterator<Item = P>,
        limits: A::Of<AxisLimits>,
        segments: impl Fn(&P) -> u32,
        knots: &'a mut [Knot<A>],
    ) -> Result<Self, PlanError<P::Error>> {
        let limits = Reciprocals::checked(&limits)?;
        let lay = |place: &Place<'_, P>, free: &mut [Knot<A>]| {
            place.lay_resolved(segments(place.leg.path()), |segments| {
                place.lay(&limits, segments, 0.0, free)
            })
        };
        let knots = lay_all(paths.into_iter(), &limits, knots, lay)?;
        let duration_s = time(&limits, knots)?;
        check_single_segments(&OfAxes, &limits, knots)?;
        Ok(Self::new(knots, limits, duration_s))
    }

    /// As [`plan`](Self::plan), for processors that compute in `f32` alone: speeds are found in
    /// single precision, positions and times stay in double. It takes a tenth of the instructions
    /// there, and the limits are kept as ever, with the margin that the rounding of `f32` asks for:
    /// less than 1 % of the time. Segments that are too long for their bend lose more, as they are not
    /// stretched for it: of 98 of 100 random motions up to 1.4 %, of the worst a third. Where an axis
    /// has a limit of jerk it is `plan`.
    ///
    /// Limits and lengths are to be within 1e-8 to 1e8.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan_in_f32<P: Path<Axes = A>>(
        paths: impl IntoIterator<Item = P>,
        limits: A::Of<AxisLimits>,
        segments: impl Fn(&P) -> u32,
        knots: &'a mut [Knot<A>],
    ) -> Result<Self, PlanError<P::Error>> {
        let exact = Reciprocals::checked(&limits)?;
        if exact.has_jerk() {
            return Self::plan(paths, limits, segments, knots);
        }
        let limits = Reciprocals::single(&limits)?;
        let lay = |place: &Place<'_, P>, free: &mut [Knot<A>]| {
            place.lay_resolved(segments(place.leg.path()), |segments| {
                place.lay_plainly(&limits, segments, 0.0, free)
            })
        };
        let knots = lay_all(paths.into_iter(), &exact, knots, lay)?;
        fastest(&limits, knots);
        let duration_s = duration(knots)?;
        check_single_segments(&OfAxes, &exact, knots)?;
        Ok(Self::new(knots, exact, duration_s))
    }

    /// Plans the table with about the fewest segments of each path that keep a departure.
    ///
    /// `departure` is a bound on what a controller departs by on a segment of a path, in any unit;
    /// it should fall with the number of segments. It holds at a constant feed; of a path that is
    /// passed without a stop at an end it holds at any speeds, as
    /// [`plan_within_at_any_feed`](Self::plan_within_at_any_feed) makes it.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan_within<P: Path<Axes = A>>(
        paths: impl IntoIterator<Item = P> + Clone,
        limits: A::Of<AxisLimits>,
        accuracy: Accuracy,
        departure: impl Fn(&P, &Span<A>) -> f64,
        knots: &'a mut [Knot<A>],
    ) -> Result<Self, PlanError<P::Error>> {
        Self::plan_accurately(paths, limits, accuracy, Speeds::Passing, departure, knots)
    }

    /// Plans the table as [`plan_within`](Self::plan_within) does, with segments that keep the
    /// departure at any speeds: also under feed changes, and where a [`Playback`](crate::Playback)
    /// is held at any row and resumed. These are several times as many.
    ///
    /// `departure` is asked for each segment from rest, to rest and at three ratios of the speeds
    /// between; the last segment of a path also from rest to rest. It must be largest at one of
    /// these, as a bound is that grows towards rest.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan_within_at_any_feed<P: Path<Axes = A>>(
        paths: impl IntoIterator<Item = P> + Clone,
        limits: A::Of<AxisLimits>,
        accuracy: Accuracy,
        departure: impl Fn(&P, &Span<A>) -> f64,
        knots: &'a mut [Knot<A>],
    ) -> Result<Self, PlanError<P::Error>> {
        Self::plan_accurately(paths, limits, accuracy, Speeds::Any, departure, knots)
    }

    fn plan_accurately<P: Path<Axes = A>>(
        paths: impl IntoIterator<Item = P> + Clone,
        limits: A::Of<AxisLimits>,
        accuracy: Accuracy,
        speeds: Speeds,
        departure: impl Fn(&P, &Span<A>) -> f64,
        knots: &'a mut [Knot<A>],
    ) -> Result<Self, PlanError<P::Error>> {
        accuracy.check()?;
        let limits = Reciprocals::checked(&limits)?;
        let within = Within {
            min_segments: accuracy.min_segments,
            allowed: accuracy.max_departure,
            speeds,
            departure,
            is_plain: false,
            planned: Cell::new(0),
        };
        let lay = |doublings, knots: &mut [Knot<A>]| {
            let lay = |place: &Place<'_, P>, free: &mut [Knot<A>]| {
                within.lay(place, &limits, doublings, free)
            };
            let own = lay_all(paths.clone().into_iter(), &limits, knots, lay)?;
            let duration_s = if within.planned.get() == own.len() {
                duration(own)?
            } else {
                time(&limits, own)?
            };
            let planned = Planned {
                stretch: 1.0,
                duration_s,
            };
            Ok((own.len(), Some(planned)))
        };
        let coarser_s = |knots: &mut [Knot<A>]| {
            stretch_all(&limits, knots);
            time::<_, Infallible>(&limits, knots).unwrap_or(f64::INFINITY)
        };
        let (knots, planned) = accuracy.plan(&limits, &OfAxes, knots, lay, coarser_s)?;
        Ok(Self::new(knots, limits, planned.duration_s))
    }

    pub(crate) fn new(knots: &'a [Knot<A>], limits: Reciprocals<A>, duration_s: f64) -> Self {
        Self {
            knots,
            limits,
            stretch: 1.0,
            duration_s,
        }
    }

    /// The same motion at a fraction of its speed, above 0 and at most 1: room for a feed above
    /// 100 %.
    ///
    /// # Errors
    /// [`PlanError::SpeedScale`].
    pub fn at_speed(&self, scale: f64) -> Result<Self, PlanError<Infallible>> {
        let min = self.stretch * SMALLEST;
        if scale >= min && scale <= 1.0 {
            return Ok(Self {
                stretch: self.stretch / scale,
                duration_s: self.duration_s / scale,
                ..*self
            });
        }
        Err(PlanError::SpeedScale { scale, min })
    }

    /// The number of rows: one more than segments; 0 without a path.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.knots.len()
    }

    /// Whether there is no path.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.knots.is_empty()
    }

    /// Seconds from the first row to the last.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The rows in their order.
    #[must_use]
    pub fn rows(&self) -> Rows<'a, A> {
        Rows::new(self.knots, self.stretch)
    }

    /// The segments in their order; which path each lies on is the `leg` of its second row.
    pub fn spans(&self) -> impl Iterator<Item = Span<A>> + use<'a, A> {
        let mut rows = self.rows();
        let first = rows.next();
        let knots = self.knots;
        let ends = knots.iter().zip(knots.iter().skip(1)).zip(rows);
        ends.scan(first, |before, ((from, to), row)| {
            let rows = [before.replace(row)?, row];
            let s = [from.next_start(), to.s];
            Some((to.ds > 0.0).then_some(Span { s, rows }))
        })
        .flatten()
    }
}

/// Stretches segments that are not, by their speeds.
fn stretch_all<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>]) {
    let mut from = None;
    for to in knots {
        if let Some(from) = from.replace(*to) {
            to.ds *= stretch_between(limits, [&from, to]);
        }
    }
}
