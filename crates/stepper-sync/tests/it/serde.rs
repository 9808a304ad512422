//! Settings from a file: what is refused by a constructor is refused there too.

use stepper_sync::{
    CounterWidth, Edge, Placement, RampLimits, Rate, SpeedLaw, StepScale, Trains, Wiring,
};
use test_support::{not_read, stored};

#[test]
fn settings_come_back() {
    stored(&RampLimits {
        start_millihertz: 1,
        max_millihertz: 2,
        accel_steps_per_s2: 3,
    });
    let rate = Rate::from_millihertz(112_800).unwrap();
    assert_eq!(stored(&rate), "[564,5]");
    stored(&StepScale::new(-17.5).unwrap());
    stored(&CounterWidth::Bits24);

    let text = r#"{"bits":[3,2,1,0],"placement":"doubled"}"#;
    let wiring = serde_json::from_str::<Wiring>(text).unwrap();
    let doubled = Wiring {
        placement: Placement::Doubled,
        ..Wiring::UNIPOLAR.reversed()
    };
    assert_eq!(wiring, doubled);
    assert_eq!(stored(&SpeedLaw::CarrySigned), r#""carry_signed""#);
    let edges: Vec<Edge> = Trains::new([2, -1], 5).unwrap().edges().collect();
    stored(&edges);
}

#[test]
fn wrong_settings_are_refused_with_their_reason() {
    let error = not_read::<Rate>("[7,0]");
    assert!(error.contains("a rate of 7/0 Hz"), "{error}");
    let error = not_read::<StepScale>("0.0");
    assert!(error.contains("0 steps per unit"), "{error}");
}
