//! Commands by line over a terminal, and keys that jog.

use core::time::Duration;
use std::io::{ErrorKind, Read as _, Write as _};

use anyhow::{Context, Result};
use kurbo::{Point, Vec2};

use crate::controller::Controller;
use crate::program::{Command, Interpreter};

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
/// ?             pos:20.00,0.00
/// > < ^ v       jogs X up, X down, Y up, Y down by 1 mm; answers as ?
/// ```
/// A line that fails is not executed any further; the next one is.
pub(crate) fn serve(port: &str, controller: &mut Controller) -> Result<()> {
    let mut port = serialport::new(port, 9600).timeout(PATIENCE).open()?;
    let mut session = Session {
        controller,
        interpreter: Interpreter::default(),
        lines: 0,
    };
    let (mut line, mut buffer) = (Vec::new(), [0; 64]);
    loop {
        let read = match port.read(&mut buffer) {
            Ok(0) => return Ok(()),
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
                        return Ok(port.flush()?);
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
    lines: usize,
}

impl Session<'_> {
    /// The answer to a line; `None` for the end of the program.
    fn line(&mut self, line: &[u8]) -> Option<String> {
        self.lines += 1;
        let number = self.lines;
        let place = || format!("at line {number}");
        let read = if line.len() > LONGEST_LINE {
            Err(anyhow::anyhow!("more than {LONGEST_LINE} bytes"))
        } else {
            core::str::from_utf8(line)
                .context("no text")
                .and_then(|text| self.interpreter.line(text))
        };
        match read {
            Ok(Command::End) => None,
            Ok(Command::Nothing) => Some("ok".to_owned()),
            Ok(Command::Move(motion)) => Some(match self.run(&motion) {
                Ok(()) => "ok".to_owned(),
                Err(error) => format!("error:{error:#} {}", place()),
            }),
            Err(error) => Some(format!("error:{error:#} {}", place())),
        }
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
