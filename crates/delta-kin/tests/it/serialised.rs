//! Machine files: what is written is read back, what is wrong is refused.

use delta_kin::{
    Arm, ArmRange, AssemblyMode, Delta, ElbowSide, Measured, Parameter, Positive, Quantity, ZAxis,
};
use test_support::{not_read, stored};

use crate::common::thesis::thesis;

#[test]
fn a_machine_is_read_back() {
    let mut arms = *thesis().arms();
    arms[1].lower += 0.5;
    let delta = Delta::from_arms(arms)
        .unwrap()
        .with_z(ZAxis::Down)
        .with_positive(Positive::Inward)
        .with_ranges([
            ArmRange::unlimited(),
            ArmRange::new(-1.0, 2.0).unwrap(),
            ArmRange::unlimited(),
        ])
        .with_ball_joints(0.6)
        .unwrap()
        .with_working_mode([ElbowSide::Out, ElbowSide::In, ElbowSide::Out])
        .with_assembly_mode(AssemblyMode::Upper);
    stored(&delta);
    let parameter = stored(&Parameter::of(Quantity::Zero, Arm::Second));
    assert_eq!(parameter, r#"{"quantity":"zero","arm":"second"}"#);
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
    for (last, more, reason) in [
        (
            &arm.replace("243", "-1"),
            "",
            "arm 3: lower arm -1 is not within",
        ),
        (
            arm,
            r#","max_swivel":2.0"#,
            "ball joints may swivel by 2 rad",
        ),
        (
            arm,
            r#","ranges":[null,null,{"min":1,"max":1}]"#,
            "arm range 1..=1 rad",
        ),
        (arm, r#","reach":2.0"#, "unknown field `reach`"),
        (
            arm,
            r#","assembly_mode":"middle""#,
            "unknown variant `middle`",
        ),
    ] {
        let error = not_read::<Delta>(&text(last, more));
        assert!(error.contains(reason), "{error}");
    }
}
