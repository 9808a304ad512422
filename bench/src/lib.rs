//! The machines that the benches compare, ours and those of the best published crate, and the
//! places that they are asked for.

#[path = "../../crates/scara-kin/benches/inverse/points.rs"]
mod arm_points;
#[path = "../../crates/delta-kin/benches/kinematics/points.rs"]
mod delta_points;

use delta_kin::{Delta, Dimensions, nalgebra::Point3};
use oxictl::kinematics::serial::delta::{DeltaConfig, DeltaRobot};
use oxictl::kinematics::serial::scara::{ScaraConfig, ScaraRobot};
use scara_kin::{Arm, nalgebra::Point2};

use arm_points::LINK;

/// How many [`arm_points`] there are.
pub const ARM_POINTS: u32 = arm_points::POINTS;
/// How many [`delta_points`] there are.
pub const DELTA_POINTS: u32 = delta_points::POINTS;

/// Radius of the motors' axes, radius of the platform, upper and lower arm, in millimetres.
const DELTA: [f64; 4] = [42.0, 18.0, 120.0, 243.0];

/// Two links of equal length.
pub fn arm() -> Arm {
    Arm::new(LINK, LINK).expect("lengths are good")
}

/// The same arm of `oxictl`.
pub fn peer_arm() -> ScaraRobot<f64> {
    ScaraRobot::new(ScaraConfig {
        a1: LINK,
        a2: LINK,
        ..ScaraConfig::desktop()
    })
}

/// Points over the whole workspace.
pub fn arm_points() -> Vec<Point2<f64>> {
    arm_points::points()
}

/// A table-top Delta.
pub fn delta() -> Delta {
    let [base, platform, upper, lower] = DELTA;
    Delta::new(Dimensions {
        base,
        platform,
        upper,
        lower,
    })
    .expect("lengths are good")
}

/// The same Delta of `oxictl`.
pub fn peer_delta() -> DeltaRobot<f64> {
    let [r_f, r_e, l1, l2] = DELTA;
    DeltaRobot::new(DeltaConfig {
        r_f,
        r_e,
        l1,
        l2,
        theta_min: -7.0,
        theta_max: 7.0,
    })
}

/// Points in a cylinder of its workspace.
pub fn delta_points() -> Vec<Point3<f64>> {
    delta_points::points()
}
