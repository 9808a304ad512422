//! What a cubic segment asks of the axes, as a function of the path speeds at its ends.

use nalgebra::RealField;

use crate::Locator;
use crate::course::Place;
use crate::number::{constant, epsilons, half, larger, magnitude};

/// One over the limits of speed and acceleration of each axis, a margin included.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reciprocals<const N: usize, T>([[[T; 2]; 3]; N]);

impl<const N: usize, T: RealField + Copy> Reciprocals<N, T> {
    pub(crate) fn new(locators: &[Locator<T>; N]) -> Self {
        let margin = T::one() + epsilons(MARGIN_EPSILONS);
        Self(locators.map(|locator| {
            locator
                .limits
                .map(|limits| [margin / limits.speed, margin / limits.acceleration])
        }))
    }
}

/// The end of a segment whose speed is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    From,
    To,
}

/// All limits of one cubic segment, in the speeds w₀ and w₁ of the parameter at its ends.
///
/// With Δs the way, m = Δq/Δs, p₀ and p₁ the slopes dq/ds at the ends, and the duration
/// T = 2 Δs / (w₀ + w₁), the cubic that a controller runs has the accelerations
///
/// ```text
/// a₀ = ((6m - 4p₀ - 2p₁) y + (4p₀ - 2p₁) z) / Δs     y = (w₀ + w₁)² / 4
/// a₁ = ((2p₀ + 4p₁ - 6m) y + (4p₁ - 2p₀) z) / Δs     z = (w₁² - w₀²) / 4
/// ```
///
/// at its ends, and between them no larger ones. Its speed has the Bernstein coefficients
/// p₀ w₀, (3m/2 - p₀) w₀ + (3m/2 - p₁) w₁ and p₁ w₁: no larger value is passed on the way.
/// All of it scales with the speeds: what holds for a pair holds for each slower pair of the
/// same ratio.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Segment<const N: usize, T> {
    /// Accelerations at both ends as shares of the limits: coefficients of y and z.
    accelerations: [[[[T; 2]; 2]; 3]; N],
    /// The middle of the speed as a share of the limit: coefficients of w₀ and w₁.
    middles: [[[T; 2]; 3]; N],
    /// Largest share of a speed limit per w₀, and per w₁.
    ends: [T; 2],
}

/// By how much limits are taken lower, in machine epsilons: what the products below and
/// those of a table's reader round off.
const MARGIN_EPSILONS: f64 = 64.0;

/// What a root may be off by, in machine epsilons; less than the margin.
const ROOT_EPSILONS: f64 = 32.0;

/// Halvings that leave nothing of a relative gap.
const HALVINGS: u32 = 48;

impl<const N: usize, T: RealField + Copy> Segment<N, T> {
    pub(crate) fn new(
        limits: &Reciprocals<N, T>,
        from: &Place<N, T>,
        to: &Place<N, T>,
        way: T,
    ) -> Self {
        let (two, four) = (constant::<T>(2.0), constant::<T>(4.0));
        let (inverse, half_thrice) = (T::one() / way, constant::<T>(1.5));
        let zero = T::zero();
        let mut segment = Self {
            accelerations: [[[[zero; 2]; 2]; 3]; N],
            middles: [[[zero; 2]; 3]; N],
            ends: [zero; 2],
        };
        let rows = segment.accelerations.iter_mut().zip(&mut segment.middles);
        let places = from.axes.iter().zip(&to.axes);
        let slopes = from.slope.iter().zip(&to.slope);
        for ((limits, (accelerations, middles)), ((q0, q1), (p0, p1))) in
            limits.0.iter().zip(rows).zip(places.zip(slopes))
        {
            let q = q0.iter().zip(q1.iter());
            let p = p0.iter().zip(p1.iter());
            let rows = accelerations.iter_mut().zip(middles);
            for (([speed, acceleration], (row, middle)), ((q0, q1), (p0, p1))) in
                limits.iter().zip(rows).zip(q.zip(p))
            {
                let (p0, p1) = (*p0, *p1);
                let mean = (*q1 - *q0) * inverse;
                let six = constant::<T>(6.0) * mean;
                let share = inverse * *acceleration;
                *row = [
                    [
                        (six - four * p0 - two * p1) * share,
                        (four * p0 - two * p1) * share,
                    ],
                    [
                        (two * p0 + four * p1 - six) * share,
                        (four * p1 - two * p0) * share,
                    ],
                ];
                let high = half_thrice * mean;
                *middle = [(high - p0) * *speed, (high - p1) * *speed];
                let [from, to] = &mut segment.ends;
                *from = larger(*from, magnitude(p0) * *speed);
                *to = larger(*to, magnitude(p1) * *speed);
            }
        }
        segment
    }

    /// The largest share of a limit that these speeds ask for, squared where it is a speed:
    /// at most 1 where all hold, and growing with the square of both speeds.
    #[inline]
    pub(crate) fn load(&self, w0: T, w1: T) -> T {
        let [from, to] = self.ends;
        let fastest = larger(from * w0, to * w1);
        let (y, z) = products(w0, w1);
        let mut hardest = T::zero();
        let mut middle = fastest;
        for (accelerations, middles) in self.accelerations.iter().zip(&self.middles) {
            for [[c0, d0], [c1, d1]] in accelerations {
                hardest = larger(hardest, magnitude(*c0 * y + *d0 * z));
                hardest = larger(hardest, magnitude(*c1 * y + *d1 * z));
            }
            for [e, f] in middles {
                middle = larger(middle, magnitude(*e * w0 + *f * w1));
            }
        }
        larger(hardest, middle * middle)
    }

    pub(crate) fn holds(&self, w0: T, w1: T) -> bool {
        self.load(w0, w1) <= T::one() + epsilons(ROOT_EPSILONS)
    }

    /// The highest speed at one end, at most `cap`, that the limits from above allow with the
    /// speed `other` at the other end. Where a limit asks for a higher speed, the result does
    /// not hold: the caller looks.
    pub(crate) fn highest(&self, end: End, other: T, cap: T) -> T {
        let [from, to] = self.ends;
        let share = if end == End::From { from } else { to };
        let mut speed = cap;
        if share * speed > T::one() {
            speed = T::one() / share;
        }
        for middle in self.middles.as_flattened() {
            let [e, f] = *middle;
            let (own, others) = if end == End::From { (e, f) } else { (f, e) };
            let value = own * speed + others * other;
            if magnitude(value) > T::one() {
                let highest = (T::one().copysign(value) - others * other) / own;
                if highest > T::zero() && highest < speed {
                    speed = highest;
                }
            }
        }
        for row in self.accelerations.as_flattened().as_flattened() {
            let [c, d] = *row;
            let d = if end == End::From { -d } else { d };
            let (y, z) = products(other, speed);
            let value = c * y + d * z;
            if value > T::one() {
                speed = lower(c, d, other, speed);
            } else if value < -T::one() {
                speed = lower(-c, -d, other, speed);
            }
        }
        speed
    }

    /// The highest speed from which the segment can be begun if it must end with at most
    /// `ceiling`, and the speed at its end that goes with it.
    pub(crate) fn begin(&self, ceiling: T, cap: T) -> (T, T) {
        let fast = self.highest(End::From, ceiling, cap);
        if self.holds(fast, ceiling) {
            return (fast, ceiling);
        }
        let end = self.highest(End::To, fast, ceiling);
        if self.holds(fast, end) {
            return (fast, end);
        }
        // On the ray to that pair a slower one holds; from there up by halves.
        let scale = T::one() / self.load(fast, end).sqrt();
        let (mut best, mut low, mut high) = ((fast * scale, end * scale), fast * scale, fast);
        for _ in 0..HALVINGS {
            if high - low <= low * nalgebra::convert(CLOSE) {
                break;
            }
            let middle = (low + high) * half();
            let end = self.highest(End::To, middle, ceiling);
            if self.holds(middle, end) {
                (best, low) = ((middle, end), middle);
            } else {
                high = middle;
            }
        }
        best
    }

    /// The highest speed at the end, at most `ceiling`, after the speed `w0`; `known` is one
    /// that holds.
    pub(crate) fn end(&self, w0: T, ceiling: T, known: T) -> T {
        let fast = self.highest(End::To, w0, ceiling);
        if w0 == T::zero() {
            let load = self.load(w0, fast);
            return fast / load.max(T::one()).sqrt();
        }
        self.toward(w0, fast, known)
    }

    /// The speed at the end that is nearest to `wanted` on the way from `known`, which holds.
    pub(crate) fn toward(&self, w0: T, wanted: T, known: T) -> T {
        if self.holds(w0, wanted) {
            return wanted;
        }
        let (mut good, mut bad) = (known, wanted);
        for _ in 0..HALVINGS {
            let middle = (good + bad) * half();
            if self.holds(w0, middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        good
    }
}

/// Relative gap at which the search for a beginning stops: it costs that share of the time.
const CLOSE: f64 = 1e-5;

/// y and z of the two speeds.
#[inline]
fn products<T: RealField + Copy>(w0: T, w1: T) -> (T, T) {
    let (mean, rise) = ((w0 + w1) * half(), (w1 - w0) * half());
    (mean * mean, mean * rise)
}

/// The speed w below `speed` at which c (w + o)²/4 + d (w² - o²)/4 = 1, if it does not hold
/// at `speed` and holds at zero.
fn lower<T: RealField + Copy>(c: T, d: T, other: T, speed: T) -> T {
    let four = nalgebra::convert::<f64, T>(4.0);
    let rest = (c - d) * other * other - four;
    if rest >= T::zero() {
        return speed;
    }
    let linear = c * other;
    let root = (linear * linear - (c + d) * rest).max(T::zero()).sqrt();
    let below = -rest / (linear + root);
    if below > T::zero() && below < speed {
        below
    } else {
        speed
    }
}
