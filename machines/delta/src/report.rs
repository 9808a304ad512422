//! The numbers of a run, for programs and for people.

use core::fmt;

use anyhow::Result;
use known_load::{TorqueReport, VibrationReport};
use machine_sim::Followed;
use serde::Serialize;

use crate::motion::Motion;
use crate::record::{Refusal, check};
use crate::simulation::{Driven, Run};

/// As reports and charts name them.
pub(crate) const ARMS: [&str; 3] = ["arm 1", "arm 2", "arm 3"];

/// `report.json`; displayed, a summary in lines.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Lines answered with `ok`.
    moves: usize,
    /// Lines answered with `error:`.
    refused: usize,
    refusals: Vec<Refusal>,
    /// What else was not done.
    notes: Vec<String>,
    /// `rounded` or `trains`.
    motion: &'static str,
    /// Farthest that the simulated platform was from the lines asked for.
    max_path_error_mm: f64,
    /// With smoothed lines, a proven bound on how far the platform leaves the smooth curves, whole
    /// steps not counted.
    departure_bound_mm: Option<f64>,
    /// And one on how far these leave the lines: what of `corner_mm` is used.
    smoothed_bound_mm: Option<f64>,
    duration_s: f64,
    /// Of all motors, either way.
    steps: u64,
    rad_per_step: f64,
    /// Angle of each arm at home, from straight down, outward positive.
    home_rad: [f64; 3],
    /// With a shaper, a proven bound on how far shaping takes the platform off the curves, next to
    /// which it is later by the shaper's delay.
    shaped_bound_mm: Option<f64>,
    /// What is asked of the motors, where load and torque are known.
    torque: Option<TorqueReport>,
    /// How the tool swings, where its mode is known.
    vibration: Option<VibrationReport>,
    /// Steps from home at the end.
    end: [i32; 3],
    /// Start speeds, speed jumps and accelerations by the edges alone; a simulated motor that is
    /// given them loses steps where torque or inertia are overrun.
    motors: [Followed; 3],
    /// The same moves, each line at its feed from the first step to the last.
    trains: Comparison,
    /// The same moves driven by the thesis' control tick.
    tick: Tick,
}

#[derive(Debug, Clone, Serialize)]
struct Comparison {
    max_path_error_mm: f64,
    duration_s: f64,
    motors: [Followed; 3],
}

#[derive(Debug, Clone, Serialize)]
struct Tick {
    tick_s: f64,
    #[serde(flatten)]
    comparison: Comparison,
}

impl Comparison {
    const fn new(driven: &Driven) -> Self {
        Self {
            max_path_error_mm: driven.max_path_error_mm,
            duration_s: driven.duration_s,
            motors: driven.motors,
        }
    }
}

impl Run<'_> {
    /// The numbers.
    #[must_use]
    pub fn report(&self) -> Report {
        Report::new(self)
    }

    fn torque(&self) -> Option<TorqueReport> {
        let used = self.record.torque.as_ref()?;
        let at = self.machine.delta.forward(used.position_at_most()).ok()?;
        Some(TorqueReport::new(used, ARMS, <[f64; 3]>::from(at)))
    }

    fn vibration(&self) -> Option<VibrationReport> {
        let vibration = self.driven.vibration.as_ref()?;
        Some(VibrationReport::new("the tool", vibration, self.unshaped()))
    }
}

impl Report {
    fn new(run: &Run<'_>) -> Self {
        let (machine, record) = (run.machine, run.record);
        Self {
            moves: record.moves.len(),
            refused: record.refusals.len(),
            refusals: record.refusals.clone(),
            notes: record.notes(),
            motion: record.motion.name(),
            max_path_error_mm: run.driven.max_path_error_mm,
            departure_bound_mm: record.departure_bound_mm,
            smoothed_bound_mm: record.smoothed_bound_mm,
            duration_s: run.driven.duration_s,
            steps: run.driven.steps,
            rad_per_step: machine.rad_per_step,
            home_rad: machine.home_rad(),
            shaped_bound_mm: record.shaped_bound_mm,
            torque: run.torque(),
            vibration: run.vibration(),
            end: run.driven.end,
            motors: run.driven.motors,
            trains: Comparison::new(&run.trains),
            tick: Tick {
                tick_s: machine.tick_s,
                comparison: Comparison::new(&run.ticked),
            },
        }
    }

    /// Whether all lines were done.
    ///
    /// # Errors
    /// Lines were refused: how many, and the first.
    pub fn check(&self) -> Result<()> {
        check(&self.refusals, self.moves)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} moves, {} refused, {} steps",
            self.moves, self.refused, self.steps
        )?;
        let line = |driven: &Comparison| {
            let motors = driven.motors.iter();
            let lost: u64 = motors.clone().map(|motor| motor.lost_steps).sum();
            let accelerations = motors.map(|motor| motor.acceleration.proven());
            format!(
                "{:.3} s, at most {:.4} mm off the lines, at least {:.0} deg/s², {lost} steps lost",
                driven.duration_s,
                driven.max_path_error_mm,
                accelerations.fold(0.0, f64::max)
            )
        };
        if self.motion == Motion::Rounded.name() {
            let rounded = Comparison {
                max_path_error_mm: self.max_path_error_mm,
                duration_s: self.duration_s,
                motors: self.motors,
            };
            writeln!(f, "rounded:   {}", line(&rounded))?;
        }
        writeln!(f, "trains:    {}", line(&self.trains))?;
        let tick_ms = self.tick.tick_s * 1000.0;
        writeln!(f, "{tick_ms:.0} ms tick: {}", line(&self.tick.comparison))?;
        if let Some(torque) = &self.torque {
            writeln!(f, "torque:    {torque}")?;
        }
        if let Some(vibration) = &self.vibration {
            writeln!(f, "vibration: {vibration}")?;
        }
        Ok(())
    }
}
