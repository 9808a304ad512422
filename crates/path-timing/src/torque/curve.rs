//! What a motor can give at its speed.

use trig_kernels::SixDigits;

use crate::number::{SMALLEST, range, smaller};

/// The torque that a motor can give, by its speed: straight between points, nothing beyond the
/// last.
///
/// Where the points rise again, as after a resonance, the motor has to come through the lower
/// torque before: that is taken.
///
/// ```
/// use path_timing::TorqueCurve;
///
/// // 1.9 Nm up to 10 rad/s, then as 1/speed, up to 100 rad/s; behind a gear of 10:1.
/// let motor = TorqueCurve::holding(1.9, 10.0, 100.0)?.geared(10.0)?;
/// assert!((motor.at(0.5) - 19.0).abs() < 0.2 && (motor.at(2.0) - 9.5).abs() < 0.2);
/// assert_eq!(motor.at(10.1), 0.0);
/// # Ok::<(), path_timing::TorqueCurveError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueCurve {
    /// Speed and torque.
    points: [[f64; 2]; Self::MAX_POINTS],
    count: usize,
}

/// Why points are no curve.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TorqueCurveError {
    /// No point, or more than a curve has.
    #[error("{count} points are not within 1..={max}")]
    Count {
        /// Points given.
        count: usize,
        /// The most.
        max: usize,
    },
    /// A speed that does not rise from 0 on, or a torque that is not above 0, or a gear ratio.
    #[error("point {index}: {name} of {} is out of its range", SixDigits(*.value))]
    Value {
        /// The point, from 0.
        index: usize,
        /// Which: `speed`, `torque` or `gear ratio`.
        name: &'static str,
        /// Its value.
        value: f64,
    },
}

impl TorqueCurve {
    /// The most points of a curve.
    pub const MAX_POINTS: usize = 16;

    /// The same torque up to a speed.
    ///
    /// # Errors
    /// [`TorqueCurveError`] for a number that is not above 0.
    pub fn constant(torque: f64, max_speed: f64) -> Result<Self, TorqueCurveError> {
        Self::from_points(&[[0.0, torque], [max_speed, torque]])
    }

    /// A curve of speeds that rise from 0 on, and torques above 0, as the pull-out curve of a data
    /// sheet.
    ///
    /// # Errors
    /// [`TorqueCurveError`].
    pub fn from_points(points: &[[f64; 2]]) -> Result<Self, TorqueCurveError> {
        let (count, max) = (points.len(), Self::MAX_POINTS);
        if count == 0 || count > max {
            return Err(TorqueCurveError::Count { count, max });
        }
        let mut curve = Self {
            points: [[0.0; 2]; Self::MAX_POINTS],
            count,
        };
        let mut before = [-SMALLEST, f64::INFINITY];
        for (index, (slot, [speed, torque])) in curve.points.iter_mut().zip(points).enumerate() {
            let refused = |name, value| Err(TorqueCurveError::Value { index, name, value });
            // Written so that NaN is out.
            let rises = *speed > before[0] && (index > 0) == (*speed > 0.0);
            if !rises || *speed > *range().end() {
                return refused("speed", *speed);
            }
            if !range().contains(torque) {
                return refused("torque", *torque);
            }
            before = [*speed, smaller(before[1], *torque)];
            *slot = before;
        }
        Ok(curve)
    }

    /// The torque of a stepper, from its holding torque and the speed at which its winding's
    /// voltage is used up: what most pull-out curves are like. The curve is at most 1 % below it
    /// where the largest speed is up to 16 times the corner.
    ///
    /// ```text
    /// torque min(1, corner / speed)
    /// ```
    ///
    /// # Errors
    /// [`TorqueCurveError`] for a number that is not above 0, and a corner above the largest speed.
    pub fn holding(torque: f64, corner: f64, max_speed: f64) -> Result<Self, TorqueCurveError> {
        let steps = POINTS_BEYOND_CORNER;
        let ratio = libm::exp(libm::log(max_speed / corner) / f64::from(steps));
        // A chord of 1/v is above it by at most (q - 1)²/4q, where speeds rise by q.
        let above = (ratio - 1.0) * (ratio - 1.0) / (4.0 * ratio);
        let lower = torque / (1.0 + above);
        let mut points = [[0.0, lower]; Self::MAX_POINTS];
        let mut speed = corner;
        for (index, point) in points.iter_mut().skip(1).enumerate() {
            let is_last = index.saturating_add(2) == Self::MAX_POINTS;
            let speed_here = if is_last { max_speed } else { speed };
            *point = [speed_here, lower * corner / speed_here];
            speed *= ratio;
        }
        Self::from_points(&points)
    }

    /// The curve at the slow side of a gear: so many times the torque at so many times lower
    /// speeds.
    ///
    /// # Errors
    /// [`TorqueCurveError`] for a ratio that is not above 0.
    pub fn geared(self, ratio: f64) -> Result<Self, TorqueCurveError> {
        if !range().contains(&ratio) {
            return Err(TorqueCurveError::Value {
                index: 0,
                name: "gear ratio",
                value: ratio,
            });
        }
        Ok(self.map(|[speed, torque]| [speed / ratio, torque * ratio]))
    }

    /// The curve with each torque times a factor above 0: 0.9 for a reserve of 10 %.
    ///
    /// # Errors
    /// [`TorqueCurveError`] for a factor that is not above 0.
    pub fn scaled(self, factor: f64) -> Result<Self, TorqueCurveError> {
        if !range().contains(&factor) {
            return Err(TorqueCurveError::Value {
                index: 0,
                name: "factor",
                value: factor,
            });
        }
        Ok(self.map(|[speed, torque]| [speed, torque * factor]))
    }

    fn map(mut self, change: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        for point in &mut self.points {
            *point = change(*point);
        }
        self
    }

    /// The torque at a speed of either direction; 0 beyond the last point.
    #[must_use]
    pub fn at(&self, speed: f64) -> f64 {
        let speed = speed.abs();
        let (mut value, mut is_within) = (0.0, false);
        self.each_piece(|[v0, v1], [t0, t1]| {
            is_within = speed >= v0 && speed <= v1;
            if is_within {
                let fraction = if v1 > v0 {
                    (speed - v0) / (v1 - v0)
                } else {
                    0.0
                };
                value = t0 + (t1 - t0) * fraction;
            }
            is_within
        });
        if is_within { value } else { 0.0 }
    }

    /// The points that there are.
    fn known(&self) -> &[[f64; 2]] {
        self.points.get(..self.count).unwrap_or_default()
    }

    /// The speed of the last point.
    pub(super) fn max_speed(&self) -> f64 {
        self.known().last().map_or(0.0, |[speed, _]| *speed)
    }

    /// The straight pieces, until the function is through: speeds and torques at both ends.
    pub(super) fn each_piece(&self, mut is_last: impl FnMut([f64; 2], [f64; 2]) -> bool) {
        let points = self.known();
        let ends = points.iter().skip(1).chain(points.last());
        for ([v0, t0], [v1, t1]) in points.iter().zip(ends) {
            if is_last([*v0, *v1], [*t0, *t1]) {
                return;
            }
        }
    }
}

/// Points of a holding torque's curve from the corner on, less one.
const POINTS_BEYOND_CORNER: u32 = 14;
