//! The controller: steps of the path out, scales and switches in, the loop closed between them.

use anyhow::{Context, Result, bail};
use kurbo::Point;
use pulse_interp::{
    AxisLoop, Direction, Homing, HomingOrder, HomingSettings, LoopSettings, Move, ScaleRatio,
    StepIntervals,
};

use crate::motion::Motion;
use crate::motors::FollowedAxes;
use crate::paths::{self, PathRule, STEPS_PER_MM, to_mm};
use crate::record::Record;
use crate::run::Run;
use crate::speeds::{SpeedProfile, Units};
use crate::stage::{COUNTS_PER_STEP, SWITCHES, Stage};

/// A step's counts are more, a count or two of noise less.
const DEAD_BAND_COUNTS: u32 = 3;
/// 20 steps: what is farther off is no lost step.
const ALARM_COUNTS: u32 = 100;
/// Of the clock of all intervals.
pub(crate) const TICKS_PER_S: f64 = 1e6;
/// How often the end is looked at again while a correction may itself be lost.
const LOOKS_AT_END: u32 = 1000;

const AXES: [&str; 2] = ["X", "Y"];

/// When the steps of a chain of motions come.
pub(crate) enum Clock {
    /// Each motion at its feed.
    Constant,
    /// Ramps that begin at a tick.
    Ramps(Box<StepIntervals<Units>>, u64),
}

/// How the simulated stage is driven, and what it does wrong.
#[derive(Debug, Clone, Copy, Default)]
#[expect(clippy::exhaustive_structs, reason = "settings, set by their names")]
pub struct Settings {
    /// Which axis steps next.
    pub rule: PathRule,
    /// How the speed along the path changes.
    pub profile: SpeedProfile,
    /// The probability with which a step is lost, within 0..=1.
    pub lose_steps: f64,
    /// Which steps are lost.
    pub seed: u64,
}

/// Takes the steps of the path: microseconds from the start, and the step of each axis.
pub type StepObserver<'a> = &'a mut dyn FnMut(u64, [i32; 2]) -> Result<()>;

/// The closed loop over a simulated stage, and beside it a stage that gets the same pulses but for
/// the corrections.
pub(crate) struct Controller<'a> {
    settings: Settings,
    loops: [AxisLoop; 2],
    /// Where the path is, in steps from the drawing's zero.
    commanded: [i32; 2],
    stage: Stage,
    uncorrected: Stage,
    observer: StepObserver<'a>,
    ticks: u64,
    /// From the last step to the end of its ramp.
    rest_ticks: u64,
    record: Record,
    /// Of the last motion, in mm.
    end: Point,
}

impl core::fmt::Debug for Controller<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Controller")
            .field("settings", &self.settings)
            .field("commanded", &self.commanded)
            .field("stage", &self.stage)
            .finish_non_exhaustive()
    }
}

impl<'a> Controller<'a> {
    /// Homes both axes and goes to the drawing's zero.
    ///
    /// # Errors
    /// A switch is not found, or more steps are lost than the loop corrects.
    pub(crate) fn homed(settings: &Settings, observer: StepObserver<'a>) -> Result<Self> {
        let axis = AxisLoop::new(LoopSettings {
            ratio: ScaleRatio::new(COUNTS_PER_STEP, 1)?,
            dead_band_counts: DEAD_BAND_COUNTS,
            alarm_counts: ALARM_COUNTS,
        })?;
        let mut stage = Stage::new(settings.lose_steps, settings.seed);
        for (axis, name) in AXES.into_iter().enumerate() {
            home(&mut stage, axis).with_context(|| format!("homing {name}"))?;
        }
        stage.zero();
        let mut controller = Self {
            settings: *settings,
            loops: [axis; 2],
            commanded: SWITCHES.map(|[lower, _]| lower),
            uncorrected: stage.clone(),
            stage,
            observer,
            ticks: 0,
            rest_ticks: 0,
            record: Record::default(),
            end: Point::ORIGIN,
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
        self.record = Record::default();
        self.stage.forget_lost();
        self.uncorrected = self.stage.clone();
        Ok(())
    }

    /// Where the path is, in mm.
    pub(crate) fn commanded_mm(&self) -> Point {
        to_mm(self.commanded)
    }

    /// Where both stages really are.
    fn at_mm(&self) -> [Point; 2] {
        [self.stage.at_mm(), self.uncorrected.at_mm()]
    }

    /// Where the scales say that the stage is, in mm.
    pub(crate) fn scales_mm(&self) -> Point {
        let [[x_zero, _], [y_zero, _]] = SWITCHES;
        let [x, y] = self.stage.counts();
        let mm = |counts: i32, zero: i32| {
            let steps = f64::from(counts) / f64::from(COUNTS_PER_STEP);
            (steps + f64::from(zero)) / STEPS_PER_MM
        };
        Point::new(mm(x, x_zero), mm(y, y_zero))
    }

    /// Plans a chain of motions from rest to rest, from where the stage was last commanded to.
    ///
    /// # Errors
    /// There is no path of steps for one of them.
    pub(crate) fn plan<'m>(&self, motions: impl Iterator<Item = &'m Motion>) -> Result<Clock> {
        let start = self.ticks + self.rest_ticks;
        Clock::plan(&self.settings, (start, self.commanded), motions)
    }

    /// Makes a motion's steps; on an error the stage stands where it was last commanded to.
    ///
    /// # Errors
    /// A limit switch is closed, more steps are lost than the loop corrects, or the observer's.
    pub(crate) fn run(&mut self, motion: &Motion, clock: &mut Clock) -> Result<()> {
        self.record.begin(self.ticks, motion, self.at_mm());
        let run = self.make(motion, clock);
        self.end = match run {
            Ok(()) => motion.to,
            Err(_) => self.commanded_mm(),
        };
        run
    }

    /// A chain of one motion.
    ///
    /// # Errors
    /// As [`Self::plan`] and [`Self::run`].
    pub(crate) fn run_alone(&mut self, motion: &Motion) -> Result<()> {
        let mut clock = self.plan([motion].into_iter())?;
        self.run(motion, &mut clock)?;
        self.rest(clock);
        Ok(())
    }

    fn make(&mut self, motion: &Motion, clock: &mut Clock) -> Result<()> {
        let target = || format!("on the way to ({:.3}, {:.3}) mm", motion.to.x, motion.to.y);
        self.ticks += core::mem::take(&mut self.rest_ticks);
        for timed in clock.steps(motion, self.commanded, self.settings.rule)? {
            let (ticks, step) = timed?;
            self.ticks += ticks;
            self.step(step).with_context(target)?;
            let by = [step.dx(), step.dy()];
            (self.observer)(self.ticks, by)?;
            self.record.step(self.ticks, by, self.at_mm());
            self.correct().with_context(target)?;
        }
        Ok(())
    }

    /// The end of a chain: it takes the time that is left to come to rest before the next one.
    pub(crate) fn rest(&mut self, clock: Clock) {
        if let Clock::Ramps(intervals, start) = clock {
            let end = start + intervals.into_units().end_ticks();
            self.rest_ticks = end.saturating_sub(self.ticks);
        }
    }

    /// One step of the path, if no switch forbids it.
    fn step(&mut self, step: Move) -> Result<()> {
        let directions = [step.dx(), step.dy()].map(direction);
        // Both are asked before either moves.
        let asked = self.stage.switches().into_iter().zip(self.commanded);
        for (((switches, at), wanted), name) in asked.zip(directions).zip(AXES) {
            if let Some(direction) = wanted {
                switches.permit(direction, at).context(name)?;
            }
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
        let mut is_wrong = false;
        let read = self.stage.counts().into_iter().zip(AXES);
        for ((axis, scale), (counts, name)) in self.loops.iter_mut().enumerate().zip(read) {
            let steps = scale.correction(counts);
            let steps = steps.with_context(|| format!("{name}: steps lost"))?;
            let Some(direction) = direction(steps) else {
                continue;
            };
            for _ in 0..steps.abs() {
                self.stage.pulse(axis, direction);
            }
            self.record.correct(self.ticks, steps.unsigned_abs());
            is_wrong = true;
        }
        Ok(is_wrong)
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

    /// Settles at the end of the last motion.
    ///
    /// # Errors
    /// More steps are lost than the loop corrects.
    pub(crate) fn finish(mut self) -> Result<Run> {
        self.settle()?;
        self.record.end(self.ticks, self.at_mm());
        let motors = core::mem::take(&mut self.record.motors);
        let stages = [&self.stage, &self.uncorrected];
        Ok(Run {
            settings: self.settings,
            commanded: self.commanded,
            duration_s: seconds(self.ticks),
            closing_mm: stages.map(|stage| stage.at_mm().distance(self.end)),
            lost: stages.map(Stage::lost),
            followed: motors.finish(),
            constant: FollowedAxes::at_constant_speed(&self.record.programmed, self.settings.rule)?,
            record: self.record,
        })
    }
}

impl Clock {
    /// Plans a chain of motions from rest to rest, from a tick and a point on.
    ///
    /// # Errors
    /// There is no path of steps for one of them.
    pub(crate) fn plan<'m>(
        settings: &Settings,
        (start, mut from): (u64, [i32; 2]),
        motions: impl Iterator<Item = &'m Motion>,
    ) -> Result<Self> {
        if settings.profile == SpeedProfile::Constant {
            return Ok(Self::Constant);
        }
        let mut legs = Vec::new();
        for motion in motions {
            legs.push((motion, paths::length_q16(motion, from, settings.rule)?));
            from = paths::to_steps(motion.to);
        }
        let units = Units::plan(legs.into_iter())?;
        let intervals = Box::new(StepIntervals::from_units(units));
        Ok(Self::Ramps(intervals, start))
    }

    /// The steps of a motion of the chain, and the ticks before each.
    pub(crate) fn steps<'c>(
        &'c mut self,
        motion: &Motion,
        from: [i32; 2],
        rule: PathRule,
    ) -> Result<impl Iterator<Item = Result<(u64, Move)>> + 'c> {
        // Rates are bounded by the parser: 100 to 60 million ticks.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "bounded"
        )]
        let unit = (TICKS_PER_S / (motion.feed_mm_s * STEPS_PER_MM)).round() as u32;
        let mut constant = StepIntervals::new(unit);
        let steps = paths::paths(motion, from, rule)?.into_iter().flatten();
        Ok(steps.map(move |(step, factor)| {
            let ticks = match self {
                Self::Constant => constant.next(factor),
                Self::Ramps(intervals, _) => intervals.next(factor),
            };
            Ok((ticks.context("the path is longer than its plan")?, step))
        }))
    }
}

/// Ticks of the clock in seconds.
pub(crate) fn seconds(ticks: u64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "microseconds far below 2^52")]
    let ticks = ticks as f64;
    ticks / TICKS_PER_S
}

fn home(stage: &mut Stage, axis: usize) -> Result<()> {
    let mut homing = Homing::new(HomingSettings {
        direction: Direction::Negative,
        most_steps: 15_000,
        clear_steps: 50,
    });
    let closed = |stage: &Stage| stage.switches().get(axis).is_some_and(|it| it.lower);
    while let HomingOrder::Step { direction, .. } = homing.next(closed(stage))? {
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
