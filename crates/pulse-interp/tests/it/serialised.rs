//! Settings from a file: what is refused by a constructor is refused there too.

use pulse_interp::{Direction, HomingSettings, LoopSettings, Move, Rule, ScaleRatio};

#[test]
fn settings_come_back() {
    let settings = LoopSettings {
        ratio: ScaleRatio::new(5, 1).unwrap(),
        dead_band_counts: 3,
        alarm_counts: 50,
    };
    let text = serde_json::to_string(&settings).unwrap();
    assert_eq!(
        text,
        r#"{"ratio":[5,1],"dead_band_counts":3,"alarm_counts":50}"#
    );
    assert_eq!(
        serde_json::from_str::<LoopSettings>(&text).unwrap(),
        settings
    );

    let homing = HomingSettings {
        direction: Direction::Negative,
        most_steps: 9,
        clear_steps: 2,
    };
    let text = serde_json::to_string(&homing).unwrap();
    assert_eq!(
        serde_json::from_str::<HomingSettings>(&text).unwrap(),
        homing
    );

    let text = serde_json::to_string(&(Move::UpLeft, Rule::Nearest)).unwrap();
    let back: (Move, Rule) = serde_json::from_str(&text).unwrap();
    assert_eq!(back, (Move::UpLeft, Rule::Nearest));
}

#[test]
fn wrong_settings_are_refused_with_their_reason() {
    let error = serde_json::from_str::<ScaleRatio>("[5,0]").unwrap_err();
    assert!(
        error.to_string().contains("5 counts per 0 steps"),
        "{error}"
    );
}
