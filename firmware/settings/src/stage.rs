//! The stage: what to change for another one.

use board_machine::{Settings, Slide, StageGeometry, XyStage};
use pulse_interp::{Direction, HomingSettings, LoopSettings, ScaleRatio};
use pvt_steps::StepDirTiming;

/// Motors of 200 steps in halves, on screws of 4 mm a turn.
const STEPS_PER_MM: f64 = 200.0 * 2.0 / 4.0;

const HOMING: HomingSettings = HomingSettings {
    direction: Direction::Negative,
    max_steps: 15_000,
    clear_steps: 100,
};

/// Scales of 500 counts a mm.
const RATIO: ScaleRatio = match ScaleRatio::new(5, 1) {
    Ok(ratio) => ratio,
    Err(_) => panic!("counts of no step"),
};

const SLIDE: Slide = Slide {
    range_mm: [0.0, 120.0],
    steps_per_mm: STEPS_PER_MM,
    speed_mm_s: 50.0,
    acceleration_mm_s2: 500.0,
    home_mm: 0.0,
    homing: HOMING,
    // None without scales.
    scale: Some(LoopSettings {
        ratio: RATIO,
        dead_band_counts: 3,
        alarm_counts: 100,
    }),
};

/// How many motors it has.
pub const AXES: usize = 2;
/// Its kinematics.
pub type Kind = XyStage;

/// What it is, and how it moves.
pub static SETTINGS: Settings<Kind, AXES> = Settings {
    geometry: StageGeometry,
    // x and y.
    axes: [
        SLIDE,
        Slide {
            range_mm: [0.0, 100.0],
            ..SLIDE
        },
    ],
    driver: StepDirTiming::DRV8825,
    tolerance_mm: 0.01,
    homing_fast_hz: 800,
    homing_slow_hz: 100,
};
