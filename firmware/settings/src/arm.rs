//! The arm: what to change for another one.

use board_machine::{ArmGeometry, Joint, Settings, TwoLinkArm};
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

const JOINT: Joint = Joint {
    range_deg: [-90.0, 210.0],
    steps_per_turn: STEPS_PER_TURN,
    speed_deg_s: 180.0,
    acceleration_deg_s2: 1500.0,
    home_deg: -90.0,
    homing: HOMING,
};

/// How many motors it has.
pub const AXES: usize = 2;
/// Its kinematics.
pub type Kind = TwoLinkArm;

/// What it is, and how it moves.
pub static SETTINGS: Settings<Kind, AXES> = Settings {
    geometry: ArmGeometry {
        links_mm: [132.0, 132.0],
        elbow: Elbow::Right,
    },
    // Shoulder and elbow.
    axes: [
        JOINT,
        Joint {
            range_deg: [20.0, 160.0],
            home_deg: 20.0,
            ..JOINT
        },
    ],
    driver: StepDirTiming::DRV8825,
    tolerance_mm: 0.05,
    homing_fast_hz: 800,
    homing_slow_hz: 100,
};
