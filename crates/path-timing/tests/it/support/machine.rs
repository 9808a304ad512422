//! A polar arm on lines.

use core::convert::Infallible;

use path_timing::{AxisLimits, Path, PathPoint};

/// A line of the plane, run by the angle and the reach of a polar arm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    pub(crate) from: [f64; 2],
    pub(crate) to: [f64; 2],
}

impl Path for Line {
    type Axes = [f64; 2];
    type Error = Infallible;

    fn length(&self) -> f64 {
        (self.to[0] - self.from[0]).hypot(self.to[1] - self.from[1])
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 2]>, Infallible> {
        let share = s / self.length();
        let [dx, dy] = [0, 1].map(|i| (self.to[i] - self.from[i]) / self.length());
        // The ends to the last bit, where lines join.
        let [x, y] = [0, 1].map(|i| self.from[i] * (1.0 - share) + self.to[i] * share);
        let reach = x.hypot(y);
        Ok(PathPoint {
            position: [y.atan2(x), reach],
            slope: [
                (x * dy - y * dx) / (reach * reach),
                (x * dx + y * dy) / reach,
            ],
        })
    }
}

pub(crate) const fn limits(speed: f64, acceleration: f64, jerk: Option<f64>) -> AxisLimits {
    AxisLimits {
        speed,
        acceleration,
        jerk,
    }
}
