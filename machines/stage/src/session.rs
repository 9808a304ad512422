//! A dialogue with the stage: commands by line, and keys that jog. Bytes in, answers out.

use anyhow::{Result, anyhow};
use kurbo::{Point, Vec2};
use machine_sim::input::Notes;

use crate::controller::{Controller, StepObserver};
use crate::gcode::{Command, Interpreter};
use crate::machine::Machine;
use crate::motion::Motion;
use crate::run::Run;
use crate::settings::Settings;

/// One press of a key.
const JOG_MM: f64 = 1.0;
/// No line of G-code is longer.
const MAX_LINE: usize = 255;

/// Answers lines and keys until M2 or M30.
///
/// ```text
/// G1 X20 F600   ok
/// G1 X500       error:on the way to (500.000, 0.000) mm: X: the upper limit switch is closed
///               at 12100 steps at line 2
/// G1 Q          error:... at line 3
/// G1 Z5         [MSG:line 4: Z: passed over, the stage has no such axis (1 time)]
///               ok
/// ?             pos:20.00,0.00
/// > < ^ v       jogs X up, X down, Y up, Y down by 1 mm; answers as ?
/// ```
/// A line that fails is not executed any further; the next one is. A message comes with the first
/// of its kind; all of them are returned in the end.
#[derive(Debug)]
pub struct Session<'a> {
    controller: Controller<'a>,
    interpreter: Interpreter,
    notes: Notes,
    lines: usize,
    line: Vec<u8>,
    is_over: bool,
}

impl<'a> Session<'a> {
    /// A dialogue with a stage that has just been switched on, and homes.
    ///
    /// # Errors
    /// It does not find its switches.
    pub fn new(machine: &Machine, settings: &Settings, observer: StepObserver<'a>) -> Result<Self> {
        Ok(Self {
            controller: Controller::homed(machine, settings, observer)?,
            interpreter: Interpreter::default(),
            notes: Notes::default(),
            lines: 0,
            line: Vec::new(),
            is_over: false,
        })
    }

    /// Takes a byte; returns the answer, if one is due, without the end of its last line.
    pub fn handle_byte(&mut self, byte: u8) -> Option<String> {
        if self.is_over {
            return None;
        }
        match byte {
            b'\r' | b'\n' if self.line.is_empty() => None,
            b'\r' | b'\n' => {
                let line = core::mem::take(&mut self.line);
                Some(self.answer(&line))
            }
            key if self.line.is_empty() && b"?<>^v".contains(&key) => Some(self.key(key)),
            byte => {
                // One more than is allowed, so that it is seen to be too long.
                if self.line.len() <= MAX_LINE {
                    self.line.push(byte);
                }
                None
            }
        }
    }

    /// Whether M2 or M30 has ended the dialogue.
    #[must_use]
    pub const fn is_over(&self) -> bool {
        self.is_over
    }

    /// What came of the dialogue, and its notes.
    ///
    /// # Errors
    /// More steps are lost than the loop corrects.
    pub fn finish(self) -> Result<(Run, Vec<String>)> {
        Ok((self.controller.finish()?, self.notes.lines()))
    }

    fn answer(&mut self, line: &[u8]) -> String {
        self.lines += 1;
        let number = self.lines;
        let mut met = Notes::default();
        let read = if line.len() > MAX_LINE {
            Err(anyhow!("more than {MAX_LINE} bytes"))
        } else {
            let text = String::from_utf8_lossy(line);
            self.interpreter.line(number, &text, &mut met)
        };
        let new = self.notes.merge(met).lines();
        let messages: String = new.iter().map(|note| format!("[MSG:{note}]\n")).collect();
        let run = match read {
            Ok(Command::End) => {
                self.is_over = true;
                Ok(())
            }
            Ok(Command::Mark) => Ok(()),
            Ok(Command::Moves(moves)) => moves.iter().try_for_each(|motion| self.run(motion)),
            Err(error) => Err(error),
        };
        match run {
            Ok(()) => format!("{messages}ok"),
            Err(error) => format!("{messages}error:{error:#} at line {number}"),
        }
    }

    fn key(&mut self, key: u8) -> String {
        let by = match key {
            b'>' => Vec2::new(JOG_MM, 0.0),
            b'<' => Vec2::new(-JOG_MM, 0.0),
            b'^' => Vec2::new(0.0, JOG_MM),
            b'v' => Vec2::new(0.0, -JOG_MM),
            _ => return self.position(),
        };
        let to = self.interpreter.at() + by;
        let motion = self.interpreter.jog(to);
        self.interpreter.stands_at(to);
        match self.run(&motion) {
            Ok(()) => self.position(),
            Err(error) => format!("error:{error:#}"),
        }
    }

    /// Makes a motion; where it breaks off, the program goes on from there.
    fn run(&mut self, motion: &Motion) -> Result<()> {
        self.controller.run(&[*motion]).map_err(|broken_off| {
            self.interpreter.stands_at(self.controller.commanded_mm());
            broken_off.error
        })
    }

    fn position(&self) -> String {
        let Point { x, y } = self.controller.scales_mm();
        // No negative zero.
        format!("pos:{:.2},{:.2}", x + 0.0, y + 0.0)
    }
}
