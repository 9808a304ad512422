//! Winding pins that log what they do.

use alloc::rc::Rc;
use core::{cell::RefCell, convert::Infallible, fmt};
use std::collections::HashMap;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, OutputPin};
use motor_phases::{Phases, Polarity, Stepping, WindingPins, Wiring};

/// All pins and the clock of a test: `name+`, `name-`, and waits in nanoseconds.
#[derive(Clone, Default)]
struct Board(Rc<RefCell<Vec<String>>>);

impl Board {
    fn pin(&self, name: &'static str) -> Pin {
        let board = self.clone();
        Pin { name, board }
    }

    fn log(&self, entry: impl fmt::Display) {
        self.0.borrow_mut().push(entry.to_string());
    }

    fn take(&self) -> String {
        self.0.borrow_mut().split_off(0).join(" ")
    }
}

impl DelayNs for Board {
    fn delay_ns(&mut self, ns: u32) {
        self.log(ns);
    }
}

struct Pin {
    name: &'static str,
    board: Board,
}

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.board.log(format_args!("{}-", self.name));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.board.log(format_args!("{}+", self.name));
        Ok(())
    }
}

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
