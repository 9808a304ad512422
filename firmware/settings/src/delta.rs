//! The Delta: what to change for another one.

use board_machine::{DeltaGeometry, Joint, RotaryDelta, Settings};
use pulse_interp::{Direction, HomingSettings};
use pvt_steps::StepDirTiming;

/// Motors of 200 steps in sixteenths, behind belts of 1 : 5.
const STEPS_PER_TURN: f64 = 200.0 * 16.0 * 5.0;

/// An arm. Straight down is 0, growing outward and up; its switch closes where it is horizontal.
const ARM: Joint = Joint {
    range_deg: [-20.0, 120.0],
    steps_per_turn: STEPS_PER_TURN,
    speed_deg_s: 180.0,
    acceleration_deg_s2: 1500.0,
    home_deg: 90.0,
    homing: HomingSettings {
        direction: Direction::Positive,
        max_steps: STEPS_PER_TURN as u32 / 2,
        clear_steps: 100,
    },
};

/// How many motors it has.
pub const AXES: usize = 3;
/// Its kinematics.
pub type Kind = RotaryDelta;

/// What it is, and how it moves.
pub static SETTINGS: Settings<Kind, AXES> = Settings {
    geometry: DeltaGeometry {
        base_mm: 42.0,
        platform_mm: 18.0,
        upper_mm: 120.0,
        lower_mm: 243.0,
        max_swivel_deg: 40.0,
    },
    axes: [ARM; 3],
    driver: StepDirTiming::DRV8825,
    tolerance_mm: 0.05,
    homing_fast_hz: 800,
    homing_slow_hz: 100,
};
