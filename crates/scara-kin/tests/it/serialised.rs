//! Machine files: what is written is read back, what is wrong is refused.

use scara_kin::nalgebra::{Isometry2, Vector2};
use scara_kin::{Arm, Direction, Drives, Elbow, JointRange, Joints, Limits};

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
    let text = serde_json::to_string(&arm).unwrap();
    assert_eq!(serde_json::from_str::<Arm>(&text).unwrap(), arm);
    let plain: Arm = serde_json::from_str(r#"{"upper": 132.0, "fore": 132.0}"#).unwrap();
    assert_eq!(plain, Arm::new(132.0, 132.0).unwrap());
}

#[test]
fn drives_are_read_back() {
    let drives = Drives::default()
        .with_zero(Joints::new(0.1, 0.2))
        .unwrap()
        .with_directions(Direction::Reversed, Direction::Forward)
        .with_coupling(1.0)
        .unwrap();
    let text = serde_json::to_string(&drives).unwrap();
    assert_eq!(serde_json::from_str::<Drives>(&text).unwrap(), drives);
    assert_eq!(serde_json::to_string(&Elbow::Left).unwrap(), r#""left""#);
}

#[test]
fn wrong_values_are_refused_with_their_reason() {
    for (text, reason) in [
        (
            r#"{"upper": -1.0, "fore": 132.0}"#,
            "length -1 of the upper arm",
        ),
        (
            r#"{"upper": 1.0, "fore": 1.0, "keep_out": 2.0}"#,
            "keep-out radius 2",
        ),
        (
            r#"{"upper": 1.0, "fore": 1.0, "limits": {"elbow": {"min": 1.0, "max": 1.0}}}"#,
            "joint range 1..=1 rad is empty",
        ),
        (
            r#"{"upper": 1.0, "fore": 1.0, "length": 2.0}"#,
            "unknown field `length`",
        ),
    ] {
        let error = serde_json::from_str::<Arm>(text).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
}
