//! G-code to programmed motions.

use core::f64::consts::TAU;

use anyhow::{Context, Result, anyhow, bail, ensure};
use gcode::{Block, Code, CommentKind, Value};
use kurbo::Point;
use pose2pulse::pulse_interp::Turn;

use crate::geometry::{Motion, Shape, angle_on};

/// How far the end of an arc may be from its circle, in mm.
pub(crate) const ARC_TOLERANCE_MM: f64 = 0.02;
/// Start and end of a full circle, which may come from inches.
const SAME_MM: f64 = 1e-6;
/// G0.
pub(crate) const RAPID_MM_S: f64 = 50.0;
/// Before the first F.
const FEED_MM_MIN: f64 = 600.0;
/// What the motors can follow.
const FEEDS_MM_MIN: core::ops::RangeInclusive<f64> = 0.1..=6000.0;
/// Beyond it, no curve is the stage's.
const LARGEST_MM: f64 = 100_000.0;

/// A motion, and the number of its line from 1.
pub(crate) struct Line {
    pub(crate) number: usize,
    pub(crate) motion: Motion,
}

/// What a line asks for.
pub(crate) enum Command {
    Nothing,
    Move(Motion),
    End,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Mode {
    Rapid,
    Straight,
    Circular(Turn),
}

/// The modal state of a program.
#[derive(Debug, Clone)]
pub(crate) struct Interpreter {
    at: Point,
    mode: Option<Mode>,
    relative: bool,
    mm_per_unit: f64,
    feed_mm_min: f64,
}

impl Default for Interpreter {
    fn default() -> Self {
        Self {
            at: Point::ORIGIN,
            mode: None,
            relative: false,
            mm_per_unit: 1.0,
            feed_mm_min: FEED_MM_MIN,
        }
    }
}

/// The values of a line, in its units.
#[derive(Debug, Default)]
struct Words {
    values: Vec<(char, f64)>,
    codes: Vec<(char, u32)>,
}

impl Words {
    fn value(&self, letter: char) -> Option<f64> {
        let found = self.values.iter().find(|(of, _)| *of == letter);
        found.map(|(_, value)| *value)
    }

    fn push(&mut self, letter: char, value: &Value, text: &str) -> Result<()> {
        let letter = letter.to_ascii_uppercase();
        ensure!("XYIJRF".contains(letter), "{text}: no word of this stage");
        ensure!(self.value(letter).is_none(), "{text}: a second {letter}");
        ensure!(matches!(value, Value::Literal(_)), "{text}: no number");
        // The parser's own value has the precision of an f32.
        let number = text.get(1..).unwrap_or_default().trim();
        let number: f64 = number.parse().with_context(|| text.to_owned())?;
        ensure!(number.abs() <= LARGEST_MM, "{text}: above {LARGEST_MM}");
        self.values.push((letter, number));
        Ok(())
    }

    /// Reads one line, with nothing left over.
    fn read(line: &str) -> Result<Self> {
        let program = gcode::parse(line).map_err(|diagnostics| {
            let first = diagnostics.iter().next();
            match first {
                Some(at) => anyhow!("column {}: {:?}", at.span.start + 1, line.trim_end()),
                None => anyhow!("{line:?}"),
            }
        })?;
        let mut words = Self::default();
        for block in &program.blocks {
            for code in &block.codes {
                let (letter, number, args) = match code {
                    Code::General(code) => ('G', code.number, &code.args),
                    Code::Miscellaneous(code) => ('M', code.number, &code.args),
                    other => bail!("{other}: no code of this stage"),
                };
                ensure!(number.minor().is_none(), "{code}: no code of this stage");
                words.codes.push((letter, number.major()));
                for arg in args {
                    let text = line.get(arg.span.start..arg.span.end());
                    words.push(arg.letter, &arg.value, text.unwrap_or_default())?;
                }
            }
            for word in &block.word_addresses {
                let text = line.get(word.span.start..word.span.end());
                words.push(word.letter, &word.value, text.unwrap_or_default())?;
            }
        }
        ensure!(
            words.codes.len() + words.values.len() + beside_words(&program.blocks, line)?
                == letters(line),
            "{:?}: no word of this stage",
            line.trim()
        );
        Ok(words)
    }
}

/// The letters of a line's number and comments. The parser passes over some words in silence: what
/// is neither read nor here is one of those.
fn beside_words(blocks: &[Block], line: &str) -> Result<usize> {
    let mut count = 0;
    for block in blocks {
        count += usize::from(block.line_number.is_some());
        for comment in &block.comments {
            let text = line.get(comment.span.start..comment.span.end());
            let text = text.unwrap_or_default().trim_end();
            ensure!(
                comment.kind == CommentKind::Semicolon || text.ends_with(')'),
                "{text:?}: never closed"
            );
            count += letters(text);
        }
    }
    Ok(count)
}

fn letters(text: &str) -> usize {
    text.bytes().filter(u8::is_ascii_alphabetic).count()
}

impl Interpreter {
    pub(crate) const fn at(&self) -> Point {
        self.at
    }

    /// The motions of a whole program, up to its end.
    pub(crate) fn program(mut self, text: &str) -> Result<Vec<Line>> {
        let mut motions = Vec::new();
        for (number, line) in (1..).zip(text.lines()) {
            match self.line(line).with_context(|| format!("line {number}"))? {
                Command::Nothing => {}
                Command::Move(motion) => motions.push(Line { number, motion }),
                Command::End => break,
            }
        }
        Ok(motions)
    }

    /// What one line asks for; on an error, the state is as before.
    pub(crate) fn line(&mut self, line: &str) -> Result<Command> {
        let words = Words::read(line)?;
        let mut next = self.clone();
        let command = next.command(&words)?;
        *self = next;
        Ok(command)
    }

    /// A straight move from here, outside any program.
    pub(crate) fn jog(&self, to: Point) -> Motion {
        Motion {
            from: self.at,
            to,
            shape: Shape::Line,
            feed_mm_s: RAPID_MM_S,
        }
    }

    /// The stage stands elsewhere than where the last line would have brought it.
    pub(crate) const fn stands_at(&mut self, at: Point) {
        self.at = at;
    }

    fn command(&mut self, words: &Words) -> Result<Command> {
        let (mut motions, mut ends) = (0, false);
        for (letter, number) in &words.codes {
            let mode = match (letter, number) {
                ('G', 0) => Mode::Rapid,
                ('G', 1) => Mode::Straight,
                ('G', 2) => Mode::Circular(Turn::Clockwise),
                ('G', 3) => Mode::Circular(Turn::CounterClockwise),
                other => {
                    ends |= self.setting(*other.0, *other.1)?;
                    continue;
                }
            };
            motions += 1;
            ensure!(motions == 1, "G{number}: a second motion");
            self.mode = Some(mode);
        }
        if let Some(feed) = words.value('F') {
            self.feed_mm_min = feed * self.mm_per_unit;
            ensure!(
                FEEDS_MM_MIN.contains(&self.feed_mm_min),
                "F{feed}: {} mm/min, not within {FEEDS_MM_MIN:?}",
                self.feed_mm_min
            );
        }
        let moves = words.values.iter().any(|(letter, _)| *letter != 'F');
        if ends {
            ensure!(!moves, "a motion with the end of the program");
            return Ok(Command::End);
        }
        if !moves {
            let circular = matches!(self.mode, Some(Mode::Circular(_)));
            ensure!(motions == 0 || !circular, "an arc without I, J or R");
            return Ok(Command::Nothing);
        }
        let motion = self.motion(words)?;
        self.at = motion.to;
        // What has no way needs no steps.
        let stays = matches!(motion.shape, Shape::Line) && motion.from == motion.to;
        Ok(if stays {
            Command::Nothing
        } else {
            Command::Move(motion)
        })
    }

    /// Whether it is the end of the program.
    fn setting(&mut self, letter: char, number: u32) -> Result<bool> {
        match (letter, number) {
            ('G', 17 | 94) => {}
            ('G', 20) => self.mm_per_unit = 25.4,
            ('G', 21) => self.mm_per_unit = 1.0,
            ('G', 90) => self.relative = false,
            ('G', 91) => self.relative = true,
            ('M', 2 | 30) => return Ok(true),
            _ => bail!("{letter}{number}: no code of this stage"),
        }
        Ok(false)
    }

    fn motion(&self, words: &Words) -> Result<Motion> {
        let mode = self.mode.context("no G0, G1, G2 or G3 before")?;
        let mm = |letter| words.value(letter).map(|value| value * self.mm_per_unit);
        let along = |letter, at: f64| match mm(letter) {
            Some(way) if self.relative => at + way,
            Some(to) => to,
            None => at,
        };
        let from = self.at;
        let to = Point::new(along('X', from.x), along('Y', from.y));
        let shape = match mode {
            Mode::Circular(turn) => arc(from, to, turn, mm('I'), mm('J'), mm('R'))?,
            _ => {
                let stray = ['I', 'J', 'R'].into_iter().find(|c| mm(*c).is_some());
                if let Some(letter) = stray {
                    bail!("{letter} on a straight motion");
                }
                Shape::Line
            }
        };
        Ok(Motion {
            from,
            to,
            shape,
            feed_mm_s: match mode {
                Mode::Rapid => RAPID_MM_S,
                _ => self.feed_mm_min / 60.0,
            },
        })
    }
}

fn arc(
    from: Point,
    to: Point,
    turn: Turn,
    i: Option<f64>,
    j: Option<f64>,
    r: Option<f64>,
) -> Result<Shape> {
    let centre = match (i, j, r) {
        (None, None, Some(radius)) => centre_of(from, to, turn, radius)?,
        (None, None, None) => bail!("an arc without I, J or R"),
        (_, _, Some(_)) => bail!("an arc with both R and I or J"),
        (i, j, None) => Point::new(from.x + i.unwrap_or(0.0), from.y + j.unwrap_or(0.0)),
    };
    let (radius, end) = (from.distance(centre), to.distance(centre));
    ensure!(radius > 0.0, "an arc about its own start");
    let off = end - radius;
    ensure!(
        off.abs() <= ARC_TOLERANCE_MM,
        "the end ({:.3}, {:.3}) is {:.3} mm {} the circle of radius {radius:.3} mm about \
         ({:.3}, {:.3}); {ARC_TOLERANCE_MM} mm are allowed",
        to.x,
        to.y,
        off.abs(),
        if off > 0.0 { "outside" } else { "inside" },
        centre.x,
        centre.y
    );
    let sweep = angle_on(centre, from, to, turn);
    Ok(Shape::Arc {
        centre,
        turn,
        sweep_rad: if from.distance(to) < SAME_MM {
            TAU
        } else {
            sweep
        },
    })
}

/// The centre of an arc given by its radius: the shorter way around, the longer if it is negative.
fn centre_of(from: Point, to: Point, turn: Turn, radius: f64) -> Result<Point> {
    let (way, half) = (to - from, from.distance(to) / 2.0);
    ensure!(half > 0.0, "a full circle by R: its centre can be anywhere");
    ensure!(
        half <= radius.abs() + ARC_TOLERANCE_MM / 2.0,
        "R{radius:.3} is too short: start and end are {:.3} mm apart",
        2.0 * half
    );
    let height = (radius * radius - half * half).max(0.0).sqrt();
    // To the left of the way for the shorter arc counter-clockwise.
    let left = (turn == Turn::CounterClockwise) == (radius > 0.0);
    let aside = way.turn_90() / way.hypot() * if left { height } else { -height };
    Ok(from.midpoint(to) + aside)
}
