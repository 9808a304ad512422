use alloc::vec;
use alloc::vec::Vec;

use super::super::{Law, Motor, Turn, TurnError};
use super::{Action, Move, Performer, Score, ScoreError, ScoreErrorKind, ScorePart, approximate};

/// A score as frames.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Choreography<const N: usize> {
    /// The speeds of the motors, frame by frame.
    pub frames: Vec<[i8; N]>,
    /// Where turns end.
    pub landings: Vec<Landing>,
    /// Where the motors end, in half steps.
    pub end: [i64; N],
}

/// The end of a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Landing {
    /// The move, from 1.
    pub number: u32,
    /// Index of the motor.
    pub motor: usize,
    /// Frames from the start of the dance to the end of the turn.
    pub frame: u32,
    /// What was asked, in half steps from the start of the dance.
    pub asked_half_steps: f64,
    /// Where the motor is.
    pub half_steps: i64,
}

impl Landing {
    /// Where the motor is against what was asked, in half steps.
    #[must_use]
    pub fn error_half_steps(&self) -> f64 {
        approximate(self.half_steps) - self.asked_half_steps
    }
}

impl Score {
    /// The frames that make the moves under a law of the firmware.
    ///
    /// # Errors
    /// [`ScoreErrorKind::TooManyMotors`], and for a move [`ScoreErrorKind::TooFar`] or
    /// [`ScoreErrorKind::Turn`] when the motor cannot make it in its time, or not within one half
    /// step.
    pub fn compile<const N: usize>(&self, law: Law) -> Result<Choreography<N>, ScoreError> {
        if self.motors.len() > N {
            return Err(ScoreError {
                line: 1,
                part: ScorePart::Head,
                kind: ScoreErrorKind::TooManyMotors {
                    motors: self.motors.len(),
                    most: N,
                },
            });
        }
        let mut dance = Choreography {
            frames: vec![[0; N]; usize::try_from(self.frames).unwrap_or(usize::MAX)],
            landings: Vec::new(),
            end: [0; N],
        };
        for (index, performer) in self.motors.iter().enumerate() {
            let moves = self.moves.iter().filter(|one| one.motor == index);
            let motor = self.perform(law, performer, moves, &mut dance)?;
            if let Some(end) = dance.end.get_mut(index) {
                *end = motor.position();
            }
        }
        dance.landings.sort_by_key(|landing| landing.frame);
        Ok(dance)
    }

    /// The moves of one motor.
    fn perform<'a, const N: usize>(
        &self,
        law: Law,
        performer: &Performer,
        moves: impl Iterator<Item = &'a Move>,
        dance: &mut Choreography<N>,
    ) -> Result<Motor, ScoreError> {
        let motor = Motor::new(law, self.threshold, self.timing).map_err(|error| ScoreError {
            line: 1,
            part: ScorePart::Head,
            kind: error.into(),
        })?;
        let mut motor = motor.with_max_speed(performer.max_speed);
        // In half steps, before rounding.
        let mut asked = 0.0;
        for one in moves {
            let start = usize::try_from(one.start).unwrap_or(usize::MAX);
            let frames = dance.frames.iter_mut().skip(start);
            let bytes = frames.filter_map(|frame| frame.get_mut(one.motor));
            let at = |kind| ScoreError {
                line: one.line,
                part: ScorePart::Move(one.number),
                kind,
            };
            match one.action {
                Action::Speed(highest) => {
                    let speeds = one.easing.speeds(highest, one.frames);
                    play(&mut motor, speeds, bytes);
                    asked = approximate(motor.position());
                    continue;
                }
                Action::ToDeg(deg) => asked = deg / performer.half_step_deg,
                Action::TurnDeg(deg) => asked += deg / performer.half_step_deg,
            }
            let turn = turn(&motor, performer, asked, one).map_err(at)?;
            play(&mut motor, turn, bytes);
            dance.landings.push(Landing {
                number: one.number,
                motor: one.motor,
                frame: one.end(),
                asked_half_steps: asked,
                half_steps: motor.position(),
            });
        }
        Ok(motor)
    }
}

/// Writes speeds into the bytes of frames and moves the motor.
fn play<'a>(
    motor: &mut Motor,
    speeds: impl Iterator<Item = i8>,
    bytes: impl Iterator<Item = &'a mut i8>,
) {
    for (speed, byte) in speeds.zip(bytes) {
        motor.run(speed);
        *byte = speed;
    }
}

/// The turn that ends within one half step of what was asked.
fn turn(
    motor: &Motor,
    performer: &Performer,
    asked: f64,
    one: &Move,
) -> Result<Turn, ScoreErrorKind> {
    let nearest = asked.round();
    let way = nearest - approximate(motor.position());
    if way.abs() > f64::from(i32::MAX) {
        return Err(ScoreErrorKind::TooFar { half_steps: way });
    }
    #[expect(clippy::cast_possible_truncation, reason = "whole and within i32")]
    let way = way as i32;
    let try_way = |way: i32| {
        let turn = motor.turn(way, one.frames, one.easing)?;
        let nearest = motor.end(&turn);
        if (approximate(motor.position().saturating_add(nearest)) - asked).abs() <= 1.0 {
            return Ok(turn);
        }
        Err(TurnError::Unreachable {
            half_steps: way,
            frames: one.frames,
            nearest,
        })
    };
    // One half step beside the nearest may be more than one beside what was asked: then the whole
    // number on the other side of that is tried, too.
    let other = way.saturating_add(if asked < nearest { -1 } else { 1 });
    let turn = try_way(way).or_else(|refusal| try_way(other).map_err(|_| refusal));
    turn.map_err(|error| ScoreErrorKind::Turn {
        motor: performer.name.clone(),
        error,
    })
}
