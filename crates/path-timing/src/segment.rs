//! What a cubic segment asks of the axes, as a function of the path speeds at its ends.

use crate::number::{larger, sqrt};
use crate::reciprocals::{MARGIN, Reciprocal, Reciprocals};
use crate::{Axes, Knot, PathPoint};

/// The end of a segment whose speed is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    From,
    To,
}

/// Utilisation of the limits of one axis, as a function of the speeds w₀ and w₁.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AxisLoad {
    /// Accelerations at the start and at the end: coefficients of y and z.
    pub(crate) accelerations: [[f64; 2]; 2],
    /// What both may be off by rounding: coefficient of y.
    pub(crate) noise: f64,
    /// Speed between the ends: coefficients of w₀ and w₁.
    pub(crate) middle: [f64; 2],
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

/// Halvings of the gap between a speed that holds and one that does not.
const HALVINGS: u32 = 12;

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
    /// The segment between two knots, with the tool's feed multiplied.
    ///
    /// ```text
    /// tool: p₀ = p₁ = m = 1, speeds w₀, w₁, acceleration 2 z / Δs = (w₁² - w₀²) / 2Δs
    /// ```
    pub(crate) fn new(limits: &Reciprocals<A>, from: &Knot<A>, to: &Knot<A>, feed: f64) -> Self {
        let mut segment = Self::of_axes(limits, &from.point, &to.point, to.ds);
        if let Some(tool) = &to.tool {
            for end in &mut segment.ends {
                *end = end.max(MARGIN / (tool.feed * feed));
            }
            if let Some(acceleration) = tool.acceleration {
                segment.tool = 2.0 * MARGIN / (to.ds * acceleration);
            }
        }
        segment
    }

    /// The segment with the limits of the axes alone.
    pub(crate) fn of_axes(
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

    /// What each axis asks for.
    pub(crate) const fn axes(&self) -> &A::Of<AxisLoad> {
        &self.axes
    }

    /// Largest utilisation of a speed limit per w₀, and per w₁.
    pub(crate) const fn ends(&self) -> [f64; 2] {
        self.ends
    }

    /// Acceleration of the tool: coefficient of z.
    pub(crate) const fn tool(&self) -> f64 {
        self.tool
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

    /// The pair of speeds with which the segment takes the least time, at most `ceiling` at its end
    /// and `cap` at its start; where the machine brakes as hard as it can to the ceiling, the highest
    /// speed to brake from.
    ///
    /// Where the ceiling cannot be kept, the speeds differ at most by a factor of [`GROWTH`]: no segment
    /// is begun at a speed whose only partner is next to rest.
    pub(crate) fn begin(&self, ceiling: f64, cap: f64) -> (f64, f64) {
        if cap <= 0.0 {
            return (0.0, ceiling.min(self.speed_from_rest()));
        }
        if ceiling <= 0.0 {
            return (cap.min(self.speed_to_rest()), 0.0);
        }
        let fast = self.highest(End::From, ceiling, cap);
        if fast >= ceiling && self.holds(fast, ceiling) {
            return (fast, ceiling);
        }
        self.shortest(ceiling, cap)
    }

    /// The highest speed at the end after a start at rest.
    pub(crate) fn speed_from_rest(&self) -> f64 {
        1.0 / sqrt(self.load(0.0, 1.0))
    }

    /// The highest speed at the start before a rest at the end.
    pub(crate) fn speed_to_rest(&self) -> f64 {
        1.0 / sqrt(self.load(1.0, 0.0))
    }

    /// The pair of the least time.
    ///
    /// With W = w₀ + w₁ and r = (w₁ - w₀) / W each utilisation is W² times a convex function of r, so
    /// the least of their largest is found between two slopes by the cut of their tangents.
    fn shortest(&self, ceiling: f64, cap: f64) -> (f64, f64) {
        let at = |r: f64| self.tangent(r, [1.0 / cap, 1.0 / ceiling]);
        let [mut low, mut high] = [-STEEPEST, STEEPEST].map(|r| (r, at(r)));
        let (r, load) = 'found: {
            if low.1.slope >= 0.0 {
                break 'found (low.0, low.1.load);
            }
            if high.1.slope <= 0.0 {
                break 'found (high.0, high.1.load);
            }
            let mut best = if low.1.load < high.1.load { low } else { high };
            for _ in 0..CUTS {
                let ((a, f), (b, g)) = (low, high);
                let rise = g.load - f.load + f.slope * a - g.slope * b;
                let r = rise / (f.slope - g.slope);
                if !(r > a && r < b) {
                    break;
                }
                let least = f.load + f.slope * (r - a);
                let here = at(r);
                if here.load < best.1.load {
                    best = (r, here);
                }
                if best.1.load - least <= best.1.load * CLOSE {
                    break;
                }
                if here.slope > 0.0 {
                    high = (r, here);
                } else {
                    low = (r, here);
                }
            }
            (best.0, best.1.load)
        };
        let half = 1.0 / sqrt(load);
        ((half * (1.0 - r)).min(cap), (half * (1.0 + r)).min(ceiling))
    }

    /// The largest utilisation at w₀ = 1 - r and w₁ = 1 + r, and its derivative by r. `ends` are
    /// one over the highest speed at each end.
    #[inline]
    fn tangent(&self, r: f64, ends: [f64; 2]) -> Tangent {
        let mut largest = Tangent::default();
        let mut fastest = Tangent::default();
        for axis in A::each(&self.axes) {
            for [c, d] in axis.accelerations {
                let value = c + d * r;
                largest.raise(value.abs() + axis.noise, if value < 0.0 { -d } else { d });
            }
            let [e, f] = axis.middle;
            let value = e * (1.0 - r) + f * (1.0 + r);
            fastest.raise(value.abs(), if value < 0.0 { e - f } else { f - e });
        }
        largest.raise((self.tool * r).abs(), self.tool.copysign(r));
        let [from, to] = self.ends;
        let [from, to] = [from.max(ends[0]), to.max(ends[1])];
        fastest.raise(from * (1.0 - r), -from);
        fastest.raise(to * (1.0 + r), to);
        largest.raise(
            fastest.load * fastest.load,
            2.0 * fastest.load * fastest.slope,
        );
        largest
    }

    /// The highest speed at the end, at most `ceiling`, after the speed `w0`.
    ///
    /// Each limit forbids an interval of speeds or all above one. Where the next lower speed that
    /// one allows is forbidden by another, the search goes on from there.
    fn reach(&self, w0: f64, ceiling: f64) -> Option<f64> {
        let least = w0.min(ceiling) / GROWTH;
        let mut speed = ceiling;
        for _ in 0..PASSES {
            let lower = self.highest(End::To, w0, speed);
            if lower < least {
                return None;
            }
            if self.holds(w0, lower) {
                return Some(lower);
            }
            if lower >= speed {
                return None;
            }
            speed = lower;
        }
        None
    }

    /// The highest speed at the end, at most `ceiling`, after the speed `w0`; with the speed w₀ times
    /// `ratio` the segment holds.
    pub(crate) fn end(&self, w0: f64, ceiling: f64, ratio: f64) -> f64 {
        if w0 <= 0.0 {
            return ceiling.min(self.speed_from_rest());
        }
        if ceiling <= 0.0 {
            return 0.0;
        }
        let known = w0 * ratio;
        self.reach(w0, ceiling)
            .map_or(known, |speed| speed.max(known))
    }

    /// The speed at the end that is nearest to `wanted` after the speed `w0`, where `known` holds:
    /// the highest below it, else the lowest above it that is found.
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
        let step = (known - wanted) / f64::from(SAMPLES);
        let mut samples = (1..SAMPLES).map(|sample| wanted + step * f64::from(sample));
        let mut good = samples.find(|w1| self.holds(w0, *w1)).unwrap_or(known);
        let mut bad = good - step;
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

    /// The lowest speed at the end after the speed `w0`, where `known` holds: at most slower by a factor
    /// of [`GROWTH`].
    pub(crate) fn slowest(&self, w0: f64, known: f64) -> f64 {
        let least = (w0 / GROWTH).min(known);
        self.toward(w0, least, known)
    }
}

/// By what one speed of a pair that is chosen for the least time alone may be above the other: what
/// constant acceleration makes of it on knots as dense as those at a rest.
const GROWTH: f64 = 8.0;

/// The r of that growth.
const STEEPEST: f64 = (GROWTH - 1.0) / (GROWTH + 1.0);

/// Cuts of tangents in a search.
const CUTS: u32 = 16;

/// Relative gap at which the search for a pair stops: it costs half of that fraction of the time.
const CLOSE: f64 = 1e-5;

/// Speeds looked at between one that is wanted and one that holds.
const SAMPLES: u32 = 8;

/// A convex function at a place.
#[derive(Debug, Clone, Copy, Default)]
struct Tangent {
    load: f64,
    slope: f64,
}

impl Tangent {
    /// The larger one.
    #[inline]
    fn raise(&mut self, load: f64, slope: f64) {
        if load > self.load {
            *self = Self { load, slope };
        }
    }
}

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
