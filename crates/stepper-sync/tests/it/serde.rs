//! Settings from a file: what is refused by a constructor is refused there too.

use stepper_sync::{
    CounterWidth, Edge, Placement, RampLimits, Rate, SpeedLaw, StepScale, Trains, Wiring,
};

#[test]
fn settings_come_back() {
    let limits = RampLimits {
        start_millihertz: 1,
        max_millihertz: 2,
        accel_steps_per_s2: 3,
    };
    let text = serde_json::to_string(&limits).unwrap();
    assert_eq!(serde_json::from_str::<RampLimits>(&text).unwrap(), limits);

    let rate = Rate::from_millihertz(112_800).unwrap();
    let text = serde_json::to_string(&rate).unwrap();
    assert_eq!(text, "[564,5]");
    assert_eq!(serde_json::from_str::<Rate>(&text).unwrap(), rate);

    let scale = StepScale::new(-17.5).unwrap();
    let text = serde_json::to_string(&scale).unwrap();
    assert_eq!(serde_json::from_str::<StepScale>(&text).unwrap(), scale);

    let text = serde_json::to_string(&CounterWidth::Bits24).unwrap();
    assert_eq!(
        serde_json::from_str::<CounterWidth>(&text).unwrap(),
        CounterWidth::Bits24
    );

    let text = r#"{"bits":[3,2,1,0],"placement":"doubled"}"#;
    let wiring = serde_json::from_str::<Wiring>(text).unwrap();
    let doubled = Wiring {
        placement: Placement::Doubled,
        ..Wiring::UNIPOLAR.reversed()
    };
    assert_eq!(wiring, doubled);
    let law = serde_json::from_str::<SpeedLaw>(r#""carry_signed""#).unwrap();
    assert_eq!(law, SpeedLaw::CarrySigned);

    let edges: Vec<Edge> = Trains::new([2, -1], 5).unwrap().edges().collect();
    let text = serde_json::to_string(&edges).unwrap();
    assert_eq!(serde_json::from_str::<Vec<Edge>>(&text).unwrap(), edges);
}

#[test]
fn wrong_settings_are_refused_with_their_reason() {
    let error = serde_json::from_str::<Rate>("[7,0]").unwrap_err();
    assert!(error.to_string().contains("a rate of 7/0 Hz"), "{error}");
    let error = serde_json::from_str::<StepScale>("0.0").unwrap_err();
    assert!(error.to_string().contains("0 steps per unit"), "{error}");
}
