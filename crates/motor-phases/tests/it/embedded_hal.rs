//! Winding pins that log what they do.

use std::collections::HashMap;

use motor_phases::{Phases, Polarity, Stepping, WindingPins, Wiring};
use test_support::Board;

#[test]
fn windings_go_off_before_others_go_on() {
    let mut board = Board::default();
    let phases = Phases::new(Stepping::Full, Wiring::BIPOLAR).unwrap();
    let pins = ["A+", "A-", "B+", "B-"].map(|name| board.pin(name));
    let mut motor = WindingPins::new(pins, phases, 7);
    motor.hold(&mut board).unwrap();
    assert_eq!(board.take(), "A-- B-- 7 A++ B++");
    motor.step(1, &mut board).unwrap();
    assert_eq!(board.take(), "A+- 7 A-+ B++");
    motor.step(-1, &mut board).unwrap();
    assert_eq!(board.take(), "A-- 7 A++ B++");
    motor.release().unwrap();
    assert_eq!(board.take(), "A+- A-- B+- B--");
    assert_eq!(motor.phase(), phases.start());
    // The dead time runs from the release: the next phase may be the other half of a bridge.
    motor.step(0, &mut board).unwrap();
    assert_eq!(board.take(), "7 A++ B++");
    motor.step(0, &mut board).unwrap();
    assert_eq!(board.take(), "A++ B++");
}

#[test]
fn windings_follow_the_nibble_whatever_the_wiring() {
    let mut board = Board::default();
    let wiring = Wiring {
        polarity: Polarity::ActiveLow,
        ..Wiring::UNIPOLAR.reversed()
    };
    let phases = Phases::new(Stepping::Half, wiring).unwrap();
    let names = ["0", "1", "2", "3"];
    let mut motor = WindingPins::new(names.map(|name| board.pin(name)), phases, 0);
    let mut levels = HashMap::new();
    for step in [0, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1_i8] {
        motor.step(step, &mut board).unwrap();
        for entry in board.take().split(' ').filter(|entry| entry.len() > 1) {
            levels.insert(entry[..1].to_owned(), entry.ends_with('+'));
        }
        for (bit, name) in names.iter().enumerate() {
            let expected = phases.nibble(motor.phase()) >> bit & 1 == 1;
            assert_eq!(levels[*name], expected);
        }
    }
}
