//! Machine files: what is written is read back, what is wrong is refused.

use delta_kin::{
    Arm, AssemblyMode, Delta, Elbow, JointRange, Measured, Parameter, Positive, Quantity, ZAxis,
};

#[test]
fn a_machine_is_read_back() {
    let mut arms = *Delta::new(42.0, 18.0, 120.0, 243.0).unwrap().arms();
    arms[1].lower += 0.5;
    let delta = Delta::from_arms(arms)
        .unwrap()
        .with_z(ZAxis::Down)
        .with_positive(Positive::Inward)
        .with_ranges([
            JointRange::unlimited(),
            JointRange::new(-1.0, 2.0).unwrap(),
            JointRange::unlimited(),
        ])
        .with_ball_joints(0.6)
        .unwrap()
        .with_working_mode([Elbow::Out, Elbow::In, Elbow::Out])
        .with_assembly_mode(AssemblyMode::Upper);
    let text = serde_json::to_string(&delta).unwrap();
    assert_eq!(serde_json::from_str::<Delta>(&text).unwrap(), delta);
    let parameter = Parameter::of(Quantity::Zero, Arm::Second);
    let text = serde_json::to_string(&parameter).unwrap();
    assert_eq!(text, r#"{"quantity":"zero","arm":"second"}"#);
    let text = r#"{"angles":[1.0,2.0,3.0],"point":[4.0,5.0,6.0]}"#;
    let measured: Measured = serde_json::from_str(text).unwrap();
    assert_eq!(serde_json::to_string(&measured).unwrap(), text);
}

#[test]
fn wrong_values_are_refused_with_their_reason() {
    let at = |azimuth: u8| {
        format!(
            r#"{{"azimuth":{azimuth},"base":42,"platform":18,"upper":120,"lower":243,"zero":0}}"#
        )
    };
    let (one, two, arm) = (&at(0), &at(2), &at(4));
    let text = |last: &str, more: &str| format!(r#"{{"arms":[{one},{two},{last}]{more}}}"#);
    assert!(serde_json::from_str::<Delta>(&text(arm, "")).is_ok());
    for (text, reason) in [
        (
            text(&arm.replace("243", "-1"), ""),
            "arm 3: lower arm -1 is not within",
        ),
        (
            text(arm, r#","max_swivel":2.0"#),
            "ball joints may swivel by 2 rad",
        ),
        (
            text(arm, r#","ranges":[null,null,{"min":1,"max":1}]"#),
            "joint range 1..=1 rad",
        ),
        (text(arm, r#","reach":2.0"#), "unknown field `reach`"),
        (
            text(arm, r#","assembly_mode":"middle""#),
            "unknown variant `middle`",
        ),
    ] {
        let error = serde_json::from_str::<Delta>(&text)
            .unwrap_err()
            .to_string();
        assert!(error.contains(reason), "{error}");
    }
}
