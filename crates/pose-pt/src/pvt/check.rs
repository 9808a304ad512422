//! What a table asks of the axes, found on the cubics that the controller will run.

use super::segment::NOISE;
use super::track::Track;
use super::{Knot, segments};
use crate::number::{cube_root, sqrt};
use crate::{Axis, LimitError, Locator, Platform, PvtPoint};

/// One axis over one segment.
#[derive(Debug, Clone, Copy)]
struct Cubic {
    q0: f64,
    q1: f64,
    v0: f64,
    v1: f64,
    duration: f64,
}

impl Cubic {
    /// Accelerations at both ends; between them the acceleration is linear.
    fn accelerations(&self) -> [f64; 2] {
        let six_means = 6.0 * (self.q1 - self.q0) / self.duration;
        [
            (six_means - 4.0 * self.v0 - 2.0 * self.v1) / self.duration,
            (2.0 * self.v0 + 4.0 * self.v1 - six_means) / self.duration,
        ]
    }

    /// What both accelerations may be off by where they are computed anew from rounded speeds
    /// and times.
    fn noise(&self) -> f64 {
        let mean = (self.q1 - self.q0).abs() / self.duration;
        NOISE * (mean + self.v0.abs() + self.v1.abs()) / self.duration
    }

    /// The largest speed.
    fn peak(&self) -> f64 {
        let ends = self.v0.abs().max(self.v1.abs());
        let [a0, a1] = self.accelerations();
        if (a0 > 0.0) == (a1 > 0.0) {
            return ends;
        }
        // Where the acceleration passes zero.
        let time = self.duration * a0 / (a0 - a1);
        ends.max((self.v0 + a0 * time * 0.5).abs())
    }

    /// Position at a share of the duration.
    fn position(&self, share: f64) -> f64 {
        let rest = 1.0 - share;
        let third = self.duration / 3.0;
        let (b1, b2) = (self.q0 + self.v0 * third, self.q1 - self.v1 * third);
        let outer = self.q0 * rest * rest * rest + self.q1 * share * share * share;
        outer + 3.0 * share * rest * (b1 * rest + b2 * share)
    }

    /// Whether the control points, and so the cubic, are within a stroke.
    fn surely_within(&self, min: f64, max: f64) -> bool {
        let third = self.duration / 3.0;
        let points = [
            self.q0 + self.v0 * third,
            self.q1 - self.v1 * third,
            self.q0,
            self.q1,
        ];
        points.iter().all(|point| *point >= min && *point <= max)
    }

    /// The lowest and the highest position.
    fn reach(&self) -> [f64; 2] {
        let (mut low, mut high) = (self.q0.min(self.q1), self.q0.max(self.q1));
        let [a0, a1] = self.accelerations();
        // v0 + a0 t + (a1 - a0) t² / 2T = 0, as shares of the duration.
        let (a, b) = ((a1 - a0) * self.duration * 0.5, a0 * self.duration * 0.5);
        let square = b * b - a * self.v0;
        if square >= 0.0 {
            let sum = -(b + sqrt(square).copysign(b));
            for share in [sum / a, self.v0 / sum] {
                if share > 0.0 && share < 1.0 {
                    let position = self.position(share);
                    (low, high) = (low.min(position), high.max(position));
                }
            }
        }
        [low, high]
    }
}

fn cubics<'a, const N: usize>(
    locators: &'a [Locator; N],
    from: &'a PvtPoint<N>,
    to: &'a PvtPoint<N>,
) -> impl Iterator<Item = (usize, usize, &'a crate::AxisLimits, Cubic)> {
    let ends = from.axes.iter().zip(&to.axes);
    let speeds = from.velocities.iter().zip(&to.velocities);
    let all = locators.iter().zip(ends.zip(speeds)).enumerate();
    all.flat_map(move |(number, (locator, ((q0, q1), (v0, v1))))| {
        let limits = locator.limits.iter().enumerate();
        let q = q0.iter().zip(q1.iter());
        let v = v0.iter().zip(v1.iter());
        limits
            .zip(q.zip(v))
            .map(move |((axis, limits), ((q0, q1), (v0, v1)))| {
                let cubic = Cubic {
                    q0: *q0,
                    q1: *q1,
                    v0: *v0,
                    v1: *v1,
                    duration: to.segment_s,
                };
                (number, axis, limits, cubic)
            })
    })
}

/// The axis that leaves its stroke between two points, if one does.
pub(super) fn strokes<const N: usize>(
    platform: &Platform<N>,
    from: &PvtPoint<N>,
    to: &PvtPoint<N>,
) -> Result<(), LimitError> {
    platform.check_axes(&to.axes)?;
    for (locator, axis, limits, cubic) in cubics(platform.locators(), from, to) {
        if cubic.surely_within(limits.min, limits.max) {
            continue;
        }
        let [low, high] = cubic.reach();
        let by = (limits.min - low).max(high - limits.max);
        if by > 0.0 {
            // Ends are checked with the tolerance of the platform.
            let value = if high > limits.max { high } else { low };
            let ends =
                (limits.min - cubic.q0.min(cubic.q1)).max(cubic.q0.max(cubic.q1) - limits.max);
            if by > ends {
                return Err(LimitError::Stroke {
                    locator,
                    axis: *Axis::ALL.get(axis).unwrap_or(&Axis::X),
                    value,
                    min: limits.min,
                    max: limits.max,
                    by,
                });
            }
        }
    }
    Ok(())
}

/// An axis at the end of a segment.
#[derive(Debug, Clone, Copy, Default)]
struct End {
    acceleration: f64,
    noise: f64,
}

/// The largest shares of the limits that a run of segments asks for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shares<const N: usize> {
    speed: f64,
    acceleration: f64,
    jerk: f64,
    /// All axes at the end of the segment before.
    before: [[End; 3]; N],
    segment_s: f64,
}

impl<const N: usize> Shares<N> {
    /// The shares of a leg's knots, from rest to rest.
    pub(super) fn of(locators: &[Locator; N], track: &Track<'_, N>, knots: &[Knot]) -> Self {
        let mut shares = Self::new();
        for [from, to] in segments(track, knots) {
            shares.add(locators, &from, &to);
        }
        shares.stop(locators);
        shares
    }

    /// At rest.
    fn new() -> Self {
        Self {
            speed: 0.0,
            acceleration: 0.0,
            jerk: 0.0,
            before: [[End::default(); 3]; N],
            segment_s: 0.0,
        }
    }

    /// By what the time may be multiplied at the least so that all limits are kept.
    pub(super) fn stretch(&self) -> f64 {
        self.speed
            .max(sqrt(self.acceleration))
            .max(cube_root(self.jerk))
    }

    /// Takes the segment from one point to the next into account.
    ///
    /// A cubic has one jerk. At a point the acceleration steps: that counts as a jerk over the
    /// time between the middles of the two segments.
    fn add(&mut self, locators: &[Locator; N], from: &PvtPoint<N>, to: &PvtPoint<N>) {
        let mean_s = (self.segment_s + to.segment_s) * 0.5;
        let mut before = self.before;
        let axes = before.as_flattened_mut();
        for ((_, _, limits, cubic), before) in cubics(locators, from, to).zip(axes) {
            let ([a0, a1], noise) = (cubic.accelerations(), cubic.noise());
            let hardest = a0.abs().max(a1.abs()) + noise;
            self.speed = self.speed.max(cubic.peak() / limits.speed);
            self.acceleration = self.acceleration.max(hardest / limits.acceleration);
            if let Some(limit) = limits.jerk {
                let inside = ((a1 - a0).abs() + 2.0 * noise) / to.segment_s;
                let step = ((a0 - before.acceleration).abs() + noise + before.noise) / mean_s;
                self.jerk = self.jerk.max(inside.max(step) / limit);
            }
            *before = End {
                acceleration: a1,
                noise,
            };
        }
        self.before = before;
        self.segment_s = to.segment_s;
    }

    /// Takes the standstill after the last segment into account.
    fn stop(&mut self, locators: &[Locator; N]) {
        let mean_s = self.segment_s * 0.5;
        let limits = locators.iter().flat_map(|locator| &locator.limits);
        for (limits, before) in limits.zip(self.before.as_flattened()) {
            if let Some(limit) = limits.jerk {
                let step = (before.acceleration.abs() + before.noise) / mean_s;
                self.jerk = self.jerk.max(step / limit);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector3};

    use super::{Cubic, Shares};
    use crate::{AxisLimits, Locator, PvtPoint};

    /// Places at which a cubic is looked at; between them it rises by less than `BETWEEN`.
    const PLACES: u32 = 2000;
    const BETWEEN: f64 = 1e-4;
    const ROUNDING: f64 = 1e-12;

    /// Numbers spread over -1..1.
    fn spread(number: u32, step: f64) -> f64 {
        (f64::from(number) * step).fract() * 2.0 - 1.0
    }

    fn cubics() -> impl Iterator<Item = Cubic> {
        (1..400).map(|number| Cubic {
            q0: spread(number, 0.618_034),
            q1: spread(number, 0.414_214),
            v0: 6.0 * spread(number, 0.732_051),
            v1: 6.0 * spread(number, 0.236_068),
            duration: 1.1 + spread(number, 0.302_776),
        })
    }

    /// Hermite's form, by time.
    fn position(cubic: &Cubic, share: f64) -> f64 {
        let [a0, a1] = cubic.accelerations();
        let time = share * cubic.duration;
        let jerk = (a1 - a0) / cubic.duration;
        cubic.q0 + (cubic.v0 + (a0 / 2.0 + jerk * time / 6.0) * time) * time
    }

    #[test]
    fn a_cubic_reaches_as_far_as_its_places() {
        for cubic in cubics() {
            let shares = (0..=PLACES).map(|place| f64::from(place) / f64::from(PLACES));
            let (mut least, mut most) = (f64::MAX, f64::MIN);
            for share in shares {
                let place = position(&cubic, share);
                assert!((cubic.position(share) - place).abs() < ROUNDING);
                (least, most) = (least.min(place), most.max(place));
            }
            assert!((position(&cubic, 1.0) - cubic.q1).abs() < ROUNDING);
            let [low, high] = cubic.reach();
            assert!(
                low <= least + ROUNDING && low > least - BETWEEN,
                "{cubic:?}"
            );
            assert!(
                high >= most - ROUNDING && high < most + BETWEEN,
                "{cubic:?}"
            );
        }
    }

    #[test]
    fn what_is_surely_within_is() {
        let mut surely = 0;
        for (number, cubic) in (0..).zip(cubics()) {
            let (min, max) = (-0.9 - spread(number, 0.1), 1.1 + spread(number, 0.3));
            let [low, high] = cubic.reach();
            if cubic.surely_within(min, max) {
                surely += 1;
                assert!(low >= min - ROUNDING && high <= max + ROUNDING, "{cubic:?}");
            }
            // The control points are a third of the duration along the speeds.
            let third = cubic.duration / 3.0;
            let points = [
                cubic.q0,
                cubic.q0 + third * cubic.v0,
                cubic.q1 - third * cubic.v1,
                cubic.q1,
            ];
            let lowest = points.into_iter().fold(f64::MAX, f64::min);
            let highest = points.into_iter().fold(f64::MIN, f64::max);
            assert!(cubic.surely_within(lowest - ROUNDING, highest + ROUNDING));
            assert!(!cubic.surely_within(lowest + ROUNDING, highest));
            assert!(!cubic.surely_within(lowest, highest - ROUNDING));
        }
        assert!(surely > 10, "{surely}");
    }

    /// Along X: 2 s of 1 mm/s² from rest, 1 s of -2 mm/s² to rest. No jerk inside; the steps
    /// are 1, 3 and 2 mm/s² over half of 2 s, half of 3 s, half of 1 s.
    #[test]
    fn steps_of_the_acceleration_are_jerks() {
        let limits = AxisLimits::new(-9.0, 9.0, 4.0, 5.0);
        let axes = [limits.with_jerk(8.0), limits, limits];
        let locators = [Locator::new(Point3::origin(), Point3::origin(), axes)];
        let point = |segment_s, x, speed| PvtPoint {
            time_s: 0.0,
            segment_s,
            axes: [Vector3::new(x, 0.0, 0.0)],
            velocities: [Vector3::new(speed, 0.0, 0.0)],
        };
        let points = [
            point(0.0, 0.0, 0.0),
            point(2.0, 2.0, 2.0),
            point(1.0, 3.0, 0.0),
        ];
        let mut shares = Shares::new();
        let mut jerks = [0.0; 3];
        for (jerk, pair) in jerks.iter_mut().zip(points.windows(2)) {
            shares.add(&locators, &pair[0], &pair[1]);
            *jerk = shares.jerk;
        }
        shares.stop(&locators);
        jerks[2] = shares.jerk;
        let wanted = [1.0, 2.0, 4.0].map(|jerk| jerk / 8.0);
        let off = jerks
            .iter()
            .zip(wanted)
            .map(|(a, b): (&f64, f64)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < ROUNDING, "{jerks:?}");
        assert!((shares.speed - 2.0 / 4.0).abs() < ROUNDING);
        assert!((shares.acceleration - 2.0 / 5.0).abs() < ROUNDING);
        // The jerk asks for the most: 0.79 against 0.63 and 0.5.
        assert!((shares.stretch() - 0.5_f64.cbrt()).abs() < ROUNDING);
    }
}
