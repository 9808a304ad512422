//! What a cubic segment asks of the axes, as a function of the path speeds at its ends.

use crate::number::{larger, sqrt};
use crate::reciprocals::{MARGIN, Reciprocal, Reciprocals};
use crate::{Axes, PathPoint, ToolLimits};

/// The end of a segment whose speed is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    From,
    To,
}

/// Utilisation of the limits of one axis, as a function of the speeds w₀ and w₁.
#[derive(Debug, Clone, Copy)]
struct AxisLoad {
    /// Accelerations at the start and at the end: coefficients of y and z.
    accelerations: [[f64; 2]; 2],
    /// What both may be off by rounding: coefficient of y.
    noise: f64,
    /// Speed between the ends: coefficients of w₀ and w₁.
    middle: [f64; 2],
}

/// All limits of one cubic segment, in the speeds w₀ and w₁ of the parameter at its ends.
///
/// With the length Δs, m = Δq/Δs, p₀ and p₁ the slopes dq/ds at the ends, and the duration
/// T = 2 Δs / (w₀ + w₁), the cubic that a controller runs has the accelerations
///
/// ```text
/// a₀ = ((6m - 4p₀ - 2p₁) y + (4p₀ - 2p₁) z) / Δs     y = (w₀ + w₁)² / 4
/// a₁ = ((2p₀ + 4p₁ - 6m) y + (4p₁ - 2p₀) z) / Δs     z = (w₁² - w₀²) / 4
/// ```
///
/// at its ends, and between them no larger ones. Its speed has the Bernstein coefficients
/// p₀ w₀, (3m/2 - p₀) w₀ + (3m/2 - p₁) w₁ and p₁ w₁: no larger value is reached between.
/// All of it scales with the speeds: what holds for a pair holds for each slower pair of the
/// same ratio.
///
/// The controller gets speeds p w and a time T that are rounded. Its accelerations are sums of
/// terms of the size of (|m| + |p₀| + |p₁|) y / Δs, and are off by some machine epsilons of that:
/// where T is short, by many of the limit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Segment<A: Axes> {
    axes: A::Of<AxisLoad>,
    /// Largest utilisation of a speed limit per w₀, and per w₁.
    ends: [f64; 2],
    /// Acceleration of the tool: coefficient of z.
    tool: f64,
}

/// Relative rounding of the terms of an acceleration, from the positions on to the numbers that a
/// controller gets, with those of a feed.
pub(crate) const NOISE: f64 = 128.0 * f64::EPSILON;

/// What a root may be off by; less than the margin.
const ROOT: f64 = 1.0 + 32.0 * f64::EPSILON;

/// The part of the noise that is left where a root has its own.
const ROOT_NOISE: f64 = 0.75;

/// Limits that a search goes down by, one after the other.
const PASSES: u32 = 8;

/// Halvings that leave nothing of a relative gap.
const HALVINGS: u32 = 48;

impl AxisLoad {
    const NONE: Self = Self {
        accelerations: [[0.0; 2]; 2],
        noise: 0.0,
        middle: [0.0; 2],
    };

    fn new(limit: &Reciprocal, [q0, q1]: [f64; 2], [p0, p1]: [f64; 2], inverse: f64) -> Self {
        let mean = (q1 - q0) * inverse;
        let scale = inverse * limit.acceleration;
        Self {
            accelerations: [
                [
                    (6.0 * mean - 4.0 * p0 - 2.0 * p1) * scale,
                    (4.0 * p0 - 2.0 * p1) * scale,
                ],
                [
                    (2.0 * p0 + 4.0 * p1 - 6.0 * mean) * scale,
                    (4.0 * p1 - 2.0 * p0) * scale,
                ],
            ],
            noise: NOISE * (mean.abs() + p0.abs() + p1.abs()) * scale,
            middle: [
                (1.5 * mean - p0) * limit.speed,
                (1.5 * mean - p1) * limit.speed,
            ],
        }
    }
}

impl<A: Axes> Segment<A> {
    pub(crate) fn new(
        limits: &Reciprocals<A>,
        from: &PathPoint<A>,
        to: &PathPoint<A>,
        ds: f64,
    ) -> Self {
        let inverse = 1.0 / ds;
        let mut segment = Self {
            axes: A::filled(AxisLoad::NONE),
            ends: [0.0; 2],
            tool: 0.0,
        };
        let [from_end, to_end] = &mut segment.ends;
        let positions = (from.position.as_slice().iter()).zip(to.position.as_slice());
        let slopes = (from.slope.as_slice().iter()).zip(to.slope.as_slice());
        let all = (A::each_mut(&mut segment.axes).iter_mut().zip(limits.axes()))
            .zip(positions.zip(slopes));
        for ((load, limit), ((q0, q1), (p0, p1))) in all {
            *load = AxisLoad::new(limit, [*q0, *q1], [*p0, *p1], inverse);
            *from_end = from_end.max(p0.abs() * limit.speed);
            *to_end = to_end.max(p1.abs() * limit.speed);
        }
        segment
    }

    /// The segment with the limits of the tool: it moves by the parameter, p₀ = p₁ = m = 1.
    ///
    /// ```text
    /// speeds w₀, w₁     acceleration 2 z / Δs = (w₁² - w₀²) / 2Δs
    /// ```
    pub(crate) fn with_tool(mut self, tool: Option<&ToolLimits>, ds: f64) -> Self {
        if let Some(tool) = tool {
            for end in &mut self.ends {
                *end = end.max(MARGIN / tool.feed);
            }
            if let Some(acceleration) = tool.acceleration {
                self.tool = 2.0 * MARGIN / (ds * acceleration);
            }
        }
        self
    }

    /// The largest utilisation of a limit at these speeds, squared where it is a speed:
    /// at most 1 where all hold, and growing with the square of both speeds.
    #[inline]
    pub(crate) fn load(&self, w0: f64, w1: f64) -> f64 {
        let [from, to] = self.ends;
        let (y, z) = products(w0, w1);
        let mut hardest = 0.0_f64;
        let mut fastest = (from * w0).max(to * w1);
        for axis in A::each(&self.axes) {
            let noise = axis.noise * y * ROOT_NOISE;
            for [c, d] in axis.accelerations {
                hardest = larger(hardest, (c * y + d * z).abs() + noise);
            }
            let [e, f] = axis.middle;
            fastest = larger(fastest, (e * w0 + f * w1).abs());
        }
        hardest = larger(hardest, (self.tool * z).abs());
        hardest.max(fastest * fastest)
    }

    pub(crate) fn holds(&self, w0: f64, w1: f64) -> bool {
        self.load(w0, w1) <= ROOT
    }

    /// The highest speed at one end, at most `cap`, that the limits from above allow with the
    /// speed `other` at the other end. Where a limit asks for a higher speed, the result does
    /// not hold: the caller looks.
    pub(crate) fn highest(&self, end: End, other: f64, cap: f64) -> f64 {
        let [from, to] = self.ends;
        let scale = if end == End::From { from } else { to };
        let mut speed = cap;
        if scale * speed > 1.0 {
            speed = 1.0 / scale;
        }
        for axis in A::each(&self.axes) {
            let [e, f] = axis.middle;
            let (own, others) = if end == End::From { (e, f) } else { (f, e) };
            let value = own * speed + others * other;
            if value.abs() > 1.0 {
                let highest = (1.0_f64.copysign(value) - others * other) / own;
                if highest > 0.0 && highest < speed {
                    speed = highest;
                }
            }
        }
        for axis in A::each(&self.axes) {
            for [c, d] in axis.accelerations {
                let d = if end == End::From { -d } else { d };
                let (y, z) = products(other, speed);
                let (value, noise) = (c * y + d * z, axis.noise * y);
                if value + noise > 1.0 {
                    speed = lower(c + axis.noise, d, other, speed);
                } else if value - noise < -1.0 {
                    speed = lower(axis.noise - c, -d, other, speed);
                }
            }
        }
        let d = if end == End::From {
            -self.tool
        } else {
            self.tool
        };
        let (_, z) = products(other, speed);
        if (d * z).abs() > 1.0 {
            speed = lower(0.0, d.copysign(d * z), other, speed);
        }
        speed
    }

    /// The highest speed from which the segment can be begun if it must end with at most
    /// `ceiling`, and the speed at its end that goes with it.
    ///
    /// What can be begun at a speed can be begun at each lower one, ending slower by the same
    /// factor: from a speed that holds, steps that grow find one that does not, and halvings the
    /// highest between.
    pub(crate) fn begin(&self, ceiling: f64, cap: f64) -> (f64, f64) {
        let fast = self.highest(End::From, ceiling, cap);
        if fast >= ceiling && self.holds(fast, ceiling) {
            return (fast, ceiling);
        }
        let reached = self.reach(fast, ceiling);
        let even = ceiling.min(self.even()).min(cap);
        let (mut best, mut high) = match reached {
            Some(end) if fast >= even => return (fast, end),
            Some(_) => ((even, even), cap),
            None => {
                // On the ray to a pair that does not hold there is one that does.
                let end = self.highest(End::To, fast, ceiling);
                let scale = 1.0 / sqrt(self.load(fast, end));
                ((fast * scale, end * scale), fast)
            }
        };
        let mut step = best.0 * CLOSE;
        for _ in 0..HALVINGS {
            if high - best.0 <= best.0 * CLOSE {
                break;
            }
            let middle = (best.0 + step).min((best.0 + high) * 0.5);
            match self.reach(middle, ceiling) {
                Some(end) => (best, step) = ((middle, end), step * 4.0),
                None => high = middle,
            }
        }
        best
    }

    /// The highest speed from which the segment can be begun if it ends with `ceiling`, or where
    /// that is higher, with the speed that it begins with: never slower than it need be later.
    pub(crate) fn begin_evenly(&self, ceiling: f64, cap: f64) -> f64 {
        let even = self.even();
        if even <= ceiling {
            return even;
        }
        let (mut good, mut bad) = (ceiling, self.highest(End::From, ceiling, cap));
        if bad > good && self.holds(bad, ceiling) {
            return bad;
        }
        for _ in 0..HALVINGS {
            if bad - good <= good * CLOSE {
                break;
            }
            let middle = (good + bad) * 0.5;
            if self.holds(middle, ceiling) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        good
    }

    /// The highest speed for both ends.
    pub(crate) fn even(&self) -> f64 {
        1.0 / sqrt(self.load(1.0, 1.0))
    }

    /// The highest speed at the end, at most `ceiling`, after the speed `w0`.
    ///
    /// Each limit forbids an interval of speeds or all above one. Where the next lower speed that
    /// one allows is forbidden by another, the search goes on from there.
    fn reach(&self, w0: f64, ceiling: f64) -> Option<f64> {
        let mut speed = ceiling;
        for _ in 0..PASSES {
            let lower = self.highest(End::To, w0, speed);
            if self.holds(w0, lower) {
                return Some(lower);
            }
            if lower >= speed {
                break;
            }
            speed = lower;
        }
        None
    }

    /// The highest speed at the end, at most `ceiling`, after the speed `w0`; `known` is one
    /// that holds.
    pub(crate) fn end(&self, w0: f64, ceiling: f64, known: f64) -> f64 {
        if w0 == 0.0 {
            let fast = self.highest(End::To, w0, ceiling);
            let load = self.load(w0, fast);
            return fast / sqrt(load.max(1.0));
        }
        self.reach(w0, ceiling).unwrap_or(known)
    }

    /// The speed at the end that is nearest to `wanted` after the speed `w0`: the highest below it,
    /// or where none is, one above it towards `known`, which holds.
    pub(crate) fn toward(&self, w0: f64, wanted: f64, known: f64) -> f64 {
        if self.holds(w0, wanted) {
            return wanted;
        }
        if let Some(below) = self.reach(w0, wanted) {
            return if known <= wanted {
                below.max(known)
            } else {
                below
            };
        }
        let (mut good, mut bad) = (known, wanted);
        for _ in 0..HALVINGS {
            let middle = (good + bad) * 0.5;
            if self.holds(w0, middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        good
    }
}

/// Relative gap at which the search for a beginning stops: it costs that fraction of the time.
const CLOSE: f64 = 1e-5;

/// y and z of the two speeds.
#[inline]
fn products(w0: f64, w1: f64) -> (f64, f64) {
    let (mean, rise) = ((w0 + w1) * 0.5, (w1 - w0) * 0.5);
    (mean * mean, mean * rise)
}

/// The speed w below `speed` at which c (w + o)²/4 + d (w² - o²)/4 = 1, if it does not hold
/// at `speed` and holds at zero.
fn lower(c: f64, d: f64, other: f64, speed: f64) -> f64 {
    let rest = (c - d) * other * other - 4.0;
    if rest >= 0.0 {
        return speed;
    }
    let linear = c * other;
    let root = sqrt((linear * linear - (c + d) * rest).max(0.0));
    let below = -rest / (linear + root);
    if below > 0.0 && below < speed {
        below
    } else {
        speed
    }
}
