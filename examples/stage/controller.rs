//! The controller: steps of the path out, scales and switches in, the loop closed between them.

use std::fs::File;
use std::io::{BufWriter, Write as _};

use anyhow::{Context, Result, bail};
use kurbo::Point;
use pose2pulse::pulse_interp::{
    AxisLoop, Direction, Homing, HomingOrder, HomingSettings, LoopSettings, Move, Pace, ScaleRatio,
};

use crate::geometry::Motion;
use crate::plan::{self, PathRule, STEPS_PER_MM, to_mm};
use crate::report::{OpenLoop, Report};
use crate::simulation::{COUNTS_PER_STEP, SWITCHES, Stage};

/// A step's counts are more, a count or two of noise less.
const DEAD_BAND_COUNTS: u32 = 3;
/// 20 steps: what is further off is no lost step.
const ALARM_COUNTS: u32 = 100;
/// Of the clock of all intervals.
const TICKS_PER_S: f64 = 1e6;
/// How often the end is looked at again while a correction may itself be lost.
const LOOKS_AT_END: u32 = 1000;
/// The step from one point of the picture to the next.
const PICTURE_MM: f64 = 0.05;

/// From one point of the chart to the next.
const CHART_S: f64 = 0.1;

const AXES: [&str; 2] = ["X", "Y"];

/// What the observers saw.
pub(crate) struct Run {
    pub(crate) report: Report,
    pub(crate) programmed: Vec<Motion>,
    pub(crate) closed: Vec<Point>,
    pub(crate) open: Vec<Point>,
    pub(crate) corrections: Vec<Point>,
    pub(crate) errors: Vec<Errors>,
}

/// How far the stages are from where they were commanded to, at worst since the last of these.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Errors {
    pub(crate) t_s: f64,
    pub(crate) closed_mm: f64,
    pub(crate) open_mm: f64,
}

pub(crate) struct Controller {
    rule: PathRule,
    loops: [AxisLoop; 2],
    /// Where the path is, in steps from the drawing's zero.
    commanded: [i32; 2],
    stage: Stage,
    /// A stage that gets the same pulses, but for the corrections.
    uncorrected: Stage,
    csv: BufWriter<File>,
    ticks: u64,
    steps: [u64; 2],
    corrected: u64,
    deviation_mm: f64,
    open_deviation_mm: f64,
    run_closed: Vec<Point>,
    run_open: Vec<Point>,
    corrections: Vec<Point>,
    errors: Vec<Errors>,
    worst: Errors,
    programmed: Vec<Motion>,
    /// Of the last motion, in mm.
    end: Point,
    lose: f64,
    seed: u64,
}

impl Controller {
    /// Homes both axes and goes to the drawing's zero.
    pub(crate) fn homed(
        lose: f64,
        seed: u64,
        rule: PathRule,
        mut csv: BufWriter<File>,
    ) -> Result<Self> {
        let axis = AxisLoop::new(LoopSettings {
            ratio: ScaleRatio::new(COUNTS_PER_STEP, 1)?,
            dead_band_counts: DEAD_BAND_COUNTS,
            alarm_counts: ALARM_COUNTS,
        })?;
        let mut stage = Stage::new(lose, seed);
        for axis in 0..2 {
            home(&mut stage, axis).with_context(|| format!("homing {}", name(axis)))?;
        }
        stage.zero();
        writeln!(csv, "t_s,dx,dy")?;
        let mut controller = Self {
            rule,
            loops: [axis; 2],
            commanded: SWITCHES.map(|[lower, _]| lower),
            uncorrected: stage.clone(),
            stage,
            csv,
            ticks: 0,
            steps: [0; 2],
            corrected: 0,
            deviation_mm: 0.0,
            open_deviation_mm: 0.0,
            run_closed: Vec::new(),
            run_open: Vec::new(),
            corrections: Vec::new(),
            errors: Vec::new(),
            worst: Errors::default(),
            programmed: Vec::new(),
            end: Point::ORIGIN,
            lose,
            seed,
        };
        controller.leave_switches()?;
        Ok(controller)
    }

    /// From the switches to the drawing's zero: no step of the drawing.
    fn leave_switches(&mut self) -> Result<()> {
        while self.commanded != [0, 0] {
            self.step(Move::UpRight)?;
            self.correct()?;
        }
        self.settle()?;
        self.corrected = 0;
        self.corrections.clear();
        self.stage.forget_lost();
        self.uncorrected = self.stage.clone();
        self.run_closed.push(self.stage.at_mm());
        self.run_open.push(self.stage.at_mm());
        Ok(())
    }

    /// Where the path is, in mm.
    pub(crate) fn commanded_mm(&self) -> Point {
        to_mm(self.commanded)
    }

    /// Where the scales say that the stage is, in mm.
    pub(crate) fn scales_mm(&self) -> Point {
        let mm = |axis: usize, zero: i32| {
            let counts = f64::from(self.stage.counts(axis)) / f64::from(COUNTS_PER_STEP);
            (counts + f64::from(zero)) / STEPS_PER_MM
        };
        let [[x, _], [y, _]] = SWITCHES;
        Point::new(mm(0, x), mm(1, y))
    }

    /// Makes a motion's steps; on an error the stage stands where it was last commanded to.
    pub(crate) fn run(&mut self, motion: &Motion) -> Result<()> {
        self.programmed.push(*motion);
        let run = self.make(motion);
        self.end = match run {
            Ok(()) => motion.to,
            Err(_) => self.commanded_mm(),
        };
        run
    }

    fn make(&mut self, motion: &Motion) -> Result<()> {
        // Rates are bounded by the parser: 100 to 60 million ticks.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "bounded"
        )]
        let unit = (TICKS_PER_S / (motion.feed_mm_s * STEPS_PER_MM)).round() as u32;
        let mut pace = Pace::new(unit);
        for path in plan::paths(motion, self.commanded, self.rule)? {
            for (step, factor) in path {
                self.ticks += pace.interval(factor);
                self.step(step).with_context(|| target(motion))?;
                self.log(step)?;
                self.observe(motion);
                self.correct().with_context(|| target(motion))?;
            }
        }
        Ok(())
    }

    /// One step of the path, if no switch forbids it.
    fn step(&mut self, step: Move) -> Result<()> {
        let directions = [step.dx(), step.dy()].map(direction);
        // Both are asked before either moves.
        for (axis, wanted) in directions.into_iter().enumerate() {
            let (Some(direction), Some(at)) = (wanted, self.commanded.get(axis)) else {
                continue;
            };
            let permit = self.stage.switches(axis).permit(direction, *at);
            permit.with_context(|| name(axis))?;
        }
        for (axis, wanted) in directions.into_iter().enumerate() {
            let Some(direction) = wanted else { continue };
            self.stage.pulse(axis, direction);
            self.uncorrected.pulse(axis, direction);
            if let (Some(at), Some(axis)) = (self.commanded.get_mut(axis), self.loops.get_mut(axis))
            {
                *at += direction.sign();
                axis.command(direction);
            }
        }
        Ok(())
    }

    /// One look at the scales; whether anything was wrong.
    fn correct(&mut self) -> Result<bool> {
        let mut wrong = false;
        for (axis, scale) in self.loops.iter_mut().enumerate() {
            let correction = scale.correction(self.stage.counts(axis));
            let steps = correction.with_context(|| format!("{}: steps lost", name(axis)))?;
            let Some(direction) = direction(steps) else {
                continue;
            };
            for _ in 0..steps.abs() {
                self.stage.pulse(axis, direction);
            }
            self.corrected += u64::from(steps.unsigned_abs());
            wrong = true;
        }
        if wrong {
            self.corrections.push(self.stage.at_mm());
        }
        Ok(wrong)
    }

    /// Looks until nothing is wrong.
    fn settle(&mut self) -> Result<()> {
        for _ in 0..LOOKS_AT_END {
            if !self.correct()? {
                return Ok(());
            }
        }
        bail!("still off after {LOOKS_AT_END} corrections at the end")
    }

    fn log(&mut self, step: Move) -> Result<()> {
        for (made, by) in self.steps.iter_mut().zip([step.dx(), step.dy()]) {
            *made += u64::from(by.unsigned_abs());
        }
        let (s, us) = (self.ticks / 1_000_000, self.ticks % 1_000_000);
        Ok(writeln!(
            self.csv,
            "{s}.{us:06},{},{}",
            step.dx(),
            step.dy()
        )?)
    }

    fn observe(&mut self, motion: &Motion) {
        let (at, open) = (self.stage.at_mm(), self.uncorrected.at_mm());
        self.deviation_mm = self.deviation_mm.max(motion.distance_mm(at));
        self.open_deviation_mm = self.open_deviation_mm.max(motion.distance_mm(open));
        follow(&mut self.run_closed, at);
        follow(&mut self.run_open, open);

        let commanded = self.commanded_mm();
        self.worst = Errors {
            t_s: self.seconds(),
            closed_mm: self.worst.closed_mm.max(at.distance(commanded)),
            open_mm: self.worst.open_mm.max(open.distance(commanded)),
        };
        let last_s = self
            .errors
            .last()
            .map_or(f64::NEG_INFINITY, |last| last.t_s);
        if self.worst.t_s >= last_s + CHART_S {
            self.errors.push(core::mem::take(&mut self.worst));
        }
    }

    fn seconds(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "microseconds far below 2^52")]
        let ticks = self.ticks as f64;
        ticks / TICKS_PER_S
    }

    /// Settles at the end of the last motion; `notes` are what the program asked for in vain.
    pub(crate) fn finish(mut self, notes: Vec<String>) -> Result<Run> {
        self.settle()?;
        self.csv.flush()?;
        let (at, open) = (self.stage.at_mm(), self.uncorrected.at_mm());
        self.run_closed.push(at);
        self.run_open.push(open);
        let [steps_x, steps_y] = self.steps;
        Ok(Run {
            report: Report {
                rule: self.rule.name(),
                steps_x,
                steps_y,
                end_steps: self.commanded,
                max_deviation_mm: self.deviation_mm,
                closing_error_mm: at.distance(self.end),
                lost_steps: self.stage.lost(),
                corrected_steps: self.corrected,
                duration_s: self.seconds(),
                open_loop: OpenLoop {
                    max_deviation_mm: self.open_deviation_mm,
                    closing_error_mm: open.distance(self.end),
                    lost_steps: self.uncorrected.lost(),
                },
                lose_steps: self.lose,
                seed: self.seed,
                notes,
            },
            programmed: self.programmed,
            closed: self.run_closed,
            open: self.run_open,
            corrections: self.corrections,
            errors: self.errors,
        })
    }
}

/// The next point of a drawn path, where it is far enough from the last.
fn follow(path: &mut Vec<Point>, at: Point) {
    if path
        .last()
        .is_none_or(|last| last.distance(at) >= PICTURE_MM)
    {
        path.push(at);
    }
}

fn home(stage: &mut Stage, axis: usize) -> Result<()> {
    let mut homing = Homing::new(HomingSettings {
        direction: Direction::Negative,
        most_steps: 15_000,
        clear_steps: 50,
    });
    while let HomingOrder::Step { direction, .. } = homing.next(stage.switches(axis).lower)? {
        stage.pulse(axis, direction);
    }
    Ok(())
}

const fn direction(steps: i32) -> Option<Direction> {
    match steps {
        0 => None,
        1.. => Some(Direction::Positive),
        _ => Some(Direction::Negative),
    }
}

fn name(axis: usize) -> &'static str {
    AXES.get(axis).copied().unwrap_or("?")
}

fn target(motion: &Motion) -> String {
    format!("on the way to ({:.3}, {:.3}) mm", motion.to.x, motion.to.y)
}
