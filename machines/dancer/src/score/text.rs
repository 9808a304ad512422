//! A score from its text.

mod clock;
mod lines;

use std::collections::HashMap;

use pattern_codec::dance::{Threshold, Timing};
use serde::Deserialize;
use toml::Spanned;

use self::clock::{Clock, MAX_FRAMES, WITHIN_MAX_FRAMES};
use self::lines::{Lines, text_error};

use super::{Action, Move, Performer, Score, ScoreError, ScoreErrorKind, ScorePart, approximate};
use crate::easing::Easing;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScoreText {
    #[serde(default)]
    title: String,
    tick_us: Option<Spanned<u32>>,
    frame_ticks: Option<Spanned<u32>>,
    threshold: Option<Spanned<u16>>,
    length_s: Option<Spanned<f64>>,
    #[serde(default)]
    motor: Vec<Spanned<MotorText>>,
    #[serde(default, rename = "move")]
    moves: Vec<Spanned<MoveText>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MotorText {
    name: String,
    half_step_deg: f64,
    max_speed: Option<i64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MoveText {
    motor: String,
    at_s: f64,
    for_s: f64,
    speed: Option<i64>,
    to_deg: Option<f64>,
    turn_deg: Option<f64>,
    #[serde(default)]
    easing: Easing,
    repeat: Option<u32>,
    every_s: Option<f64>,
}

pub(super) fn read(text: &str) -> Result<Score, ScoreError> {
    let score: ScoreText = toml::from_str(text).map_err(|error| text_error(text, &error))?;
    let lines = Lines::of(text);
    let head = |line, kind| ScoreError {
        line,
        part: ScorePart::Head,
        kind,
    };
    let default = Timing::DEFAULT;
    let (tick_line, tick_us) = setting(&lines, score.tick_us, default.tick_us());
    let (frame_line, frame_ticks) = setting(&lines, score.frame_ticks, default.frame_ticks());
    let zero_line = if tick_us == 0 { tick_line } else { frame_line };
    let timing = Timing::new(tick_us, frame_ticks);
    let timing = timing.map_err(|error| head(zero_line, error.into()))?;
    let default = Threshold::DEFAULT.get();
    let (threshold_line, threshold) = setting(&lines, score.threshold, default);
    let threshold = Threshold::new(threshold);
    let threshold = threshold.map_err(|error| head(threshold_line, error.into()))?;

    let mut motors: Vec<Performer> = Vec::new();
    let mut names = HashMap::new();
    for (motor, number) in score.motor.into_iter().zip(1..) {
        let line = lines.line(motor.span().start);
        let part = ScorePart::Motor(number);
        let motor = motor.into_inner().check(&names);
        let motor = motor.map_err(|kind| ScoreError { line, part, kind })?;
        names.insert(motor.name.clone(), motors.len());
        motors.push(motor);
    }
    if motors.is_empty() {
        return Err(head(1, ScoreErrorKind::NoMotor));
    }

    let clock = Clock { timing };
    let mut moves = Vec::new();
    // Frames in which each motor moves.
    let mut busy = vec![0_u64; motors.len()];
    for (written, number) in score.moves.into_iter().zip(1..) {
        let line = lines.line(written.span().start);
        let part = ScorePart::Move(number);
        let at = |kind| ScoreError { line, part, kind };
        let written = written.into_inner();
        let (first, every, times) = written
            .check(number, line, clock, &motors, &names)
            .map_err(at)?;
        let nth = |time: u32| {
            let start = u64::from(every).saturating_mul(time.into());
            let start = start.saturating_add(first.start.into());
            Move {
                start: u32::try_from(start).unwrap_or(u32::MAX),
                ..first.clone()
            }
        };
        if times > 1 && every < first.frames.into() {
            return Err(overlap(&first, &nth(1), &motors, clock));
        }
        for again in (0..times).map(nth) {
            if again.end() > MAX_FRAMES {
                return Err(at(clock.too_long(&again)));
            }
            if let Some(busy) = busy.get_mut(again.motor) {
                *busy = busy.saturating_add(again.frames.into());
            }
            moves.push(again);
        }
        if busy.get(first.motor) > Some(&MAX_FRAMES.into()) {
            // They overlap, which is said below; more of them need not be counted out.
            break;
        }
    }
    moves.sort_by_key(|one| one.start);
    check_overlaps(&moves, &motors, clock)?;

    let end = moves.iter().map(Move::end).max().unwrap_or(0);
    let frames = match score.length_s {
        Some(length_s) => {
            let line = lines.line(length_s.span().start);
            let frames = clock.length(length_s.into_inner(), end);
            frames.map_err(|kind| head(line, kind))?
        }
        None => end,
    };
    if frames == 0 {
        return Err(head(1, ScoreErrorKind::NoFrames));
    }
    Ok(Score {
        title: score.title,
        timing,
        threshold,
        motors,
        moves,
        frames,
    })
}

/// A setting and its line; the default on line 1 where it is not given.
fn setting<T>(lines: &Lines, given: Option<Spanned<T>>, default: T) -> (u32, T) {
    given.map_or((1, default), |given| {
        (lines.line(given.span().start), given.into_inner())
    })
}

impl MotorText {
    fn check(self, others: &HashMap<String, usize>) -> Result<Performer, ScoreErrorKind> {
        let Self {
            name,
            half_step_deg,
            max_speed,
        } = self;
        if let Some(&other) = others.get(&name) {
            let first = u32::try_from(other).unwrap_or(u32::MAX).saturating_add(1);
            return Err(ScoreErrorKind::SameName { name, first });
        }
        if !half_step_deg.is_finite() || half_step_deg <= 0.0 {
            return Err(ScoreErrorKind::Value {
                key: "half_step_deg",
                value: half_step_deg,
                wanted: "above 0",
            });
        }
        let max_speed = max_speed.unwrap_or(i8::MAX.into());
        let fits = i8::try_from(max_speed).ok().filter(|max| *max > 0);
        let max_speed = fits.ok_or(ScoreErrorKind::Value {
            key: "max_speed",
            value: approximate(max_speed),
            wanted: "within 1..=127",
        })?;
        Ok(Performer {
            name,
            half_step_deg,
            max_speed: max_speed.unsigned_abs(),
        })
    }
}

impl MoveText {
    /// The move, and how many frames after its start it starts again, how many times in all.
    fn check(
        self,
        number: u32,
        line: u32,
        clock: Clock,
        motors: &[Performer],
        names: &HashMap<String, usize>,
    ) -> Result<(Move, u32, u32), ScoreErrorKind> {
        let motor = names.get(&self.motor).copied();
        let performer = motor.and_then(|motor| Some((motor, motors.get(motor)?)));
        let Some((motor, performer)) = performer else {
            return Err(ScoreErrorKind::NoSuchMotor { name: self.motor });
        };
        let frames = clock.frames("for_s", self.for_s)?;
        if frames == 0 {
            return Err(ScoreErrorKind::Value {
                key: "for_s",
                value: self.for_s,
                wanted: "above 0",
            });
        }
        let frames = u16::try_from(frames).map_err(|_| ScoreErrorKind::Value {
            key: "for_s",
            value: self.for_s,
            wanted: WITHIN_MAX_FRAMES,
        })?;
        let (every, times) = match (self.every_s, self.repeat) {
            (None, None) => (0, 1),
            (Some(_), Some(0)) => {
                return Err(ScoreErrorKind::Value {
                    key: "repeat",
                    value: 0.0,
                    wanted: "above 0",
                });
            }
            (Some(every_s), Some(times)) => (clock.frames("every_s", every_s)?, times),
            _ => return Err(ScoreErrorKind::Repeat),
        };
        let first = Move {
            number,
            line,
            motor,
            start: clock.frames("at_s", self.at_s)?,
            frames,
            action: self.action(performer)?,
            easing: self.easing,
        };
        Ok((first, every, times))
    }

    fn action(&self, performer: &Performer) -> Result<Action, ScoreErrorKind> {
        let finite = |key, value: f64| {
            let wanted = "finite";
            let error = ScoreErrorKind::Value { key, value, wanted };
            value.is_finite().then_some(value).ok_or(error)
        };
        match (self.speed, self.to_deg, self.turn_deg) {
            (Some(speed), None, None) => {
                let max = performer.max_speed;
                let fits = i8::try_from(speed).ok();
                let fits = fits.filter(|speed| speed.unsigned_abs() <= max);
                let error = ScoreErrorKind::Speed { speed, max };
                fits.map(Action::Speed).ok_or(error)
            }
            (None, Some(deg), None) => finite("to_deg", deg).map(Action::ToDeg),
            (None, None, Some(deg)) => finite("turn_deg", deg).map(Action::TurnDeg),
            (speed, to_deg, turn_deg) => {
                let given = [speed.is_some(), to_deg.is_some(), turn_deg.is_some()];
                let given = given.into_iter().filter(|given| *given).count();
                Err(ScoreErrorKind::Action { given })
            }
        }
    }
}

/// Refuses moves of one motor at once, in the order of their starts.
fn check_overlaps(moves: &[Move], motors: &[Performer], clock: Clock) -> Result<(), ScoreError> {
    let mut last: Vec<Option<&Move>> = vec![None; motors.len()];
    for after in moves {
        let before = last
            .get_mut(after.motor)
            .and_then(|last| last.replace(after));
        if let Some(before) = before.filter(|before| after.start < before.end()) {
            return Err(overlap(before, after, motors, clock));
        }
    }
    Ok(())
}

/// A move that starts before another one of its motor has ended.
fn overlap(before: &Move, after: &Move, motors: &[Performer], clock: Clock) -> ScoreError {
    let performer = motors.get(after.motor);
    ScoreError {
        line: after.line,
        part: ScorePart::Move(after.number),
        kind: ScoreErrorKind::Overlap {
            start_s: clock.seconds(after.start),
            motor: performer.map_or_else(String::new, |motor| motor.name.clone()),
            other: before.number,
            end_s: clock.seconds(before.end()),
        },
    }
}
