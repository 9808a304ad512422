//! Position-velocity-time tables along paths.

use core::cell::Cell;
use core::convert::Infallible;

use crate::departure::{Speeds, Within, check_allowed};
use crate::knots::{Halving, are_resolved, halve};
use crate::number::SMALLEST;
use crate::passes::fastest;
use crate::place::Place;
use crate::planner::{check_single_segments, duration, lay_all, lost_on_single_segments, time};
use crate::reciprocals::Reciprocals;
use crate::rows::Rows;
use crate::stretch::stretch_between;
use crate::{Axes, AxisLimits, Knot, Path, PlanError, Span};

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

/// How near to the path and to the least time a table has to be.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct Accuracy {
    /// Fewest segments of each path.
    pub min_segments: u32,
    /// Largest bound of the tool's departure, in the unit of that bound.
    pub max_departure: f64,
    /// Largest time, relative to what more segments would reach: above 1, such as 1.02; infinite
    /// where the departure alone counts. It is judged by the change of the time with the number of
    /// segments, of which plans are made in the memory beside the table's: half as much again.
    /// Where there is no room for the segments with which that is sure, a plan is taken that
    /// changes by no more with the last doubling of them, unless finer plans have shown that it is
    /// slower.
    pub max_time_ratio: f64,
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
        check_single_segments(&limits, knots)?;
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
        check_single_segments(&exact, knots)?;
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
        // A number of doublings that is likely enough, for where there is no room to be sure, with
        // its time; and the least time, as far as the finest plan shows it.
        let (mut doublings, mut likely, mut is_last) = (0, None, false);
        let mut least_s = 0.0;
        loop {
            let lay = |place: &Place<'_, P>, free: &mut [Knot<A>]| {
                within.lay(place, &limits, doublings, free)
            };
            let judged = lay_all(paths.clone().into_iter(), &limits, knots, lay)
                .map(|own| own.len())
                .and_then(|used| {
                    let (own, spare) = knots.split_at_mut(used.min(knots.len()));
                    let duration_s = if within.planned.get() == own.len() {
                        duration(own)?
                    } else {
                        time(&limits, own)?
                    };
                    let verdict = accuracy.judge(&limits, own, spare, duration_s);
                    Ok((used, duration_s, verdict?))
                });
            match (judged, likely) {
                (Ok((used, duration_s, verdict)), _) => {
                    least_s = match verdict {
                        Verdict::Slow { least_s } if !is_last => least_s,
                        Verdict::LikelyFast { least_s } if !is_last => {
                            likely = Some((doublings, duration_s));
                            least_s
                        }
                        _ => {
                            let (own, _) = knots.split_at(used.min(knots.len()));
                            return Ok(Self::new(own, limits, duration_s));
                        }
                    };
                }
                // Twice as many knots stand elsewhere.
                (Err(PlanError::TooCoarse { .. }), _) if doublings > 0 => {}
                (Err(PlanError::Memory { .. }), Some((enough, time_s)))
                    if !is_last && time_s <= least_s * accuracy.max_time_ratio =>
                {
                    (doublings, is_last) = (enough, true);
                    continue;
                }
                (Err(refused), _) => return Err(refused),
            }
            doublings += 1;
        }
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

impl Accuracy {
    pub(crate) fn check<E>(&self) -> Result<(), PlanError<E>> {
        check_allowed(self.max_departure)?;
        let max_time_ratio = self.max_time_ratio;
        if max_time_ratio > 1.0 {
            return Ok(());
        }
        Err(PlanError::TimeRatio { max_time_ratio })
    }

    /// Whether planned knots are as fast as is asked for.
    fn judge<A: Axes, E>(
        &self,
        limits: &Reciprocals<A>,
        knots: &[Knot<A>],
        spare: &mut [Knot<A>],
        duration_s: f64,
    ) -> Result<Verdict, PlanError<E>> {
        if check_single_segments::<_, E>(limits, knots).is_err() {
            return Ok(Verdict::Slow { least_s: 0.0 });
        }
        let ratio = self.max_time_ratio;
        if !ratio.is_finite() {
            return Ok(Verdict::Fast);
        }
        let keeps = |lost_s: f64| duration_s <= (duration_s - lost_s) * ratio;
        let Lost { last_s, most_s } = Lost::new(limits, knots, spare, duration_s)?;
        // Segments that are legs cannot be halved to see what they lose.
        let single_s = lost_on_single_segments(limits, knots);
        let [last_s, most_s] = [last_s, most_s].map(|lost_s| lost_s + single_s);
        // Where a path turns between two knots, no number of knots nearby shows what it takes.
        let gap = ((ratio - 1.0) * 0.5).min(LARGEST_GAP_TIMED);
        let least_s = duration_s - last_s;
        Ok(if keeps(most_s) && are_resolved(limits, knots, gap) {
            Verdict::Fast
        } else if keeps(last_s) {
            Verdict::LikelyFast { least_s }
        } else {
            Verdict::Slow { least_s }
        })
    }
}

/// Whether a plan is as fast as is asked for; if that is not sure, with the least time as far as
/// the last doubling of its segments shows it.
#[derive(Debug, Clone, Copy)]
enum Verdict {
    Fast,
    /// By the last doubling of its segments alone.
    LikelyFast {
        least_s: f64,
    },
    Slow {
        least_s: f64,
    },
}

/// The part of the steepest slope by which slopes may disagree where the time counts: at most half
/// as much as the time may be longer.
const LARGEST_GAP_TIMED: f64 = 0.05;

/// How often segments are halved to see what is lost, and the part of a loss that twice the
/// segments have at most: half, and something for chance. With these none of 2,100 plans of random
/// paths missed a ratio.
const HALVINGS: u32 = 3;
const LEFT: f64 = 0.6;

/// By how much the time of planned knots may be above the best.
struct Lost {
    /// What half of the segments take longer.
    last_s: f64,
    /// The most that is lost; infinite where fewer knots have no plan.
    ///
    /// It falls at least in proportion to the length of the segments. So it is at most what half
    /// the segments take longer, and half of what a quarter of them take longer than those, and so
    /// on: the largest of these, in case one is small by chance.
    most_s: f64,
}

impl Lost {
    /// Plans fewer segments in the memory beside the knots.
    fn new<A: Axes, E>(
        limits: &Reciprocals<A>,
        knots: &[Knot<A>],
        spare: &mut [Knot<A>],
        duration_s: f64,
    ) -> Result<Self, PlanError<E>> {
        let (mut halving, mut used) = (Halving::default(), 0_usize);
        for kept in knots.iter().filter_map(|knot| halving.keep(knot)) {
            if let Some(slot) = spare.get_mut(used) {
                *slot = kept;
            }
            used = used.saturating_add(1);
        }
        let [needed, available] = [used, spare.len()].map(|more| knots.len().saturating_add(more));
        let Some(fewer) = spare.get_mut(..used) else {
            return Err(PlanError::Memory { needed, available });
        };
        let (mut finer_s, mut part) = (duration_s, 1.0);
        let [mut last_s, mut most_s] = [0.0_f64; 2];
        for halvings in 0..HALVINGS {
            let (own, _) = fewer.split_at_mut(used.min(fewer.len()));
            stretch_all(limits, own);
            let coarser_s = time::<_, E>(limits, own).unwrap_or(f64::INFINITY);
            if halvings == 0 {
                last_s = (coarser_s - duration_s).max(0.0);
            }
            most_s = most_s.max((coarser_s - finer_s).abs() * part);
            if most_s == f64::INFINITY {
                break;
            }
            (finer_s, part) = (coarser_s, part * LEFT);
            used = halve(own);
        }
        Ok(Self { last_s, most_s })
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
