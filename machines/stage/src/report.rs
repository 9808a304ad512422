//! The numbers of a run, for programs and for people.

use core::fmt;

use anyhow::{Result, ensure};
use known_load::{TorqueReport, VibrationReport};
use serde::Serialize;

use crate::motion::Motion;
use crate::motors::FollowedAxes;
use crate::run::Run;
use crate::settings::Stepping;
use crate::timed::axis_feed;

/// The axes as messages and charts have them, and their tables.
pub(crate) const AXES: [&str; 2] = ["X", "Y"];
pub(crate) const TABLES: [&str; 2] = ["the table of X", "the table of Y"];

/// `report.json`; displayed, a summary in lines. Steps are those of the path, as in `steps.csv`;
/// corrections are counted apart.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    stepping: &'static str,
    /// Either way.
    steps_x: u64,
    /// Either way.
    steps_y: u64,
    /// From the drawing's zero.
    end_steps: [i32; 2],
    /// How far timed steps may leave the lines to pass their corners faster.
    tolerance_mm: f64,
    /// How far the curves leave the lines at most, by the proof.
    smoothed_bound_mm: f64,
    /// Of the stage from the programmed curve.
    max_deviation_mm: f64,
    /// Of the stage from the programmed end.
    closing_error_mm: f64,
    lost_steps: u64,
    corrected_steps: u64,
    duration_s: f64,
    open_loop: OpenLoop,
    /// Start speeds, speed jumps and accelerations by the edges alone; a simulated motor that is
    /// given them loses steps where torque or inertia are overrun.
    motors: FollowedAxes,
    /// The same motions at their feeds from the first step to the last.
    at_feed: FollowedAxes,
    /// Motions that go slower than their feed, because an axis goes no faster than
    /// `max_axis_speed_mm_s`.
    slower_motions: usize,
    max_axis_speed_mm_s: f64,
    lose_steps: f64,
    seed: u64,
    /// Where rows are shaped, a proven bound on how far that takes the stage off the curves, next
    /// to which it is later by the shapers' delay.
    #[serde(skip_serializing_if = "Option::is_none")]
    shaped_bound_mm: Option<f64>,
    /// What is asked of the motors, where load and torque are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    torque: Option<TorqueReport>,
    /// How both tables swing, where their modes are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    vibration: Option<TablesSwing>,
    /// What the program asked for that was left out or done otherwise.
    notes: Vec<String>,
}

/// How both tables swing.
#[derive(Debug, Clone, Serialize)]
struct TablesSwing {
    x: VibrationReport,
    y: VibrationReport,
}

/// The stage beside it, without corrections.
#[derive(Debug, Clone, Serialize)]
struct OpenLoop {
    max_deviation_mm: f64,
    closing_error_mm: f64,
    lost_steps: u64,
}

impl Run {
    /// The numbers.
    #[must_use]
    pub fn report(&self) -> Report {
        Report::new(self)
    }

    fn torque_report(&self) -> Option<TorqueReport> {
        let used = self.torque()?;
        Some(TorqueReport::new(used, AXES, used.position_at_most()))
    }

    fn tables_swing(&self) -> Option<TablesSwing> {
        let [x, y] = self.vibration()?;
        let report = |name, (swings, unshaped)| VibrationReport::new(name, swings, unshaped);
        let [x_table, y_table] = TABLES;
        Some(TablesSwing {
            x: report(x_table, x),
            y: report(y_table, y),
        })
    }
}

impl Report {
    fn new(run: &Run) -> Self {
        let [steps_x, steps_y] = run.record.steps;
        let [closed_mm, open_mm] = run.closing_mm;
        let [closed_lost, open_lost] = run.lost;
        Self {
            stepping: run.settings.stepping.name(),
            steps_x,
            steps_y,
            end_steps: run.commanded,
            tolerance_mm: run.settings.tolerance_mm,
            smoothed_bound_mm: run.record.departure_mm,
            max_deviation_mm: run.record.closed.worst.deviation_mm,
            closing_error_mm: closed_mm,
            lost_steps: closed_lost,
            corrected_steps: run.record.corrected,
            duration_s: run.duration_s,
            open_loop: OpenLoop {
                max_deviation_mm: run.record.open.worst.deviation_mm,
                closing_error_mm: open_mm,
                lost_steps: open_lost,
            },
            motors: run.followed.clone(),
            at_feed: run.at_feed.clone(),
            slower_motions: slower_motions(run),
            max_axis_speed_mm_s: run.machine.max_speed_mm_s,
            lose_steps: run.settings.lose_steps,
            seed: run.settings.seed,
            shaped_bound_mm: run.record.shaped_mm,
            torque: run.torque_report(),
            vibration: run.tables_swing(),
            notes: Vec::new(),
        }
    }

    /// Whether the motors follow, as far as torque and inertia go.
    ///
    /// # Errors
    /// The steps that they lose.
    pub fn check(&self) -> Result<()> {
        let lost = self.motors.lost_steps();
        ensure!(
            lost == 0,
            "the motors lose {lost} steps: their torque does not allow this motion"
        );
        Ok(())
    }

    /// The same with notes on the program.
    #[must_use]
    pub fn with_notes(mut self, notes: Vec<String>) -> Self {
        self.notes = notes;
        self
    }
}

fn slower_motions(run: &Run) -> usize {
    let is_slower =
        |motion: &&Motion| axis_feed(motion, run.machine.max_speed_mm_s) < motion.feed_mm_s;
    match run.settings.stepping {
        Stepping::Timed => run.record.programmed.iter().filter(is_slower).count(),
        Stepping::AtFeed(_) => 0,
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Err(error) = self.check() {
            writeln!(f, "{error}")?;
        }
        writeln!(
            f,
            "{} + {} steps, {}, in {:.1} s",
            self.steps_x, self.steps_y, self.stepping, self.duration_s
        )?;
        writeln!(
            f,
            "closed loop: {} steps lost, {} corrected; {:.3} mm off the curve at most, {:.3} mm at the end",
            self.lost_steps, self.corrected_steps, self.max_deviation_mm, self.closing_error_mm
        )?;
        let open = &self.open_loop;
        writeln!(
            f,
            "open loop:   {} steps lost; {:.3} mm off the curve at most, {:.3} mm at the end",
            open.lost_steps, open.max_deviation_mm, open.closing_error_mm
        )?;
        let motors = |name: &str, followed: &FollowedAxes| {
            format!(
                "{name}: {:.1} s, at least {:.0} mm/s², {} steps lost by torque and inertia",
                followed.duration_s,
                followed.max_acceleration_mm_s2(),
                followed.lost_steps()
            )
        };
        writeln!(f, "{}", motors(self.stepping, &self.motors))?;
        if self.slower_motions > 0 {
            writeln!(
                f,
                "{} motions are slower than their feed: an axis goes {} mm/s at most",
                self.slower_motions, self.max_axis_speed_mm_s
            )?;
        }
        if self.stepping == Stepping::Timed.name() {
            writeln!(
                f,
                "lines left by {:.4} mm at most to pass their corners, {} mm are allowed",
                self.smoothed_bound_mm, self.tolerance_mm
            )?;
            writeln!(f, "{}", motors("at the feed throughout", &self.at_feed))?;
        }
        if let Some(mm) = self.shaped_bound_mm {
            writeln!(f, "shaped: off the path by {mm:.4} mm at most")?;
        }
        if let Some(torque) = &self.torque {
            writeln!(f, "torque: {torque}")?;
        }
        if let Some(TablesSwing { x, y }) = &self.vibration {
            writeln!(f, "vibration: {x}\nvibration: {y}")?;
        }
        Ok(())
    }
}
