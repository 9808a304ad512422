//! From one feed to another over some segments, by ramps of its rate.

use super::root;

/// A change of the feed over some segments, with ramps of its rate at both ends.
///
/// ```text
/// f = f₀ + (f₁ - f₀) g(x)        x = t / T
/// g' rises over 0..α, is constant, and falls over 1-β..1;  ∫ g' = 1
/// ```
///
/// The integral of f is the table's own time. A stop ends, and a start begins, without a step of
/// the acceleration.
#[derive(Debug, Clone, Copy)]
pub(super) struct FeedChange {
    from: f64,
    to: f64,
    ramps: [f64; 2],
    /// T.
    duration_s: f64,
    /// Time of the table since it began.
    table_s: f64,
}

/// Ramps as fractions of a change: short ones where the acceleration limits it, long ones where the
/// jerk does, one end slower where the table leaves little of either.
const RAMPS: [[f64; 2]; 10] = [
    [0.08, 0.08],
    [0.15, 0.15],
    [0.25, 0.25],
    [0.35, 0.35],
    [0.5, 0.5],
    [0.5, 0.15],
    [0.15, 0.5],
    [0.8, 0.2],
    [0.2, 0.8],
    [0.65, 0.35],
];

/// g and its integral from 0.
fn shape([rise, fall]: [f64; 2], x: f64) -> [f64; 2] {
    let rate = 1.0 / (1.0 - 0.5 * (rise + fall));
    if x < rise {
        let g = rate * x * x * 0.5 / rise;
        return [g, g * x / 3.0];
    }
    let (g_rise, sum_rise) = (rate * rise * 0.5, rate * rise * rise / 6.0);
    if x <= 1.0 - fall {
        let on = x - rise;
        return [
            g_rise + rate * on,
            sum_rise + (g_rise + rate * on * 0.5) * on,
        ];
    }
    // From the end: 1 - g is a ramp as well, and the integral of g over 0..1 is known.
    let rest = 1.0 - x;
    let missing = rate * rest * rest * 0.5 / fall;
    let on = 1.0 - fall - rise;
    let middle = sum_rise + (g_rise + rate * on * 0.5) * on;
    let whole = middle + fall - rate * fall * fall / 6.0;
    [1.0 - missing, whole - (rest - missing * rest / 3.0)]
}

impl FeedChange {
    /// With each of the ramps, over segments that take `table_s` at a feed of 1.
    pub(super) fn over(table_s: f64, [from, to]: [f64; 2]) -> impl Iterator<Item = Self> {
        RAMPS.iter().map(move |ramps| {
            let mut change = Self {
                from,
                to,
                ramps: *ramps,
                duration_s: 1.0,
                table_s: 0.0,
            };
            let [_, mean] = change.values(1.0);
            change.duration_s = table_s / mean;
            change
        })
    }

    /// The feed, and its integral from 0 by x.
    fn values(&self, x: f64) -> [f64; 2] {
        let [g, integral] = shape(self.ramps, x);
        let change = self.to - self.from;
        [self.from + change * g, self.from * x + change * integral]
    }

    /// The feed at the next knot, over a segment that takes `table_s` at a feed of 1.
    pub(super) fn step(&mut self, table_s: f64) -> f64 {
        self.table_s += table_s;
        let wanted = self.table_s / self.duration_s;
        let passed = |x| {
            let [feed, reached] = self.values(x);
            [reached - wanted, feed]
        };
        let x = root::of_rising([0.0, 1.0], wanted.min(1.0), passed);
        let [feed, _] = self.values(x);
        feed
    }
}
