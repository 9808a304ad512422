//! Machine files: what is written is read back, what is wrong is refused.

use scara_kin::nalgebra::{Isometry2, Vector2};
use scara_kin::{Arm, DriveSense, Drives, Elbow, JointRange, Joints, Limits};
use test_support::{not_read, stored};

use crate::common::engraver;

#[test]
fn an_arm_is_read_back() {
    let arm = Arm::new(132.0, 100.0)
        .unwrap()
        .with_base(Isometry2::new(Vector2::new(1.0, 2.0), 0.5))
        .unwrap()
        .with_limits(Limits {
            shoulder: JointRange::new(-1.0, 2.0).unwrap(),
            elbow: JointRange::unlimited(),
        })
        .with_keep_out(40.0)
        .unwrap();
    stored(&arm);
    let plain: Arm = serde_json::from_str(r#"{"upper": 132.0, "fore": 132.0}"#).unwrap();
    assert_eq!(plain, engraver());
}

#[test]
fn drives_are_read_back() {
    let drives = Drives::default()
        .with_zero(Joints::new(0.1, 0.2))
        .unwrap()
        .with_senses(DriveSense::Reversed, DriveSense::Forward)
        .with_coupling(1.0)
        .and_then(|drives| drives.with_ratios([0.5, 2.0]))
        .unwrap();
    stored(&drives);
    assert_eq!(stored(&Elbow::Left), r#""left""#);
}

#[test]
fn wrong_values_are_refused_with_their_reason() {
    for (upper, more, reason) in [
        (-1.0, "", "length -1 of the upper arm"),
        (1.0, r#", "keep_out": 2.0"#, "keep-out radius 2"),
        (
            1.0,
            r#", "limits": {"elbow": {"min": 1.0, "max": 1.0}}"#,
            "joint range 1..=1 rad is empty",
        ),
        (1.0, r#", "length": 2.0"#, "unknown field `length`"),
    ] {
        let error = not_read::<Arm>(&format!(r#"{{"upper": {upper}, "fore": 1.0{more}}}"#));
        assert!(error.contains(reason), "{error}");
    }
}
