//! The numbers of a run, for programs and for people.

use core::fmt;

use anyhow::Result;
use machine_sim::Followed;
use serde::Serialize;

use crate::motion::Motion;
use crate::record::{Refusal, check};
use crate::simulation::{Driven, Run};
use crate::torque::MostTorque;

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
    /// With a shaper, a proven bound on how far shaping takes the platform off the curves, next to which
    /// it is later by the shaper's delay.
    shaped_bound_mm: Option<f64>,
    /// What is asked of the motors, where load and torque are known.
    torque: Option<Torque>,
    /// How the tool swings, where its mode is known.
    vibration: Option<Vibrations>,
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

#[derive(Debug, Clone, Copy, Serialize)]
struct Torque {
    #[serde(flatten)]
    most: MostTorque,
    /// Where the platform is then.
    at_mm: [f64; 3],
    /// The part of the pull-out torque that is planned.
    planned: f64,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct Vibrations {
    hz: f64,
    #[serde(flatten)]
    swing: Swing,
    /// The same lines without a shaper.
    unshaped: Option<Swing>,
}

/// Of a simulated tool.
#[derive(Debug, Clone, Copy, Serialize)]
struct Swing {
    /// The farthest that it was off its place on the platform.
    max_off_mm: f64,
    /// How far it swings after the last step.
    left_mm: f64,
}

impl Swing {
    fn of(driven: &Driven) -> Option<Self> {
        let vibration = driven.vibration.as_ref()?;
        Some(Self {
            max_off_mm: vibration.most_mm,
            left_mm: vibration.left_mm,
        })
    }
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

    fn torque(&self) -> Option<Torque> {
        let used = self.record.torque.as_ref()?;
        let at = self.machine.delta.forward(used.angles_at_most()).ok()?;
        Some(Torque {
            most: used.most,
            at_mm: at.into(),
            planned: used.planned,
        })
    }

    fn vibration(&self) -> Option<Vibrations> {
        Some(Vibrations {
            hz: self.machine.elastic.as_ref()?.mode.hz,
            swing: Swing::of(&self.driven)?,
            unshaped: self.unshaped.as_ref().and_then(Swing::of),
        })
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

impl fmt::Display for Torque {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.at_mm;
        let MostTorque { part, arm, t_s, .. } = self.most;
        write!(
            f,
            "at most {:.1} % of what the motors can turn, by arm {arm} at {t_s:.3} s and {x:.1} {y:.1} \
             {z:.1} mm; {:.1} % are planned",
            100.0 * part,
            100.0 * self.planned
        )
    }
}

impl fmt::Display for Vibrations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Swing {
            max_off_mm,
            left_mm,
        } = self.swing;
        write!(
            f,
            "the tool ({:.1} Hz) is at most {max_off_mm:.4} mm off its place, and swings by {left_mm:.4} mm \
             at the end",
            self.hz
        )?;
        if let Some(Swing {
            max_off_mm,
            left_mm,
        }) = self.unshaped
        {
            write!(f, "; without shaping {max_off_mm:.4} and {left_mm:.4} mm")?;
        }
        Ok(())
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
