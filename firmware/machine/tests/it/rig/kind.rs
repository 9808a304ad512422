//! The machines that are tested, and what is known of them without their firmware.

use std::f64::consts::TAU;

use board_machine::{Kinematics, RotaryDelta, Settings, TwoLinkArm, XyStage};
use board_settings::{arm, delta, stage};
use delta_kin::{Delta, Dimensions};

use super::{ACCELERATION_DEG_S2, HOME_STEPS, STEPS_PER_TURN, forward};

/// A machine, and what is known of it.
pub struct Kind<K: Kinematics<N> + 'static, const N: usize> {
    pub settings: &'static Settings<K, N>,
    /// Where the switches close.
    pub home_steps: [i32; N],
    /// Where the tool is, in mm.
    pub tool: fn([i32; N]) -> [f64; N],
    /// What each axis may be accelerated by.
    pub acceleration_steps_s2: f64,
    /// Each axis is within half a step of the path, and the tolerance of the settings on top.
    pub tolerance_mm: f64,
}

impl<K: Kinematics<N>, const N: usize> Clone for Kind<K, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<K: Kinematics<N>, const N: usize> Copy for Kind<K, N> {}

/// Half a step of both joints, with both links in a row.
pub const ARM: Kind<TwoLinkArm, 2> = Kind {
    settings: &arm::SETTINGS,
    home_steps: HOME_STEPS,
    tool: |steps| forward(steps.map(|steps| f64::from(steps) / STEPS_PER_TURN * TAU)),
    acceleration_steps_s2: ACCELERATION_DEG_S2 / 360.0 * STEPS_PER_TURN,
    tolerance_mm: 0.05 + 0.75 * 264.0 * TAU / STEPS_PER_TURN,
};

/// The platform goes three times as far as an elbow at most, where the machine is tested.
pub const DELTA: Kind<RotaryDelta, 3> = Kind {
    settings: &delta::SETTINGS,
    home_steps: [4000; 3],
    tool: |steps| {
        let delta = Delta::new(Dimensions {
            base: 42.0,
            platform: 18.0,
            upper: 120.0,
            lower: 243.0,
        });
        let angles = steps.map(|steps| f64::from(steps) / STEPS_PER_TURN * TAU);
        delta.unwrap().forward(angles).unwrap().coords.into()
    },
    acceleration_steps_s2: ACCELERATION_DEG_S2 / 360.0 * STEPS_PER_TURN,
    tolerance_mm: 0.05 + 0.5 * 3.0 * 120.0 * TAU / STEPS_PER_TURN,
};

/// Half a step of both axes.
pub const STAGE: Kind<XyStage, 2> = Kind {
    settings: &stage::SETTINGS,
    home_steps: [0; 2],
    tool: |steps| steps.map(|steps| f64::from(steps) / 100.0),
    acceleration_steps_s2: 500.0 * 100.0,
    tolerance_mm: 0.01 + 0.5 * 1.42 / 100.0,
};
