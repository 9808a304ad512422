//! What a person sets for an axis that turns, and for one that slides.

use core::f64::consts::TAU;

use pulse_interp::{HomingSettings, LoopSettings};

/// What a value of an axis is shown in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Degrees of what is computed in radians.
    Degrees,
    /// Mm.
    Mm,
}

impl Unit {
    /// From radians or mm.
    pub(crate) fn shown(self, value: f64) -> f64 {
        match self {
            Self::Degrees => value.to_degrees(),
            Self::Mm => value,
        }
    }

    /// To radians or mm.
    pub(crate) fn computed(self, value: f64) -> f64 {
        match self {
            Self::Degrees => value.to_radians(),
            Self::Mm => value,
        }
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Degrees => "degrees",
            Self::Mm => "mm",
        }
    }

    /// A number of them.
    pub(crate) const fn number(self) -> &'static str {
        match self {
            Self::Degrees => "number of degrees",
            Self::Mm => "number of mm",
        }
    }
}

/// Settings of an axis, each in the unit in which it is shown.
pub trait Axis: Copy {
    /// Which.
    const UNIT: Unit;

    /// What the axis may take.
    fn range(&self) -> [f64; 2];
    /// Largest speed, a second.
    fn speed(&self) -> f64;
    /// Largest acceleration, a second².
    fn acceleration(&self) -> f64;
    /// Where the axis is when its home switch has just closed.
    fn home(&self) -> f64;
    /// How it finds its switch.
    fn homing(&self) -> HomingSettings;
    /// The closed loop on its scale, on boards that count one.
    fn scale(&self) -> Option<LoopSettings> {
        None
    }
    /// Steps of a radian or mm.
    fn steps_per_unit(&self) -> f64;
    /// Steps a second at the largest speed.
    fn steps_s(&self) -> f64;
}

/// A joint that a motor turns.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// Angles that it may take, in degrees.
    pub range_deg: [f64; 2],
    /// Steps of a turn; negative for a motor that turns the other way.
    pub steps_per_turn: f64,
    /// Largest speed, in degrees/s.
    pub speed_deg_s: f64,
    /// Largest acceleration, in degrees/s².
    pub acceleration_deg_s2: f64,
    /// Where it is when its home switch has just closed, in degrees.
    pub home_deg: f64,
    /// How it finds its switch. The direction is that of positive steps.
    pub homing: HomingSettings,
}

impl Axis for Joint {
    const UNIT: Unit = Unit::Degrees;

    fn range(&self) -> [f64; 2] {
        self.range_deg
    }

    fn speed(&self) -> f64 {
        self.speed_deg_s
    }

    fn acceleration(&self) -> f64 {
        self.acceleration_deg_s2
    }

    fn home(&self) -> f64 {
        self.home_deg
    }

    fn homing(&self) -> HomingSettings {
        self.homing
    }

    fn steps_per_unit(&self) -> f64 {
        self.steps_per_turn / TAU
    }

    fn steps_s(&self) -> f64 {
        (self.speed_deg_s / 360.0 * self.steps_per_turn).abs()
    }
}

/// A slide that a motor drives by a screw or a belt.
#[derive(Clone, Copy, Debug)]
pub struct Slide {
    /// Where it may be, in mm.
    pub range_mm: [f64; 2],
    /// Steps of a mm; negative for a motor that turns the other way.
    pub steps_per_mm: f64,
    /// Largest speed, in mm/s.
    pub speed_mm_s: f64,
    /// Largest acceleration, in mm/s².
    pub acceleration_mm_s2: f64,
    /// Where it is when its home switch has just closed, in mm.
    pub home_mm: f64,
    /// How it finds its switch. The direction is that of positive steps.
    pub homing: HomingSettings,
    /// The closed loop on its scale, which counts up with positive steps; used on boards that count it.
    pub scale: Option<LoopSettings>,
}

impl Axis for Slide {
    const UNIT: Unit = Unit::Mm;

    fn range(&self) -> [f64; 2] {
        self.range_mm
    }

    fn speed(&self) -> f64 {
        self.speed_mm_s
    }

    fn acceleration(&self) -> f64 {
        self.acceleration_mm_s2
    }

    fn home(&self) -> f64 {
        self.home_mm
    }

    fn homing(&self) -> HomingSettings {
        self.homing
    }

    fn scale(&self) -> Option<LoopSettings> {
        self.scale
    }

    fn steps_per_unit(&self) -> f64 {
        self.steps_per_mm
    }

    fn steps_s(&self) -> f64 {
        (self.speed_mm_s * self.steps_per_mm).abs()
    }
}
