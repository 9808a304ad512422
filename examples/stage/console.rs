//! Commands by line over a terminal, and keys that jog.

use core::time::Duration;
use std::io::{ErrorKind, Read as _, Write as _};

use anyhow::Result;
use kurbo::{Point, Vec2};

use crate::controller::Controller;
use crate::interpreter::{Command, Interpreter};
use machine_sim::input::Notes;

/// One press of a key.
const JOG_MM: f64 = 1.0;
/// No line of G-code is longer.
const LONGEST_LINE: usize = 255;
/// How long a read waits before it waits again.
const PATIENCE: Duration = Duration::from_millis(200);

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
pub(crate) fn serve(port: &str, controller: &mut Controller) -> Result<Vec<String>> {
    let mut port = serialport::new(port, 9600).timeout(PATIENCE).open()?;
    let mut session = Session {
        controller,
        interpreter: Interpreter::default(),
        notes: Notes::default(),
        lines: 0,
    };
    let (mut line, mut buffer) = (Vec::new(), [0; 64]);
    loop {
        let read = match port.read(&mut buffer) {
            Ok(0) => return Ok(session.notes.lines()),
            Ok(read) => read,
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => {
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        for byte in buffer.iter().take(read) {
            let answer = match byte {
                b'\r' | b'\n' if line.is_empty() => continue,
                b'\r' | b'\n' => match session.line(&core::mem::take(&mut line)) {
                    Some(answer) => answer,
                    None => {
                        writeln!(port, "ok")?;
                        port.flush()?;
                        return Ok(session.notes.lines());
                    }
                },
                key if line.is_empty() && b"?<>^v".contains(key) => session.key(*key),
                byte => {
                    // One more than is allowed, so that it is seen to be too long.
                    if line.len() <= LONGEST_LINE {
                        line.push(*byte);
                    }
                    continue;
                }
            };
            writeln!(port, "{answer}")?;
            port.flush()?;
        }
    }
}

struct Session<'a> {
    controller: &'a mut Controller,
    interpreter: Interpreter,
    notes: Notes,
    lines: usize,
}

impl Session<'_> {
    /// The answer to a line; `None` for the end of the program.
    fn line(&mut self, line: &[u8]) -> Option<String> {
        self.lines += 1;
        let number = self.lines;
        let place = || format!("at line {number}");
        let mut met = Notes::default();
        let read = if line.len() > LONGEST_LINE {
            Err(anyhow::anyhow!("more than {LONGEST_LINE} bytes"))
        } else {
            let text = String::from_utf8_lossy(line);
            self.interpreter.line(number, &text, &mut met)
        };
        let new = self.notes.merge(met).lines();
        let messages: String = new.iter().map(|note| format!("[MSG:{note}]\n")).collect();
        let run = match read {
            Ok(Command::End) => return None,
            Ok(Command::Mark) => Ok(()),
            Ok(Command::Moves(moves)) => moves.iter().try_for_each(|motion| self.run(motion)),
            Err(error) => Err(error),
        };
        Some(match run {
            Ok(()) => format!("{messages}ok"),
            Err(error) => format!("{messages}error:{error:#} {}", place()),
        })
    }

    fn key(&mut self, key: u8) -> String {
        let way = match key {
            b'>' => Vec2::new(JOG_MM, 0.0),
            b'<' => Vec2::new(-JOG_MM, 0.0),
            b'^' => Vec2::new(0.0, JOG_MM),
            b'v' => Vec2::new(0.0, -JOG_MM),
            _ => return self.position(),
        };
        let to = self.interpreter.at() + way;
        let motion = self.interpreter.jog(to);
        self.interpreter.stands_at(to);
        match self.run(&motion) {
            Ok(()) => self.position(),
            Err(error) => format!("error:{error:#}"),
        }
    }

    /// Makes a motion; where it breaks off, the program goes on from there.
    fn run(&mut self, motion: &crate::geometry::Motion) -> Result<()> {
        let run = self.controller.run(motion);
        if run.is_err() {
            self.interpreter.stands_at(self.controller.commanded_mm());
        }
        run
    }

    fn position(&self) -> String {
        let Point { x, y } = self.controller.scales_mm();
        // No negative zero.
        format!("pos:{:.2},{:.2}", x + 0.0, y + 0.0)
    }
}
