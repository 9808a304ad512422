//! One axis under its edges: what they ask of its motor, and whether it follows.

use crate::{EdgeLog, Measured, Motor, Rotor};

/// An axis that gets edges: they are kept, and turn a simulated motor.
///
/// # Examples
/// ```
/// use machine_sim::{DrivenAxis, Motor, StepSize};
/// let motor = Motor {
///     holding_torque_nm: 0.4,
///     corner_speed_hz: 1000.0,
///     inertia_kg_m2: 1e-5,
///     friction_nm: 0.02,
///     damping_ratio: 0.02,
///     full_steps_per_turn: 200,
///     microsteps: 16,
/// };
/// let mut axis = DrivenAxis::new(motor);
/// for step in 1..=1000_u32 {
///     axis.step(f64::from(step) / 8000.0, 1);
/// }
/// // 200 full steps of 16 microsteps a turn.
/// let followed = axis.finish(0.0, StepSize::Degrees(360.0 / 3200.0));
/// assert_eq!(followed.lost_steps, 0);
/// assert!((followed.speed.value - 900.0).abs() < 1e-3);
/// ```
#[derive(Debug, Clone)]
pub struct DrivenAxis {
    edges: EdgeLog,
    rotor: Rotor,
}

impl DrivenAxis {
    /// An axis that stands.
    #[must_use]
    pub fn new(motor: Motor) -> Self {
        Self {
            edges: EdgeLog::new(),
            rotor: Rotor::new(motor),
        }
    }

    /// A step at a time in s, not before the last one: up for a number above 0, down for one below.
    pub fn step(&mut self, time_s: f64, direction: i32) {
        self.edges.step(time_s, direction);
        self.rotor.step(time_s, direction);
    }

    /// Its motor, with what it turns.
    pub const fn rotor_mut(&mut self) -> &mut Rotor {
        &mut self.rotor
    }

    /// What came of it when it has come to rest, with edges that are at most `deviation_steps` off
    /// the places that they stand for.
    #[must_use]
    pub fn finish(mut self, deviation_steps: f64, step: StepSize) -> Followed {
        self.rotor.settle();
        let (unit, size) = match step {
            StepSize::Degrees(deg) => (Unit::Degrees, deg),
            StepSize::Millimetres(mm) => (Unit::Millimetres, mm),
        };
        let motion = self.edges.motion(deviation_steps);
        Followed {
            unit,
            start_speed: motion.start_speed.times(size),
            speed: motion.speed.times(size),
            speed_jump: motion.speed_jump.times(size),
            acceleration: motion.acceleration.times(size),
            lost_steps: self.rotor.lost_steps(),
            max_lag_full_steps: self.rotor.max_lag_full_steps(),
        }
    }
}

/// What an axis moves by in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_enums, reason = "axes turn or slide")]
pub enum StepSize {
    /// In degrees.
    Degrees(f64),
    /// In mm.
    Millimetres(f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Unit {
    Degrees,
    Millimetres,
}

/// What edges ask of an axis, in its unit, and what its motor makes of them.
///
/// With `serde` the names of a map have the unit: `max_start_speed_deg_s` or `_mm_s`,
/// `max_speed_..`, `max_speed_jump_..`, `max_acceleration_deg_s2` or `_mm_s2`, `lost_steps`,
/// `max_lag_full_steps`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Followed {
    unit: Unit,
    /// The largest after a rest or a reversal, in units a second.
    pub start_speed: Measured,
    /// The largest, in units a second.
    pub speed: Measured,
    /// The largest from a few steps to the next few, in units a second.
    pub speed_jump: Measured,
    /// The largest, in units/s².
    pub acceleration: Measured,
    /// Steps that turned the field without the rotor.
    pub lost_steps: u64,
    /// The farthest that the rotor was from its place in the field; from 2 on it loses steps.
    pub max_lag_full_steps: f64,
}

#[cfg(feature = "serde")]
impl serde::Serialize for Followed {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeMap as _;

        let unit = match self.unit {
            Unit::Degrees => "deg",
            Unit::Millimetres => "mm",
        };
        let mut map = serializer.serialize_map(Some(6))?;
        for (name, measured) in [
            ("start_speed", self.start_speed),
            ("speed", self.speed),
            ("speed_jump", self.speed_jump),
        ] {
            map.serialize_entry(&format!("max_{name}_{unit}_s"), &measured)?;
        }
        map.serialize_entry(&format!("max_acceleration_{unit}_s2"), &self.acceleration)?;
        map.serialize_entry("lost_steps", &self.lost_steps)?;
        map.serialize_entry("max_lag_full_steps", &self.max_lag_full_steps)?;
        map.end()
    }
}
