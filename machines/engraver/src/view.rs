//! What a page draws of machine and run.

use known_load::{TorqueUsed, Vibration};
use nalgebra::{Point2, Point3};
use pattern_codec::engraving::PerAxis;
use scara_kin::Joints;

use crate::machine::Machine;
use crate::simulation::Run;

impl Machine {
    /// Where the tool is at a position of the steppers, counted from home, in mm; its z is the
    /// height above the depth of engraving.
    #[must_use]
    pub fn tool(&self, position: PerAxis<i32>) -> Point3<f64> {
        let tool = self.arm.forward(self.joints(position));
        let above = i64::from(position.vertical) + i64::from(self.lift_pulses);
        #[expect(clippy::cast_precision_loss, reason = "two numbers of 32 bits")]
        let height = above as f64 * self.settings.mm_per_vertical_pulse();
        Point3::new(tool.x, tool.y, height)
    }
}

impl Machine {
    /// Where the tool is with shoulder, elbow and disc at angles in radians, in mm.
    #[must_use]
    pub fn tool_at(&self, [shoulder, elbow, _]: [f64; 3]) -> [f64; 3] {
        let tool = self.arm.forward(Joints::new(shoulder, elbow));
        [tool.x, tool.y, 0.0]
    }
}

impl Run {
    /// The placed drawing as lines, in mm.
    pub fn drawing(&self) -> impl ExactSizeIterator<Item = &[Point2<f64>]> {
        self.drawing.iter().map(Vec::as_slice)
    }

    /// What timed strokes ask of the motors, where the machine's load is known.
    #[must_use]
    pub const fn torque(&self) -> Option<&TorqueUsed<3>> {
        self.torque.as_ref()
    }

    /// How the tool swings in timed strokes, where its mode is known.
    #[must_use]
    pub const fn vibration(&self) -> Option<&Vibration> {
        self.vibration.as_ref()
    }

    /// How the tool swings in them without shaping.
    #[must_use]
    pub const fn unshaped(&self) -> Option<&Vibration> {
        self.unshaped.as_ref()
    }

    /// Seconds, and the largest distance of the tool from the drawing in the part of the time
    /// around them, in mm; none where the tool is lifted.
    pub fn deviation_over_time(&self) -> impl Iterator<Item = (f64, Option<f64>)> {
        #[expect(clippy::cast_precision_loss, reason = "2^53 ticks are centuries")]
        let seconds = |ticks: u64| ticks as f64 * self.tick_s;
        let parts = self.deviation.profile.parts();
        parts.map(move |(ticks, max)| (seconds(ticks), max))
    }
}
