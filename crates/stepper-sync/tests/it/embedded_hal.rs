//! Pin drivers on pins that log what they do.

use embedded_hal::digital::{Error, ErrorKind, ErrorType, OutputPin, PinState};
use stepper_sync::{Direction, Level, Polarity, StepDir, StepDirError, StepDirTiming};
use test_support::{Board, Pin};

const TIMING: StepDirTiming = StepDirTiming {
    pulse_ns: 11,
    pause_ns: 22,
    setup_ns: 33,
    hold_ns: 44,
};

#[test]
fn pulses_keep_width_pause_setup_and_hold() {
    let mut board = Board::default();
    let mut motor = StepDir::new(board.pin("s"), board.pin("d"), TIMING);
    let mut steps = |steps: &[i32]| {
        for &step in steps {
            motor.step(Direction::of(step), &mut board).unwrap();
        }
        board.take()
    };
    assert_eq!(steps(&[0]), "");
    assert_eq!(steps(&[1, 1]), "d+ 33 s+ 11 s- 22 s+ 11 s- 22");
    assert_eq!(steps(&[0, -1]), "44 d- 33 s+ 11 s- 22");
}

#[test]
fn other_levels_and_single_edges() {
    let mut board = Board::default();
    let mut motor = StepDir::new(board.pin("s"), board.pin("d"), StepDirTiming::A4988)
        .with_polarity(Polarity::ActiveLow, Polarity::ActiveLow);
    motor
        .set_direction(Direction::Negative, &mut board)
        .unwrap();
    motor.set_level(Level::High).unwrap();
    motor.set_level(Level::Low).unwrap();
    assert_eq!(board.take(), "d+ 200 s- s+");
}

/// A pin whose bus has failed.
struct Broken;

#[derive(Debug, PartialEq)]
struct Gone;

impl Error for Gone {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

impl ErrorType for Broken {
    type Error = Gone;
}

impl OutputPin for Broken {
    fn set_low(&mut self) -> Result<(), Gone> {
        Err(Gone)
    }

    fn set_high(&mut self) -> Result<(), Gone> {
        Err(Gone)
    }
}

/// A pin that refuses its n-th settings.
struct Flaky {
    pin: Pin,
    refused: &'static [usize],
    settings: usize,
}

impl Flaky {
    fn new(pin: Pin, refused: &'static [usize]) -> Self {
        Self {
            pin,
            refused,
            settings: 0,
        }
    }

    fn set(&mut self, state: PinState) -> Result<(), Gone> {
        self.settings += 1;
        if self.refused.contains(&self.settings) {
            self.pin.log("x");
            return Err(Gone);
        }
        self.pin.set_state(state).map_err(|never| match never {})
    }
}

impl ErrorType for Flaky {
    type Error = Gone;
}

impl OutputPin for Flaky {
    fn set_low(&mut self) -> Result<(), Gone> {
        self.set(PinState::Low)
    }

    fn set_high(&mut self) -> Result<(), Gone> {
        self.set(PinState::High)
    }
}

#[test]
fn a_pulse_that_did_not_end_is_ended_before_the_next() {
    let mut board = Board::default();
    let step_pin = Flaky::new(board.pin("s"), &[2]);
    let mut motor = StepDir::new(step_pin, board.pin("d"), TIMING);
    let forward = Some(Direction::Positive);
    assert!(motor.step(forward, &mut board).is_err());
    assert_eq!(board.take(), "d+ 33 s+ 11 x");
    // Without the edge down there would be none up: a step less.
    motor.step(forward, &mut board).unwrap();
    assert_eq!(board.take(), "s- 22 s+ 11 s- 22");
    motor.step(forward, &mut board).unwrap();
    assert_eq!(board.take(), "s+ 11 s- 22");
}

#[test]
fn a_direction_that_was_not_set_does_not_forget_the_pulse_before() {
    let mut board = Board::default();
    let direction_pin = Flaky::new(board.pin("d"), &[2]);
    let mut motor = StepDir::new(board.pin("s"), direction_pin, TIMING);
    motor
        .set_direction(Direction::Positive, &mut board)
        .unwrap();
    assert!(
        motor
            .set_direction(Direction::Negative, &mut board)
            .is_err()
    );
    motor.set_level(Level::High).unwrap();
    motor.set_level(Level::Low).unwrap();
    board.take();
    motor
        .set_direction(Direction::Negative, &mut board)
        .unwrap();
    assert_eq!(board.take(), "44 d- 33");
}

#[test]
fn other_levels_are_set_even_where_the_direction_stays() {
    let mut board = Board::default();
    let mut motor = StepDir::new(board.pin("s"), board.pin("d"), TIMING);
    let forward = Some(Direction::Positive);
    motor.step(forward, &mut board).unwrap();
    let mut motor = motor.with_polarity(Polarity::ActiveHigh, Polarity::ActiveLow);
    board.take();
    motor.step(forward, &mut board).unwrap();
    assert_eq!(board.take(), "44 d- 33 s+ 11 s- 22");
}

#[test]
fn errors_name_the_pin() {
    let mut board = Board::default();
    let mut motor = StepDir::new(Broken, board.pin("d"), TIMING);
    let error = motor.step(Some(Direction::Positive), &mut board);
    assert_eq!(error, Err(StepDirError::Step(Gone)));
    assert_eq!(error.unwrap_err().to_string(), "step pin: Gone");
    let mut motor = StepDir::new(board.pin("s"), Broken, TIMING);
    let error = motor.step(Some(Direction::Positive), &mut board);
    assert_eq!(error, Err(StepDirError::Direction(Gone)));
    // Not taken for set.
    assert!(motor.step(Some(Direction::Positive), &mut board).is_err());
}
