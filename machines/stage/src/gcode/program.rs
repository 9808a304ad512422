//! Whole programs of G-code.

use anyhow::{Context, Result, bail, ensure};
use kurbo::{Point, Rect, Vec2};

use super::codes;
use super::interpreter::{Command, Interpreter};
use super::words;
use crate::grid::STEPS_PER_MM;
use crate::motion::{Motion, Shape};
use crate::stage::TRAVEL_MM;
use machine_sim::input::Notes;

/// A motion, and the number of its line from 1.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    pub(crate) number: usize,
    pub(crate) motion: Motion,
}

/// What a whole program asks for, up to its end: at least one motion.
#[derive(Debug, Clone, Default)]
pub struct Program {
    pub(crate) lines: Vec<Line>,
    notes: Notes,
}

impl Program {
    /// Reads a program.
    ///
    /// # Errors
    /// A line that would move X or Y otherwise than written, or that cannot be read, with its
    /// number; or nothing moves.
    pub fn parse(text: &str) -> Result<Self> {
        let mut interpreter = Interpreter::default();
        let mut program = Self::default();
        let (mut has_begun, mut has_ended) = (false, false);
        for (number, line) in (1..).zip(lines(text)) {
            if has_ended {
                program.note_unread(number, line);
                continue;
            }
            let command = interpreter.line(number, line, &mut program.notes);
            match command.with_context(|| format!("line {number}"))? {
                Command::Moves(moves) => {
                    let line = |motion| Line { number, motion };
                    program.lines.extend(moves.into_iter().map(line));
                }
                Command::Mark => has_ended = has_begun,
                Command::End => has_ended = true,
            }
            has_begun |= !line.trim().is_empty();
        }
        if program.lines.is_empty() {
            let why = ["nothing moves".to_owned()];
            bail!("{}", [&why, &*program.notes()].concat().join(": "));
        }
        Ok(program)
    }

    /// Reads a program as it is stored: where bytes are no text, in a comment of an old program,
    /// nothing is lost.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        Self::parse(&String::from_utf8_lossy(bytes))
    }

    /// The program with its zero at `offset`, X and Y in mm from that of the stage, where it begins
    /// all the same.
    ///
    /// # Errors
    /// The offset is no number.
    pub fn with_offset(mut self, offset: [f64; 2]) -> Result<Self> {
        let [x, y] = offset;
        let by = Vec2::new(x, y);
        ensure!(by.is_finite(), "offset {x},{y} is not a finite number");
        for line in &mut self.lines {
            line.motion = line.motion.moved(by);
        }
        if let Some(first) = self.lines.first_mut() {
            match first.motion.shape {
                Shape::Line => first.motion.from = Point::ZERO,
                Shape::Arc { .. } => {
                    let (number, to) = (first.number, first.motion.from);
                    let motion = Motion::rapid(Point::ZERO, to);
                    self.lines.insert(0, Line { number, motion });
                }
            }
        }
        Ok(self)
    }

    /// The program with its zero where all of it is within the travel of the stage: its own, if
    /// that will do, else with the lowest X, or Y, at 0.
    ///
    /// # Errors
    /// It is larger than the travel.
    pub fn fit(self) -> Result<Self> {
        let motions = self.lines.iter().map(|line| line.motion);
        let points = motions.flat_map(|motion| {
            // From where the stage stands a first line may begin anywhere.
            let is_line = matches!(motion.shape, Shape::Line);
            let points = motion.points();
            points.into_iter().skip(usize::from(is_line))
        });
        let taken = points.map(|at| Rect::from_points(at, at));
        let taken = taken.reduce(|all, at| all.union(at)).unwrap_or_default();
        let [travel_x, travel_y] = TRAVEL_MM;
        let offset = |axis: &str, low: f64, high: f64, travel: f64| {
            let size = high - low;
            ensure!(
                size <= travel,
                "the program takes {size:.3} mm in {axis}, the stage travels {travel} mm"
            );
            let is_within = low >= 0.0 && high <= travel;
            Ok(if is_within { 0.0 } else { -low })
        };
        let x = offset("X", taken.x0, taken.x1, travel_x)?;
        let y = offset("Y", taken.y0, taken.y1, travel_y)?;
        self.with_offset([x, y])
    }

    /// The number of the line of each motion, from 1.
    pub fn line_numbers(&self) -> impl Iterator<Item = usize> {
        self.lines.iter().map(|line| line.number)
    }

    /// Points of each motion, X and Y in mm, near enough for a picture.
    pub fn points(&self) -> impl Iterator<Item = Vec<[f64; 2]>> {
        let motions = self.lines.iter().map(|line| line.motion);
        motions.map(|motion| motion.points().iter().map(|at| [at.x, at.y]).collect())
    }

    /// Steps of both axes that the lines and arcs have, as far as their points tell.
    #[must_use]
    pub fn steps(&self) -> f64 {
        let steps = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (c - a).abs() + (d - b).abs();
        let of = |points: Vec<[f64; 2]>| {
            let pairs = points.iter().zip(points.iter().skip(1));
            pairs.map(|(from, to)| steps(*from, *to)).sum::<f64>()
        };
        self.points().map(of).sum::<f64>() * STEPS_PER_MM
    }

    /// What it asks for that is left out or done otherwise.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.notes.lines()
    }

    /// Notes a line after the end, unless it is empty.
    fn note_unread(&mut self, number: usize, line: &str) {
        let is_empty = words::read(line).is_ok_and(|block| block.words.is_empty());
        if !is_empty {
            let begin: String = line.trim().chars().take(SHOWN).collect();
            self.notes
                .add(number, format!("{begin:?}"), codes::AFTER_END);
        }
    }
}

/// Of a line that is only noted, in characters.
const SHOWN: usize = 24;

/// Lines that end as on any system, without the mark of the text's encoding.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    text.split('\n')
        .map(|line| line.strip_suffix('\r').unwrap_or(line))
        .flat_map(|line| line.split('\r'))
}
