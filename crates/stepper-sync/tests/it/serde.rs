//! Settings from a file: what is refused by a constructor is refused there too.

use stepper_sync::{CounterWidth, Edge, Rate, StepScale, Trains};
use test_support::{not_read, stored};

#[test]
fn settings_come_back() {
    let rate = Rate::from_millihertz(112_800).unwrap();
    assert_eq!(stored(&rate), "[564,5]");
    stored(&StepScale::new(-17.5).unwrap());
    stored(&CounterWidth::Bits24);
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
