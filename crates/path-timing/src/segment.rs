//! What a cubic segment asks of the axes, as a function of the path speeds at its ends.

use crate::knot::ToolTimes;
use crate::number::{Real, larger};
use crate::reciprocals::{Reciprocal, Reciprocals, margin};
use crate::{Axes, Knot, PathPoint};

/// The end of a segment whose speed is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    From,
    To,
}

/// Utilisation of the limits of one axis, as a function of the speeds w₀ and w₁.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AxisLoad<R = f64> {
    /// Accelerations at the start and at the end: coefficients of y and z.
    pub(crate) accelerations: [[R; 2]; 2],
    /// What both may be off by rounding: coefficient of y.
    pub(crate) noise: R,
    /// Speed between the ends: coefficients of w₀ and w₁.
    pub(crate) middle: [R; 2],
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
///
/// `R` is what all this is computed in; the change of a position is always taken in `f64`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Segment<A: Axes, R: Real = f64> {
    axes: A::Of<AxisLoad<R>>,
    /// Largest utilisation of a speed limit per w₀, and per w₁.
    ends: [R; 2],
    /// Acceleration of the tool: coefficients of y and z.
    tool: [R; 2],
    /// What it may be off by rounding: coefficient of y.
    tool_noise: R,
}

/// Relative rounding of the terms of an acceleration, from the positions on to the numbers that a
/// controller gets, with those of a feed.
fn noise<R: Real>() -> R {
    R::of(128.0) * R::EPSILON
}

/// What a root may be off by; less than the margin.
fn root<R: Real>() -> R {
    R::ONE + R::of(32.0) * R::EPSILON
}

/// The part of the noise that is left where a root has its own.
const ROOT_NOISE: f64 = 0.75;

/// Limits that a search goes down by, one after the other.
const PASSES: u32 = 8;

/// Halvings of the gap between a speed that holds and one that does not.
const HALVINGS: u32 = 12;

impl<R: Real> AxisLoad<R> {
    const NONE: Self = Self {
        accelerations: [[R::ZERO; 2]; 2],
        noise: R::ZERO,
        middle: [R::ZERO; 2],
    };

    fn new(limit: &Reciprocal<R>, mean: R, [p0, p1]: [R; 2], inverse: R) -> Self {
        let [two, four, six] = [2.0, 4.0, 6.0].map(R::of);
        let scale = inverse * limit.acceleration;
        let middle = R::of(1.5) * mean;
        Self {
            accelerations: [
                [
                    (six * mean - four * p0 - two * p1) * scale,
                    (four * p0 - two * p1) * scale,
                ],
                [
                    (two * p0 + four * p1 - six * mean) * scale,
                    (four * p1 - two * p0) * scale,
                ],
            ],
            noise: noise::<R>() * (mean.abs() + p0.abs() + p1.abs()) * scale,
            middle: [(middle - p0) * limit.speed, (middle - p1) * limit.speed],
        }
    }
}

impl<A: Axes, R: Real> Segment<A, R> {
    /// The segment between two knots, with the limits of the tool multiplied.
    ///
    /// ```text
    /// tool: speeds w₀, w₁; where it goes r₀ and r₁ by the parameter, the acceleration
    ///     (r₁ w₁ - r₀ w₀) / T = ((r₁ - r₀) y + (r₀ + r₁) z) / Δs
    /// ```
    pub(crate) fn new(
        limits: &Reciprocals<A, R>,
        from: &Knot<A>,
        to: &Knot<A>,
        times: ToolTimes,
    ) -> Self {
        let mut segment = Self::of_axes(limits, &from.point, &to.point, to.ds);
        if to.tool.is_none() {
            return segment;
        }
        let tool = to.tool.times(times);
        let feed = margin::<R>() / R::of(tool.feed);
        for end in &mut segment.ends {
            *end = end.max(feed);
        }
        if tool.acceleration < f64::INFINITY {
            let per_second2 = R::of(to.ds) * R::of(tool.acceleration);
            let used = R::of(2.0) * margin::<R>() / per_second2;
            segment.tool = [R::of(tool.change) * used, used];
            // As of an axis whose slopes are the tool's.
            segment.tool_noise = noise::<R>() * R::of(1.5) * used;
        }
        segment
    }

    /// The segment with the limits of the axes alone.
    fn of_axes(
        limits: &Reciprocals<A, R>,
        from: &PathPoint<A>,
        to: &PathPoint<A>,
        ds: f64,
    ) -> Self {
        let inverse = R::ONE / R::of(ds);
        let mut segment = Self {
            axes: A::filled(AxisLoad::NONE),
            ends: [R::ZERO; 2],
            tool: [R::ZERO; 2],
            tool_noise: R::ZERO,
        };
        let [from_end, to_end] = &mut segment.ends;
        let positions = (from.position.as_slice().iter()).zip(to.position.as_slice());
        let slopes = (from.slope.as_slice().iter()).zip(to.slope.as_slice());
        let all = (A::each_mut(&mut segment.axes).iter_mut().zip(limits.axes()))
            .zip(positions.zip(slopes));
        for ((load, limit), ((q0, q1), (p0, p1))) in all {
            let (p0, p1) = (R::of(*p0), R::of(*p1));
            let mean = R::of(q1 - q0) * inverse;
            *load = AxisLoad::new(limit, mean, [p0, p1], inverse);
            *from_end = from_end.max(p0.abs() * limit.speed);
            *to_end = to_end.max(p1.abs() * limit.speed);
        }
        segment
    }

    /// The largest utilisation of a limit at these speeds, squared where it is a speed:
    /// at most 1 where all hold, and growing with the square of both speeds.
    #[inline]
    pub(crate) fn load(&self, w0: R, w1: R) -> R {
        let [from, to] = self.ends;
        let (y, z) = products(w0, w1);
        let mut hardest = R::ZERO;
        let mut fastest = (from * w0).max(to * w1);
        for axis in A::each(&self.axes) {
            let noise = axis.noise * y * R::of(ROOT_NOISE);
            for [c, d] in axis.accelerations {
                hardest = larger(hardest, (c * y + d * z).abs() + noise);
            }
            let [e, f] = axis.middle;
            fastest = larger(fastest, (e * w0 + f * w1).abs());
        }
        let [c, d] = self.tool;
        let noise = self.tool_noise * y * R::of(ROOT_NOISE);
        hardest = larger(hardest, (c * y + d * z).abs() + noise);
        hardest.max(fastest * fastest)
    }

    /// What each axis asks for.
    pub(crate) const fn axes(&self) -> &A::Of<AxisLoad<R>> {
        &self.axes
    }

    /// Largest utilisation of a speed limit per w₀, and per w₁.
    pub(crate) const fn ends(&self) -> [R; 2] {
        self.ends
    }

    /// Acceleration of the tool: coefficients of y and z.
    pub(crate) const fn tool(&self) -> [R; 2] {
        self.tool
    }

    pub(crate) fn holds(&self, w0: R, w1: R) -> bool {
        self.load(w0, w1) <= root()
    }

    /// The highest speed at one end, at most `cap`, that the limits from above allow with the
    /// speed `other` at the other end. Where a limit asks for a higher speed, the result does
    /// not hold: the caller looks.
    pub(crate) fn highest(&self, end: End, other: R, cap: R) -> R {
        let [from, to] = self.ends;
        let scale = if end == End::From { from } else { to };
        let mut speed = cap;
        if scale * speed > R::ONE {
            speed = R::ONE / scale;
        }
        for axis in A::each(&self.axes) {
            let [e, f] = axis.middle;
            let (own, others) = if end == End::From { (e, f) } else { (f, e) };
            let value = own * speed + others * other;
            if value.abs() > R::ONE {
                let highest = (R::ONE.copysign(value) - others * other) / own;
                if highest > R::ZERO && highest < speed {
                    speed = highest;
                }
            }
        }
        for axis in A::each(&self.axes) {
            for terms in axis.accelerations {
                speed = below(terms, axis.noise, end, [other, speed]);
            }
        }
        below(self.tool, self.tool_noise, end, [other, speed])
    }

    /// The pair of speeds with which the segment takes the least time, at most `ceiling` at its end
    /// and `cap` at its start; where the machine brakes as hard as it can to the ceiling, the
    /// highest speed to brake from.
    ///
    /// Where the ceiling cannot be kept, the speeds differ at most by a factor of [`GROWTH`]: no
    /// segment is begun at a speed whose only partner is next to rest.
    pub(crate) fn begin(&self, ceiling: R, cap: R) -> (R, R) {
        if cap <= R::ZERO {
            return (R::ZERO, ceiling.min(self.speed_from_rest()));
        }
        if ceiling <= R::ZERO {
            return (cap.min(self.speed_to_rest()), R::ZERO);
        }
        let fast = self.highest(End::From, ceiling, cap);
        if fast >= ceiling && self.holds(fast, ceiling) {
            return (fast, ceiling);
        }
        self.shortest(ceiling, cap)
    }

    /// The highest speed at the end after a start at rest.
    pub(crate) fn speed_from_rest(&self) -> R {
        R::ONE / Real::sqrt(self.load(R::ZERO, R::ONE))
    }

    /// The highest speed at the start before a rest at the end.
    pub(crate) fn speed_to_rest(&self) -> R {
        R::ONE / Real::sqrt(self.load(R::ONE, R::ZERO))
    }

    /// The pair of the least time.
    ///
    /// With W = w₀ + w₁ and r = (w₁ - w₀) / W each utilisation is W² times a convex function of r,
    /// so the least of their largest is found between two slopes by the cut of their tangents.
    fn shortest(&self, ceiling: R, cap: R) -> (R, R) {
        let at = |r: R| self.tangent(r, [R::ONE / cap, R::ONE / ceiling]);
        let [mut low, mut high] = [-STEEPEST, STEEPEST].map(|r| (R::of(r), at(R::of(r))));
        let (r, load) = 'found: {
            if low.1.slope >= R::ZERO {
                break 'found (low.0, low.1.load);
            }
            if high.1.slope <= R::ZERO {
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
                if best.1.load - least <= best.1.load * R::of(CLOSE) {
                    break;
                }
                if here.slope > R::ZERO {
                    high = (r, here);
                } else {
                    low = (r, here);
                }
            }
            (best.0, best.1.load)
        };
        let half = R::ONE / Real::sqrt(load);
        (
            (half * (R::ONE - r)).min(cap),
            (half * (R::ONE + r)).min(ceiling),
        )
    }

    /// The largest utilisation at w₀ = 1 - r and w₁ = 1 + r, and its derivative by r. `ends` are
    /// one over the highest speed at each end.
    #[inline]
    fn tangent(&self, r: R, ends: [R; 2]) -> Tangent<R> {
        let mut largest = Tangent::default();
        let mut fastest = Tangent::default();
        for axis in A::each(&self.axes) {
            for [c, d] in axis.accelerations {
                let value = c + d * r;
                largest.raise(
                    value.abs() + axis.noise,
                    if value < R::ZERO { -d } else { d },
                );
            }
            let [e, f] = axis.middle;
            let value = e * (R::ONE - r) + f * (R::ONE + r);
            fastest.raise(value.abs(), if value < R::ZERO { e - f } else { f - e });
        }
        let [c, d] = self.tool;
        let value = c + d * r;
        largest.raise(
            value.abs() + self.tool_noise,
            if value < R::ZERO { -d } else { d },
        );
        let [from, to] = self.ends;
        let [from, to] = [from.max(ends[0]), to.max(ends[1])];
        fastest.raise(from * (R::ONE - r), -from);
        fastest.raise(to * (R::ONE + r), to);
        largest.raise(
            fastest.load * fastest.load,
            R::of(2.0) * fastest.load * fastest.slope,
        );
        largest
    }

    /// The highest speed at the end, at most `ceiling`, after the speed `w0`.
    ///
    /// Each limit forbids an interval of speeds or all above one. Where the next lower speed that
    /// one allows is forbidden by another, the search goes on from there.
    fn reach(&self, w0: R, ceiling: R) -> Option<R> {
        let least = w0.min(ceiling) / R::of(GROWTH);
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

    /// The highest speed at the end, at most `ceiling`, after the speed `w0`; with the speed w₀
    /// times `ratio` the segment holds.
    pub(crate) fn end(&self, w0: R, ceiling: R, ratio: R) -> R {
        if w0 <= R::ZERO {
            return ceiling.min(self.speed_from_rest());
        }
        if ceiling <= R::ZERO {
            return R::ZERO;
        }
        let known = w0 * ratio;
        self.reach(w0, ceiling)
            .map_or(known, |speed| speed.max(known))
    }

    /// The speed at the end that is nearest to `wanted` after the speed `w0`, where `known` holds:
    /// the highest below it, else the lowest above it that is found.
    pub(crate) fn toward(&self, w0: R, wanted: R, known: R) -> R {
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
        let step = (known - wanted) / R::of(f64::from(SAMPLES));
        let mut samples = (1..SAMPLES).map(|sample| wanted + step * R::of(f64::from(sample)));
        let mut good = samples.find(|w1| self.holds(w0, *w1)).unwrap_or(known);
        let mut bad = good - step;
        for _ in 0..HALVINGS {
            let middle = (good + bad) * R::of(0.5);
            if self.holds(w0, middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        good
    }

    /// The lowest speed at the end after the speed `w0`, where `known` holds: at most slower by a
    /// factor of [`GROWTH`].
    pub(crate) fn slowest(&self, w0: R, known: R) -> R {
        let least = (w0 / R::of(GROWTH)).min(known);
        self.toward(w0, least, known)
    }
}

/// By what one speed of a pair that is chosen for the least time alone may be above the other: what
/// constant acceleration makes of it on knots as dense as those at a rest.
pub(crate) const GROWTH: f64 = 8.0;

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
struct Tangent<R> {
    load: R,
    slope: R,
}

impl<R: Real> Tangent<R> {
    /// The larger one.
    #[inline]
    fn raise(&mut self, load: R, slope: R) {
        if load > self.load {
            *self = Self { load, slope };
        }
    }
}

/// y and z of the two speeds.
#[inline]
fn products<R: Real>(w0: R, w1: R) -> (R, R) {
    let (mean, rise) = ((w0 + w1) * R::of(0.5), (w1 - w0) * R::of(0.5));
    (mean * mean, mean * rise)
}

/// The highest speed at one end, at most the second one, that an acceleration allows with the first
/// one at the other end, if a limit from above forbids the second.
#[inline]
fn below<R: Real>([c, d]: [R; 2], noise: R, end: End, [other, speed]: [R; 2]) -> R {
    let d = if end == End::From { -d } else { d };
    let (y, z) = products(other, speed);
    let (value, noise_y) = (c * y + d * z, noise * y);
    if value + noise_y > R::ONE {
        lower(c + noise, d, other, speed)
    } else if value - noise_y < -R::ONE {
        lower(noise - c, -d, other, speed)
    } else {
        speed
    }
}

/// The speed w below `speed` at which c (w + o)²/4 + d (w² - o²)/4 = 1, if it does not hold
/// at `speed` and holds at zero.
fn lower<R: Real>(c: R, d: R, other: R, speed: R) -> R {
    let rest = (c - d) * other * other - R::of(4.0);
    if rest >= R::ZERO {
        return speed;
    }
    let linear = c * other;
    let root = Real::sqrt((linear * linear - (c + d) * rest).max(R::ZERO));
    let below = -rest / (linear + root);
    if below > R::ZERO && below < speed {
        below
    } else {
        speed
    }
}
