//! The fastest speeds at the knots, with limits of torque.
//!
//! As in `passes`: backward the highest speed from which the rest can be run, with a speed after it
//! that goes with it, then forward. Where a motor has at a speed at least what friction and gravity
//! take, and no more at higher speeds, what holds for a pair of speeds holds for each slower pair
//! of the same ratio: on a ray a torque is a W² + b W + c, and b W + c is within the limit.

use super::load::Load;
use super::{Dynamics, TorqueLimits};
use crate::knot::ToolTimes;
use crate::number::{LARGEST, larger_or_nan, sqrt};
use crate::reciprocals::Reciprocals;
use crate::segment::{End, Segment};
use crate::{Axes, Knot};

/// The rays of pairs that are chosen for the least time alone: speeds differ by a factor of 8 at
/// most.
const STEEPEST: f64 = 7.0 / 9.0;

/// Cuts of an interval in search of the speed at which a limit is reached, and what is close to it.
const CUTS_TO_A_LIMIT: u32 = 24;
const CLOSE: f64 = 1e-8;

/// Cuts of an interval of rays by the golden ratio.
const CUTS: u32 = 24;

/// (√5 - 1) / 2
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A segment with the limits of its axes and motors.
pub(super) struct Pair<'a, A: Axes> {
    axes: Segment<A>,
    load: Load<'a, A>,
}

impl<'a, A: Axes> Pair<'a, A> {
    pub(super) fn new<D: Dynamics<Axes = A>>(
        torque: &'a TorqueLimits<D>,
        share: f64,
        limits: &Reciprocals<A>,
        [from, to]: [&Knot<A>; 2],
        tool_times: ToolTimes,
    ) -> Self {
        Self {
            axes: Segment::new(limits, from, to, tool_times),
            load: Load::new(torque, share, from, to),
        }
    }

    /// The largest part of a limit, or of a share of a torque, that a pair of speeds takes.
    pub(super) fn used(&self, w0: f64, w1: f64) -> f64 {
        larger_or_nan(self.axes.load(w0, w1), self.load.used(w0, w1))
    }

    /// The highest speed at the end after a rest.
    pub(super) fn speed_from_rest(&self) -> f64 {
        self.widest(1.0).1
    }

    /// The highest speed at the start before a rest.
    pub(super) fn speed_to_rest(&self) -> f64 {
        self.widest(-1.0).0
    }

    /// The pair on the ray of r that takes the least time.
    fn widest(&self, r: f64) -> (f64, f64) {
        let axes = 2.0 / sqrt(self.axes.load(1.0 - r, 1.0 + r));
        let half = axes.min(self.load.widest(r)).min(LARGEST) * 0.5;
        (half * (1.0 - r), half * (1.0 + r))
    }

    /// The pair on the ray, with both speeds capped.
    fn within(&self, r: f64, [cap, ceiling]: [f64; 2]) -> (f64, f64) {
        let (w0, w1) = self.widest(r);
        let scale = [cap / w0, ceiling / w1].into_iter().fold(1.0, f64::min);
        (w0 * scale, w1 * scale)
    }

    /// The pair of speeds at the start and at the end with which the rest is run in the least time.
    pub(super) fn begin(&self, ceiling: f64, cap: f64) -> (f64, f64) {
        if cap <= 0.0 {
            return (0.0, self.speed_from_rest().min(ceiling));
        }
        if ceiling <= 0.0 {
            return (self.speed_to_rest().min(cap), 0.0);
        }
        if cap >= ceiling {
            // As fast at the start as it can brake from.
            let used = |w0: f64| self.used(w0, ceiling);
            let wanted = self.axes.highest(End::From, ceiling, cap).max(ceiling);
            let start = self.load.farthest(End::From, ceiling, [ceiling, wanted]);
            if used(start) <= 1.0 {
                return (start, ceiling);
            }
            if used(ceiling) <= 1.0 {
                return (farthest(ceiling, start, used), ceiling);
            }
        }
        self.shortest([cap, ceiling])
    }

    /// The pair of the least time: its sum has one maximum over the rays.
    fn shortest(&self, caps: [f64; 2]) -> (f64, f64) {
        let at = |r: f64| {
            let (w0, w1) = self.within(r, caps);
            (w0 + w1, (w0, w1))
        };
        let [mut low, mut high] = [-STEEPEST, STEEPEST];
        let inner =
            |low: f64, high: f64| [high - (high - low) * GOLDEN, low + (high - low) * GOLDEN];
        let [mut a, mut b] = inner(low, high).map(|r| (r, at(r)));
        for _ in 0..CUTS {
            if a.1.0 < b.1.0 {
                (low, a) = (a.0, b);
                let [_, r] = inner(low, high);
                b = (r, at(r));
            } else {
                (high, b) = (b.0, a);
                let [r, _] = inner(low, high);
                a = (r, at(r));
            }
        }
        if a.1.0 < b.1.0 { b.1.1 } else { a.1.1 }
    }

    /// The highest speed at the end, at most `ceiling`, after the speed `w0`; with w₀ times `ratio`
    /// the segment holds.
    pub(super) fn end(&self, w0: f64, ceiling: f64, ratio: f64) -> f64 {
        if w0 <= 0.0 {
            return self.speed_from_rest().min(ceiling);
        }
        if ceiling <= 0.0 {
            return 0.0;
        }
        let known = (w0 * ratio).min(ceiling);
        let wanted = self.axes.end(w0, ceiling, ratio).max(known);
        let wanted = self.load.farthest(End::To, w0, [known, wanted]);
        farthest(known, wanted, |w1| self.used(w0, w1))
    }
}

/// The speed nearest to `wanted` with which no limit is passed, from one with which none is: by
/// regula falsi, with the value of an end that stays twice halved (Illinois).
pub(super) fn farthest(known: f64, wanted: f64, used: impl Fn(f64) -> f64) -> f64 {
    let over = |speed: f64| used(speed) - 1.0;
    let mut bad = (wanted, over(wanted));
    if bad.1 <= 0.0 {
        return wanted;
    }
    let mut good = (known, over(known));
    let (mut best, mut was_good) = (known, None);
    for _ in 0..CUTS_TO_A_LIMIT {
        let gap = bad.0 - good.0;
        let cut = good.0 - good.1 * gap / (bad.1 - good.1);
        let is_between = (cut - good.0) * (cut - bad.0) < 0.0;
        let speed = if is_between { cut } else { good.0 + gap * 0.5 };
        let here = over(speed);
        let is_good = here <= 0.0;
        if is_good {
            best = speed;
            if here > -CLOSE {
                break;
            }
            good = (speed, here);
        } else {
            bad = (speed, here);
        }
        if was_good == Some(is_good) {
            let stays = if is_good { &mut bad } else { &mut good };
            stays.1 *= 0.5;
        }
        was_good = Some(is_good);
    }
    best
}

/// Gives the knots the speeds of the fastest motion with which no knot passes its cap, and no motor
/// its share of a torque at the ends of a segment.
pub(super) fn fastest<D: Dynamics>(
    torque: &TorqueLimits<D>,
    limits: &Reciprocals<D::Axes>,
    knots: &mut [Knot<D::Axes>],
) {
    let pair =
        |from: &_, to: &Knot<_>| Pair::new(torque, to.share(), limits, [from, to], ToolTimes::ONE);
    let mut earlier = knots.iter_mut().rev();
    let Some(mut to) = earlier.next() else {
        return;
    };
    to.speed = to.cap.min(LARGEST);
    for from in earlier {
        (from.speed, from.ratio) = if to.ds > 0.0 {
            let (w0, w1) = pair(from, to).begin(to.speed, from.cap);
            (w0, if w0 > 0.0 { w1 / w0 } else { 0.0 })
        } else {
            (to.speed.min(from.cap), 1.0)
        };
        to = from;
    }
    let mut rest = knots.iter_mut();
    let Some(mut from) = rest.next() else {
        return;
    };
    for to in rest {
        to.speed = if to.ds > 0.0 {
            pair(from, to).end(from.speed, to.speed, from.ratio)
        } else {
            from.speed
        };
        from = to;
    }
}
