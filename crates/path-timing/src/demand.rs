//! Utilisation of the limits by the cubics that the controller will run.

use crate::number::{cube_root, sqrt};
use crate::reciprocals::Reciprocals;
use crate::{Axes, Cubic, Row, ToolLimits};

/// An axis at the end of a segment.
#[derive(Debug, Clone, Copy)]
struct End {
    acceleration: f64,
    noise: f64,
}

impl End {
    const REST: Self = Self {
        acceleration: 0.0,
        noise: 0.0,
    };
}

/// The largest utilisation of each kind of limit over consecutive segments.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Demand<A: Axes> {
    speed: f64,
    acceleration: f64,
    jerk: f64,
    /// All axes at the end of the segment before.
    before: A::Of<End>,
    duration_s: f64,
}

impl<A: Axes> Demand<A> {
    pub(crate) fn at_rest() -> Self {
        Self {
            speed: 0.0,
            acceleration: 0.0,
            jerk: 0.0,
            before: A::filled(End::REST),
            duration_s: 0.0,
        }
    }

    /// The smallest factor of the time with which all limits are kept.
    pub(crate) fn stretch(&self) -> f64 {
        self.speed
            .max(sqrt(self.acceleration))
            .max(cube_root(self.jerk))
    }

    /// Takes the segment from one row to the next into account.
    ///
    /// A cubic has one jerk. At a row the acceleration steps: that counts as a jerk over the
    /// time between the middles of the two segments.
    pub(crate) fn add(&mut self, limits: &Reciprocals<A>, from: &Row<A>, to: &Row<A>) {
        let mean_s = (self.duration_s + to.duration_s) * 0.5;
        let axes = limits.axes().iter().zip(A::each_mut(&mut self.before));
        for (cubic, (limits, before)) in Cubic::between(from, to).zip(axes) {
            let ([a0, a1], noise) = (cubic.accelerations(), cubic.noise());
            let hardest = a0.abs().max(a1.abs()) + noise;
            self.speed = self.speed.max(cubic.peak_speed() * limits.speed);
            self.acceleration = self.acceleration.max(hardest * limits.acceleration);
            let inside = ((a1 - a0).abs() + 2.0 * noise) / to.duration_s;
            let step = ((a0 - before.acceleration).abs() + noise + before.noise) / mean_s;
            self.jerk = self.jerk.max(inside.max(step) * limits.jerk);
            *before = End {
                acceleration: a1,
                noise,
            };
        }
        self.duration_s = to.duration_s;
    }

    /// Takes the tool's motion from one parameter and speed to the next into account.
    pub(crate) fn add_tool(
        &mut self,
        tool: &ToolLimits,
        [[q0, q1], [v0, v1]]: [[f64; 2]; 2],
        duration_s: f64,
    ) {
        let tool_motion = Cubic {
            q0,
            q1,
            v0,
            v1,
            duration_s,
        };
        self.speed = self.speed.max(tool_motion.peak_speed() / tool.feed);
        if let Some(limit) = tool.acceleration {
            let [a0, a1] = tool_motion.accelerations().map(f64::abs);
            let hardest = a0.max(a1) + tool_motion.noise();
            self.acceleration = self.acceleration.max(hardest / limit);
        }
    }

    /// Takes the standstill after the last segment into account.
    pub(crate) fn stop(&mut self, limits: &Reciprocals<A>) {
        let mean_s = self.duration_s * 0.5;
        for (limits, before) in limits.axes().iter().zip(A::each(&self.before)) {
            let step = (before.acceleration.abs() + before.noise) / mean_s;
            self.jerk = self.jerk.max(step * limits.jerk);
        }
    }

    /// The state at the end of the last segment, with nothing asked for yet.
    pub(crate) fn fresh(&self) -> Self {
        Self {
            speed: 0.0,
            acceleration: 0.0,
            jerk: 0.0,
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Demand;
    use crate::reciprocals::Reciprocals;
    use crate::{AxisLimits, Row};

    const ROUNDING: f64 = 1e-12;

    /// 2 s of 1 mm/s² from rest, 1 s of -2 mm/s² to rest. No jerk inside; the steps are 1, 3 and
    /// 2 mm/s² over half of 2 s, half of 3 s, half of 1 s.
    #[test]
    fn steps_of_the_acceleration_are_jerks() {
        let limits = Reciprocals::new(&[AxisLimits {
            speed: 4.0,
            acceleration: 5.0,
            jerk: Some(8.0),
        }]);
        let row = |duration_s, position, velocity| Row {
            time_s: 0.0,
            duration_s,
            position: [position],
            velocity: [velocity],
        };
        let rows = [row(0.0, 0.0, 0.0), row(2.0, 2.0, 2.0), row(1.0, 3.0, 0.0)];
        let mut demand = Demand::<[f64; 1]>::at_rest();
        let mut jerks = [0.0; 3];
        for (jerk, pair) in jerks.iter_mut().zip(rows.windows(2)) {
            demand.add(&limits, &pair[0], &pair[1]);
            *jerk = demand.jerk;
        }
        demand.stop(&limits);
        jerks[2] = demand.jerk;
        let wanted = [1.0, 2.0, 4.0].map(|jerk| jerk / 8.0);
        let off = jerks
            .iter()
            .zip(wanted)
            .map(|(a, b): (&f64, f64)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < ROUNDING, "{jerks:?}");
        assert!((demand.speed - 2.0 / 4.0).abs() < ROUNDING);
        assert!((demand.acceleration - 2.0 / 5.0).abs() < ROUNDING);
        // The jerk dominates: 0.79 against 0.63 and 0.5.
        assert!((demand.stretch() - 0.5_f64.cbrt()).abs() < ROUNDING);
    }
}
