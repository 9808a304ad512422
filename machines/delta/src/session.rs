//! A dialogue with the machine: bytes in, answers and steps out.

use anyhow::{Context, Error, Result, ensure};
use nalgebra::Point3;

use crate::command::{self, Command};
use crate::line_reader::LineReader;
use crate::machine::Machine;
use crate::motion::Motion;
use crate::plan::Plan;
use crate::record::{Move, Record, Refusal};
use crate::rounded;

/// Takes the steps: ticks of 0.1 microseconds from the start, and the position of the three motors
/// after the step, in steps from home.
pub type StepObserver<'a> = &'a mut dyn FnMut(u64, [i32; 3]) -> Result<()>;

/// Answers lines of `x y z [feed]`, in mm and mm/s, until `end`; `#` begins a comment.
///
/// ```text
/// 50 50 -300       ok -7799 -12831 -14361
/// 50 50 100        error: line 2: 50 50 100: out of reach: ...; the next move starts at 50 50 -300
/// ```
/// A line that is refused changes nothing. With rounded corners, the machine runs when all lines
/// are known.
pub struct Session<'a> {
    machine: &'a Machine,
    motion: Motion,
    observer: StepObserver<'a>,
    reader: LineReader,
    lines: usize,
    is_over: bool,
    /// Where the last move has brought the platform, and the motors.
    point: Point3<f64>,
    position: [i32; 3],
    record: Record,
}

impl core::fmt::Debug for Session<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Session")
            .field("lines", &self.lines)
            .field("is_over", &self.is_over)
            .field("position", &self.position)
            .finish_non_exhaustive()
    }
}

impl<'a> Session<'a> {
    /// A dialogue with a machine at home.
    ///
    /// # Errors
    /// There is no such platform.
    pub fn new(machine: &'a Machine, motion: Motion, observer: StepObserver<'a>) -> Result<Self> {
        let position = [0; 3];
        Ok(Self {
            machine,
            motion,
            observer,
            reader: LineReader::default(),
            lines: 0,
            is_over: false,
            point: machine.point(position)?,
            position,
            record: Record::new(motion),
        })
    }

    /// Takes a byte; returns the answer, if one is due, without an end of line.
    ///
    /// # Errors
    /// The observer's.
    pub fn handle_byte(&mut self, byte: u8) -> Result<Option<String>> {
        match self.reader.byte(byte) {
            Some(line) => self.line(line),
            None => Ok(None),
        }
    }

    /// No more bytes come: the answer to a last line without its end, if one is due.
    ///
    /// # Errors
    /// The observer's.
    pub fn handle_end(&mut self) -> Result<Option<String>> {
        match self.reader.end() {
            Some(line) => self.line(line),
            None => Ok(None),
        }
    }

    /// Whether `end` has come. Lines after it are noted and not answered.
    #[must_use]
    pub const fn is_over(&self) -> bool {
        self.is_over
    }

    /// No more lines come: what came of them. With rounded corners this is when the machine runs.
    ///
    /// # Errors
    /// A corner cannot be rounded where the machine can be, or the observer's.
    pub fn finish(mut self) -> Result<Record> {
        if self.motion == Motion::Rounded {
            rounded::run(self.machine, &mut self.record, &mut *self.observer)?;
        }
        Ok(self.record)
    }

    /// Takes a line, or why it could not be read.
    fn line(&mut self, line: Result<String>) -> Result<Option<String>> {
        self.lines += 1;
        if self.is_over {
            let line = line.unwrap_or_else(|error| error.to_string());
            if !command::is_empty(&line) {
                let name = format!("{line:?}");
                let notes = &mut self.record.notes;
                notes.add(self.lines, name, "after `end`, not done");
            }
            return Ok(None);
        }
        match line.and_then(|line| command::parse(&line)) {
            Ok(None) => Ok(None),
            Ok(Some(Command::End)) => {
                self.is_over = true;
                Ok(None)
            }
            Ok(Some(Command::Move { to, feed_mm_s })) => {
                let feed_mm_s = feed_mm_s.unwrap_or(self.machine.feed_mm_s);
                let start = (self.point, self.position);
                let plan = Plan::new(self.machine, start, to, feed_mm_s).and_then(|plan| {
                    if self.motion == Motion::Rounded {
                        rounded::check(self.machine, self.point, to)?;
                    }
                    Ok(plan)
                });
                match plan.with_context(|| format!("{} {} {}", to.x, to.y, to.z)) {
                    Ok(plan) => self.run(&plan, to, feed_mm_s).map(Some),
                    Err(error) => Ok(Some(self.refuse(&error))),
                }
            }
            Err(error) => Ok(Some(self.refuse(&error))),
        }
    }

    /// Makes the steps of a move, or leaves that to the end.
    fn run(&mut self, plan: &Plan, to: Point3<f64>, feed_mm_s: f64) -> Result<String> {
        let start = self.record.duration_ticks();
        let end_ticks = match self.motion {
            Motion::Rounded => start,
            Motion::Trains => plan.run(self.position, start, &mut *self.observer)?,
        };
        self.record.moves.push(Move {
            line: self.lines,
            from: self.point,
            to,
            feed_mm_s,
            end: plan.end(),
            end_ticks,
            curves_ticks: None,
        });
        (self.point, self.position) = (to, plan.end());
        let [a, b, c] = self.position;
        Ok(format!("ok {a} {b} {c}"))
    }

    fn refuse(&mut self, error: &Error) -> String {
        let (line, reason) = (self.lines, format!("{error:#}"));
        let stays_at_mm: [f64; 3] = self.point.into();
        let [x, y, z] = stays_at_mm.map(rounded);
        let answer = format!("error: line {line}: {reason}; the next move starts at {x} {y} {z}");
        self.record.refusals.push(Refusal {
            line,
            reason,
            stays_at_mm,
        });
        answer
    }
}

/// Looks at all lines of a file before anything moves.
///
/// # Errors
/// The lines that are refused, each with its reason.
pub fn check(machine: &Machine, motion: Motion, lines: &[u8]) -> Result<()> {
    let mut observer = |_: u64, _: [i32; 3]| Ok(());
    let mut session = Session::new(machine, motion, &mut observer)?;
    for byte in lines {
        session.handle_byte(*byte)?;
    }
    session.handle_end()?;
    let refusals = session.record.refusals.iter();
    let refused: Vec<_> = refusals
        .map(|refusal| format!("line {}: {}", refusal.line, refusal.reason))
        .collect();
    ensure!(refused.is_empty(), "nothing moves: {}", refused.join("; "));
    Ok(())
}

/// To a thousandth, without a negative zero.
fn rounded(mm: f64) -> f64 {
    (mm * 1000.0).round() / 1000.0 + 0.0
}
