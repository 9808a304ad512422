//! Settings from a file: what is refused by a constructor is refused there too.

use pulse_interp::{Direction, HomingSettings, LoopSettings, Move, Rule, ScaleRatio};
use test_support::{not_read, stored};

#[test]
fn settings_come_back() {
    let settings = LoopSettings {
        ratio: ScaleRatio::new(5, 1).unwrap(),
        dead_band_counts: 3,
        alarm_counts: 50,
    };
    let text = r#"{"ratio":[5,1],"dead_band_counts":3,"alarm_counts":50}"#;
    assert_eq!(stored(&settings), text);
    stored(&HomingSettings {
        direction: Direction::Negative,
        max_steps: 9,
        clear_steps: 2,
    });
    stored(&(Move::UpLeft, Rule::Nearest));
}

#[test]
fn wrong_settings_are_refused_with_their_reason() {
    let error = not_read::<ScaleRatio>("[5,0]");
    assert!(error.contains("5 counts per 0 steps"), "{error}");
}
