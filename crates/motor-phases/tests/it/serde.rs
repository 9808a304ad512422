//! Settings from a file.

use motor_phases::{Placement, SpeedLaw, Wiring};
use test_support::stored;

#[test]
fn settings_come_back() {
    let text = r#"{"bits":[3,2,1,0],"placement":"doubled"}"#;
    let wiring = serde_json::from_str::<Wiring>(text).unwrap();
    let doubled = Wiring {
        placement: Placement::Doubled,
        ..Wiring::UNIPOLAR.reversed()
    };
    assert_eq!(wiring, doubled);
    assert_eq!(stored(&SpeedLaw::CarrySigned), r#""carry_signed""#);
}
