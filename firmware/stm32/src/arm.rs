//! The arm: what to change for another one.

use board_machine::Settings;
use pulse_interp::{Direction, HomingSettings};
use pvt_steps::StepDirTiming;
use scara_kin::Elbow;

/// Motors of 200 steps in sixteenths, behind belts of 1 : 5.
const STEPS_PER_TURN: f64 = 200.0 * 16.0 * 5.0;

const HOMING: HomingSettings = HomingSettings {
    direction: Direction::Negative,
    max_steps: STEPS_PER_TURN as u32,
    clear_steps: 100,
};

pub static SETTINGS: Settings = Settings {
    links_mm: [132.0, 132.0],
    elbow: Elbow::Right,
    ranges_deg: [[-90.0, 210.0], [20.0, 160.0]],
    steps_per_turn: [STEPS_PER_TURN; 2],
    driver: StepDirTiming::DRV8825,
    speed_deg_s: [180.0; 2],
    acceleration_deg_s2: [1500.0; 2],
    tolerance_mm: 0.05,
    home_deg: [-90.0, 20.0],
    homing: [HOMING; 2],
    homing_fast_hz: 800,
    homing_slow_hz: 100,
};
