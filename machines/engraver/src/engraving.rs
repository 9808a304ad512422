//! A drawing engraved by the simulated machine, by one controller or by both.

use core::fmt;
use core::str::FromStr;

use anyhow::{Error, Result, bail};

use crate::simulation::{Run, simulate};
use crate::timed::{TimedPlan, simulate_timed};
use crate::{Drawing, Machine, Plan, PlanSettings, Report, Wires};

/// What drives the motors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum MotorController {
    /// The source's, which gets nothing but the pattern bytes.
    #[default]
    Pattern,
    /// One that runs the joints' cubics: the tool at its feed wherever joints and disc allow.
    Timed,
}

impl fmt::Display for MotorController {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pattern => "pattern",
            Self::Timed => "timed",
        })
    }
}

impl FromStr for MotorController {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Ok(match name {
            "pattern" => Self::Pattern,
            "timed" => Self::Timed,
            _ => bail!("the controllers are pattern and timed"),
        })
    }
}

/// What the simulated arm made of the pattern, and of timed strokes where they were asked for.
#[derive(Debug, Clone)]
pub struct Engraving {
    pattern: Run,
    timed: Option<Run>,
}

impl Engraving {
    /// Plays the plan's pattern, and with [`MotorController::Timed`] the drawing in timed strokes
    /// too. The wires get the edges of the controller that is asked for.
    ///
    /// # Errors
    /// A place that the timed strokes cannot reach; what a wire refuses.
    pub fn run(
        machine: &Machine,
        drawing: &Drawing,
        settings: &PlanSettings,
        plan: &Plan,
        controller: MotorController,
        wires: &mut impl Wires,
        mut progress: impl FnMut(u64, u64),
    ) -> Result<Self> {
        let (pattern, reference) = (plan.pattern(), plan.reference());
        Ok(match controller {
            MotorController::Pattern => Self {
                pattern: simulate(machine, pattern, reference, wires, progress)?,
                timed: None,
            },
            MotorController::Timed => {
                let pattern = simulate(machine, pattern, reference, &mut (), &mut progress)?;
                let plan = TimedPlan::new(machine, drawing, settings, progress)?;
                let mut timed = simulate_timed(machine, &plan, wires, |_, _| ())?;
                if let Some(unshaped) = machine.unshaped() {
                    let plan = TimedPlan::new(&unshaped, drawing, settings, |_, _| ())?;
                    let run = simulate_timed(&unshaped, &plan, &mut (), |_, _| ())?;
                    timed.unshaped = run.vibration;
                }
                Self {
                    pattern,
                    timed: Some(timed),
                }
            }
        })
    }

    /// The run of the controller that was asked for.
    #[must_use]
    pub fn shown(&self) -> &Run {
        self.timed.as_ref().unwrap_or(&self.pattern)
    }

    /// Whether the tool stayed within the bound in all runs.
    #[must_use]
    pub fn is_within_bound(&self) -> bool {
        self.pattern.is_within_bound() && self.timed.as_ref().is_none_or(Run::is_within_bound)
    }

    /// The report of all runs.
    #[must_use]
    pub fn report<'a>(
        &'a self,
        machine: &'a Machine,
        drawing: &'a Drawing,
        plan: &'a Plan,
    ) -> Report<'a> {
        let report = Report::new(machine, drawing, plan, &self.pattern);
        match &self.timed {
            Some(timed) => report.with_timed(machine, timed),
            None => report,
        }
    }
}
