//! One axis under its edges: what they ask of its motor, and whether it follows.

use crate::{EdgeLog, EdgeMotion, Motor, Rotor};

/// An axis that gets edges: they are kept, and turn a simulated motor.
///
/// # Examples
/// ```
/// use machine_sim::{DrivenAxis, Motor};
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
/// let followed = axis.finish(0.0);
/// assert_eq!(followed.lost_steps, 0);
/// assert!((followed.motion.speed.value - 8000.0).abs() < 1e-3);
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

    /// What came of it when it has come to rest, with edges that are at most `deviation_steps` off
    /// the places that they stand for.
    #[must_use]
    pub fn finish(mut self, deviation_steps: f64) -> Followed {
        self.rotor.settle();
        Followed {
            motion: self.edges.motion(deviation_steps),
            lost_steps: self.rotor.lost_steps(),
            max_lag_full_steps: self.rotor.max_lag_full_steps(),
        }
    }
}

/// What edges ask of a motor, and what it makes of them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Followed {
    /// By the edges alone, in steps.
    pub motion: EdgeMotion,
    /// Steps that turned the field without the rotor.
    pub lost_steps: u64,
    /// The farthest that the rotor was from its place in the field; from 2 on it loses steps.
    pub max_lag_full_steps: f64,
}
