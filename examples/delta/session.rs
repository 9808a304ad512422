//! Line after line: what is done, what is refused, and where the machine is then.

use anyhow::{Context, Result};
use nalgebra::Point3;
use serde::Serialize;

use crate::command::{self, Command};
use crate::drive::Plan;
use crate::machine::Machine;
use crate::simulation::Asked;

/// A line that has been answered with `error:`.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Refusal {
    pub(crate) line: usize,
    pub(crate) reason: String,
    /// Where the machine was left, and the next move starts.
    pub(crate) stays_at_mm: [f64; 3],
}

/// What comes of a line.
pub(crate) enum Outcome {
    /// Empty, or a comment.
    Nothing,
    /// The steps from `from` on, in steps from home.
    Move {
        from: [i32; 3],
        plan: Plan,
    },
    /// The answer to a line that moves nothing.
    Refused(String),
    End,
}

/// The state of the machine between two lines.
pub(crate) struct Session<'a> {
    machine: &'a Machine,
    /// Where the last line that was done has brought the platform, and the motors.
    place: Point3<f64>,
    position: [i32; 3],
    pub(crate) asked: Vec<Asked>,
    pub(crate) refusals: Vec<Refusal>,
}

impl<'a> Session<'a> {
    /// A machine at home.
    pub(crate) fn new(machine: &'a Machine) -> Result<Self> {
        let position = [0; 3];
        Ok(Self {
            machine,
            place: machine.point(position)?,
            position,
            asked: Vec::new(),
            refusals: Vec::new(),
        })
    }

    /// Takes a line, or why it could not be read. A line that is refused changes nothing.
    pub(crate) fn line(&mut self, number: usize, line: Result<&str>) -> Outcome {
        let planned = match line.and_then(command::parse) {
            Ok(None) => return Outcome::Nothing,
            Ok(Some(Command::End)) => return Outcome::End,
            Ok(Some(Command::Move { to, feed_mm_s })) => {
                self.plan(to, feed_mm_s).map(|plan| (to, plan))
            }
            Err(error) => Err(error),
        };
        match planned {
            Ok((to, plan)) => {
                let (from, answer) = (self.position, plan.end());
                self.asked.push(Asked {
                    from: self.place,
                    to,
                    answer,
                });
                (self.place, self.position) = (to, answer);
                Outcome::Move { from, plan }
            }
            Err(error) => Outcome::Refused(self.refuse(number, &error)),
        }
    }

    fn plan(&self, to: Point3<f64>, feed_mm_s: Option<f64>) -> Result<Plan> {
        let feed = feed_mm_s.unwrap_or(self.machine.feed_mm_s);
        let from = (self.place, self.position);
        let place = || format!("{} {} {}", to.x, to.y, to.z);
        Plan::new(self.machine, from, to, feed).with_context(place)
    }

    fn refuse(&mut self, line: usize, error: &anyhow::Error) -> String {
        let reason = format!("{error:#}");
        let [x, y, z] = self.place.into();
        let answer = format!(
            "error: line {line}: {reason}; the next move starts at {} {} {}",
            rounded(x),
            rounded(y),
            rounded(z)
        );
        self.refusals.push(Refusal {
            line,
            reason,
            stays_at_mm: [x, y, z],
        });
        answer
    }
}

/// To a thousandth, without a negative zero.
fn rounded(mm: f64) -> f64 {
    (mm * 1000.0).round() / 1000.0 + 0.0
}
