//! A score as frames.

use super::{Action, Move, Performer, Score, ScoreError, ScoreErrorKind, ScorePart, approximate};
use crate::law::Law;
use crate::motor::Motor;
use crate::turn::TurnError;

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
                    max: N,
                },
            });
        }
        let mut dance = Choreography {
            frames: vec![[0; N]; usize::try_from(self.frames).unwrap_or(usize::MAX)],
            landings: Vec::new(),
            end: [0; N],
        };
        let motor = Motor::new(law, self.threshold, self.timing);
        let motors = self.motors.iter();
        let mut dancers: Vec<_> = motors
            .map(|performer| Dancer::new(motor, performer))
            .collect();
        for one in &self.moves {
            let Some(dancer) = dancers.get_mut(one.motor) else {
                continue;
            };
            dancer.perform(one, &mut dance).map_err(|kind| ScoreError {
                line: one.line,
                part: ScorePart::Move(one.number),
                kind,
            })?;
        }
        for (end, dancer) in dance.end.iter_mut().zip(&dancers) {
            *end = dancer.motor.position();
        }
        dance
            .landings
            .sort_by_key(|landing| (landing.frame, landing.motor));
        Ok(dance)
    }
}

/// A motor while the score is compiled.
struct Dancer<'s> {
    performer: &'s Performer,
    motor: Motor,
    /// Where it is asked to be, in half steps before rounding.
    asked: f64,
}

impl<'s> Dancer<'s> {
    fn new(motor: Motor, performer: &'s Performer) -> Self {
        Self {
            performer,
            motor: motor.with_max_speed(performer.max_speed),
            asked: 0.0,
        }
    }

    /// One move, the next of this motor.
    fn perform<const N: usize>(
        &mut self,
        one: &Move,
        dance: &mut Choreography<N>,
    ) -> Result<(), ScoreErrorKind> {
        let start = usize::try_from(one.start).unwrap_or(usize::MAX);
        let frames = dance.frames.iter_mut().skip(start);
        let bytes = frames.filter_map(|frame| frame.get_mut(one.motor));
        let half_step_deg = self.performer.half_step_deg;
        match one.action {
            Action::Speed(highest) => {
                let speeds = one.easing.speeds(highest, one.frames);
                play(&mut self.motor, speeds, bytes);
                self.asked = approximate(self.motor.position());
                return Ok(());
            }
            Action::ToDeg(deg) => self.asked = deg / half_step_deg,
            Action::TurnDeg(deg) => self.asked += deg / half_step_deg,
        }
        let turn = turn(&self.motor, self.performer, self.asked, one)?;
        play(&mut self.motor, turn.into_iter(), bytes);
        dance.landings.push(Landing {
            number: one.number,
            motor: one.motor,
            frame: one.end(),
            asked_half_steps: self.asked,
            half_steps: self.motor.position(),
        });
        Ok(())
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
) -> Result<Vec<i8>, ScoreErrorKind> {
    let nearest = asked.round();
    let half_steps = nearest - approximate(motor.position());
    if half_steps.abs() > f64::from(i32::MAX) {
        return Err(ScoreErrorKind::TooFar { half_steps });
    }
    #[expect(clippy::cast_possible_truncation, reason = "whole and within i32")]
    let half_steps = half_steps as i32;
    let try_turn = |half_steps: i32| {
        let turn = motor.turn(half_steps, one.frames, one.easing)?;
        let mut turned = *motor;
        turn.iter().for_each(|speed| turned.run(*speed));
        if (approximate(turned.position()) - asked).abs() <= 1.0 {
            return Ok(turn);
        }
        Err(TurnError::Unreachable {
            half_steps,
            frames: one.frames,
            nearest: turned.position() - motor.position(),
        })
    };
    // One half step beside the nearest may be more than one beside what was asked: then the whole
    // number on the other side of that is tried, too.
    let other = half_steps.saturating_add(if asked < nearest { -1 } else { 1 });
    let turn = try_turn(half_steps).or_else(|refusal| try_turn(other).map_err(|_| refusal));
    turn.map_err(|error| ScoreErrorKind::Turn {
        motor: performer.name.clone(),
        error,
    })
}
