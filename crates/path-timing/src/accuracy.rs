//! How many segments a table has: as few as are near enough to the path and to the least time.
//!
//! Goal: rows that cost memory and are not needed are not made. Method: knots are laid for the
//! departure, twice as many as long as the time may be longer than is asked for. By how much it may
//! be is seen by plans of a half, a quarter and an eighth of the segments, made beside them.

use crate::departure::check_allowed;
use crate::knots::{Halving, are_resolved, halve};
use crate::planner::{check_single_segments, lost_on_single_segments};
use crate::reciprocals::Reciprocals;
use crate::stepping::Pairs;
use crate::{Axes, Knot, PlanError};

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
    /// Where there is no room for the segments with which that is sure, the fastest plan is taken
    /// that changes by no more with the last doubling of them, unless finer plans have shown that it
    /// is slower.
    pub max_time_ratio: f64,
}

/// What a plan takes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Planned {
    /// By what all of its times are multiplied.
    pub(crate) stretch: f64,
    pub(crate) duration_s: f64,
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

    /// The knots of a plan, and what it takes. `lay` lays the knots of all paths, with segments
    /// doubled in number some times, and plans them, if a plan is found; `coarser_s` plans every
    /// second knot of a plan anew, for its time, which is infinite without a plan.
    pub(crate) fn plan<'a, A: Axes, E>(
        &self,
        limits: &Reciprocals<A>,
        pairs: &impl Pairs<A>,
        knots: &'a mut [Knot<A>],
        lay: impl Fn(u32, &mut [Knot<A>]) -> Result<(usize, Option<Planned>), PlanError<E>>,
        coarser_s: impl Fn(&mut [Knot<A>]) -> f64,
    ) -> Result<(&'a [Knot<A>], Planned), PlanError<E>> {
        // A number of doublings that is likely enough, for where there is no room to be sure, with
        // its time; and the least time, as far as the finest plan shows it.
        let (mut doublings, mut likely, mut is_last) = (0, None, false);
        let mut least_s = 0.0;
        loop {
            let judged = lay(doublings, knots).and_then(|(used, planned)| {
                let (own, spare) = knots.split_at_mut(used.min(knots.len()));
                let verdict = planned.map(|planned| {
                    if check_single_segments::<_, E>(pairs, limits, own).is_err() {
                        return Ok(Verdict::Slow { least_s: 0.0 });
                    }
                    self.judge(limits, [own, spare], planned.duration_s, &coarser_s)
                });
                Ok((used, planned, verdict.transpose()?))
            });
            match (judged, likely) {
                (Ok((used, Some(planned), Some(verdict))), _) => {
                    least_s = match verdict {
                        Verdict::Slow { least_s } if !is_last => least_s,
                        Verdict::LikelyFast { least_s } if !is_last => {
                            let is_faster = |(_, time_s): (u32, f64)| planned.duration_s < time_s;
                            if likely.is_none_or(is_faster) {
                                likely = Some((doublings, planned.duration_s));
                            }
                            least_s
                        }
                        _ => {
                            let (own, _) = knots.split_at(used.min(knots.len()));
                            return Ok((own, planned));
                        }
                    };
                }
                // Segments too long for a plan.
                (Ok(_), _) => {}
                // Twice as many knots stand elsewhere.
                (Err(PlanError::TooCoarse { .. }), _) if doublings > 0 => {}
                (Err(PlanError::Memory { .. }), Some((enough, time_s)))
                    if !is_last && time_s <= least_s * self.max_time_ratio =>
                {
                    (doublings, is_last) = (enough, true);
                    continue;
                }
                (Err(refused), _) => return Err(refused),
            }
            doublings += 1;
        }
    }

    /// Whether planned knots are as fast as is asked for.
    fn judge<A: Axes, E>(
        &self,
        limits: &Reciprocals<A>,
        [knots, spare]: [&mut [Knot<A>]; 2],
        duration_s: f64,
        coarser_s: impl Fn(&mut [Knot<A>]) -> f64,
    ) -> Result<Verdict, PlanError<E>> {
        let ratio = self.max_time_ratio;
        if !ratio.is_finite() {
            return Ok(Verdict::Fast);
        }
        let keeps = |lost_s: f64| duration_s <= (duration_s - lost_s) * ratio;
        let Lost { last_s, most_s } = Lost::new(knots, spare, duration_s, coarser_s)?;
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
        knots: &[Knot<A>],
        spare: &mut [Knot<A>],
        duration_s: f64,
        coarser_s: impl Fn(&mut [Knot<A>]) -> f64,
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
            let time_s = coarser_s(own);
            if halvings == 0 {
                last_s = (time_s - duration_s).max(0.0);
            }
            most_s = most_s.max((time_s - finer_s).abs() * part);
            if most_s == f64::INFINITY {
                break;
            }
            (finer_s, part) = (time_s, part * LEFT);
            used = halve(own);
        }
        Ok(Self { last_s, most_s })
    }
}
