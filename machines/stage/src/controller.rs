//! The controller: steps of the path out, scales and switches in, the loop closed between them.

use anyhow::{Context, Error, Result, bail};
use kurbo::Point;
use path_timing::{Path as _, Row};
use pulse_interp::{
    AxisLoop, Direction, Homing, HomingOrder, HomingSettings, LoopSettings, ScaleRatio,
};

use crate::drive::Drive;
use crate::gcode::Program;
use crate::grid::{STEPS_PER_MM, seconds, to_mm};
use crate::machine::Machine;
use crate::motion::Motion;
use crate::motors::{FollowedAxes, Motors};
use crate::paths::{self, PathRule};
use crate::planned::Planned;
use crate::record::Record;
use crate::report::AXES;
use crate::run::Run;
use crate::settings::{Settings, Stepping};
use crate::stage::{COUNTS_PER_STEP, SWITCHES, Stage};
use crate::timed::ChainPath;
use crate::unshaped;

/// A step's counts are more, a count or two of noise less.
const DEAD_BAND_COUNTS: u32 = 3;
/// 20 steps: what is farther off is no lost step.
const ALARM_COUNTS: u32 = 100;
/// How often the end is looked at again while a correction may itself be lost.
const LOOKS_AT_END: u32 = 1000;

/// Takes the steps of the path: microseconds from the start, and the step of each axis.
pub type StepObserver<'a> = &'a mut dyn FnMut(u64, [i32; 2]) -> Result<()>;

/// Runs a program on a stage that has just been switched on.
///
/// # Errors
/// A limit switch is met or more steps are lost than the loop corrects, with the line of the
/// program; or the observer's.
pub fn run(
    machine: &Machine,
    program: &Program,
    settings: &Settings,
    observer: StepObserver<'_>,
) -> Result<Run> {
    let mut controller = Controller::homed(machine, settings, observer)?;
    let motions: Vec<_> = program.lines.iter().map(|line| line.motion).collect();
    controller
        .run(&motions)
        .map_err(|BrokenOff { motion, error }| {
            let number = program.lines.get(motion).map_or(0, |line| line.number);
            error.context(format!("line {number}"))
        })?;
    controller.finish()
}

/// The closed loop over a simulated stage, and beside it a stage that gets the same pulses but for
/// the corrections.
pub(crate) struct Controller<'a> {
    machine: Machine,
    settings: Settings,
    loops: [AxisLoop; 2],
    /// Where the path is, in steps from the drawing's zero.
    commanded: [i32; 2],
    stage: Stage,
    uncorrected: Stage,
    observer: StepObserver<'a>,
    ticks: u64,
    /// Of timed steps; none where another motion has come between, or one was broken off.
    drive: Option<Drive>,
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
    /// A setting out of its range; a switch is not found, or more steps are lost than the loop
    /// corrects.
    pub(crate) fn homed(
        machine: &Machine,
        settings: &Settings,
        observer: StepObserver<'a>,
    ) -> Result<Self> {
        settings.check()?;
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
            machine: *machine,
            settings: *settings,
            loops: [axis; 2],
            commanded: SWITCHES.map(|[lower, _]| lower),
            uncorrected: stage.clone(),
            stage,
            observer,
            ticks: 0,
            drive: None,
            record: Record::new(machine),
            end: Point::ORIGIN,
        };
        controller.leave_switches()?;
        Ok(controller)
    }

    /// From the switches to the drawing's zero: no step of the drawing.
    fn leave_switches(&mut self) -> Result<()> {
        while self.commanded != [0, 0] {
            self.step([1, 1])?;
            self.correct()?;
        }
        self.settle()?;
        self.record = Record::new(&self.machine);
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

    /// Makes the steps of a chain of motions, from rest to rest; on an error the stage stands where
    /// it was last commanded to.
    ///
    /// # Errors
    /// A limit switch is closed, more steps are lost than the loop corrects, or the observer's; and
    /// the motion on which that was.
    pub(crate) fn run(&mut self, motions: &[Motion]) -> Result<(), BrokenOff> {
        let mut chain = Chain {
            motions,
            current: None,
        };
        let run = match self.settings.stepping {
            Stepping::Timed => self.follow(&mut chain),
            Stepping::AtFeed(rule) => self.interpolate(&mut chain, rule),
        };
        match &run {
            Ok(()) => self
                .record
                .chains
                .iter_mut()
                .for_each(|it| it.push(motions.len())),
            Err(_) => self.record.chains = None,
        }
        self.end = match (&run, motions.last()) {
            (Ok(()), Some(last)) => last.to,
            _ => self.commanded_mm(),
        };
        run.map_err(|error| BrokenOff {
            motion: chain.current.unwrap_or(0),
            error,
        })
    }

    /// Along the curves of a chain, each axis by itself.
    fn follow(&mut self, chain: &mut Chain<'_>) -> Result<()> {
        let machine = self.machine;
        let path = ChainPath::new(&machine, chain.motions, self.settings.tolerance_mm)?;
        self.record.departure_mm = self.record.departure_mm.max(path.departure_mm);
        self.record.axes = path.limits.axes;
        // Put back when the chain has come to its end.
        let mut drive = match self.drive.take() {
            Some(drive) => drive,
            None => Drive::at_rest(self.ticks, self.commanded_mm(), machine.start_stop_mm_s)?,
        };
        drive.begin();
        let at = self.commanded_mm();
        self.record
            .row(drive.time_s(), [[at.x, at.y], [0.0; 2]], f64::INFINITY);
        if machine.is_known() {
            let planned = Planned::new(&machine, &path)?;
            self.record.planned(&machine, &planned, drive.time_s());
            let mut felt = planned.felt();
            for row in planned.rows.iter().skip(1) {
                let curve = path.curve(row);
                let motions = curve.map_or([0; 2], |curve| felt.motions(row, curve));
                self.follow_row(chain, &mut drive, (&path, row, motions))?;
            }
        } else {
            path.rows(|row| {
                let motions = path.curve(row).map_or([0; 2], |curve| curve.motions);
                self.follow_row(chain, &mut drive, (&path, row, motions))
            })?;
        }
        self.drive = Some(drive);
        self.begun(chain, chain.motions.len().saturating_sub(1));
        Ok(())
    }

    /// Up to a row on a path, between the first and the last of some motions.
    fn follow_row(
        &mut self,
        chain: &mut Chain<'_>,
        drive: &mut Drive,
        (path, row, [first, last]): (&ChainPath, &Row<[f64; 2]>, [usize; 2]),
    ) -> Result<()> {
        for (ticks, by) in drive.row(row)? {
            let mut next = self.begun(chain, first);
            while next < last && chain.is_past(next, self.commanded_mm()) {
                next = self.begun(chain, next + 1);
            }
            let near = chain.motions.get(first..=last).unwrap_or_default();
            self.made(chain, near, ticks, by)?;
        }
        let tool = path.curve(row).and_then(|curve| curve.tool());
        let feed_mm_s = tool.map_or(f64::INFINITY, |tool| tool.feed);
        let at = [row.position, row.velocity];
        self.record.row(drive.time_s(), at, feed_mm_s);
        Ok(())
    }

    /// Each motion at its feed, on the paths of an interpolator.
    fn interpolate(&mut self, chain: &mut Chain<'_>, rule: PathRule) -> Result<()> {
        for (number, motion) in chain.motions.iter().enumerate() {
            self.begun(chain, number);
            for timed in paths::at_feed(motion, self.commanded, rule)? {
                let (ticks, step) = timed?;
                let near = core::slice::from_ref(motion);
                self.made(chain, near, self.ticks + ticks, [step.dx(), step.dy()])?;
            }
        }
        Ok(())
    }

    /// Notes that all motions up to one have begun; the latest that has.
    fn begun(&mut self, chain: &mut Chain<'_>, number: usize) -> usize {
        loop {
            let next = chain.current.map_or(0, |current| current + 1);
            match chain.motions.get(next).filter(|_| next <= number) {
                Some(motion) => self.record.begin(self.ticks, motion, self.at_mm()),
                None => return next.saturating_sub(1),
            }
            chain.current = Some(next);
        }
    }

    /// A step at a tick on a curve along some motions, seen and corrected.
    fn made(&mut self, chain: &Chain<'_>, near: &[Motion], ticks: u64, by: [i32; 2]) -> Result<()> {
        let target = || chain.target();
        self.ticks = ticks;
        self.step(by).with_context(target)?;
        (self.observer)(self.ticks, by)?;
        self.record.step(self.ticks, by, self.at_mm(), near);
        self.correct().with_context(target)?;
        Ok(())
    }

    /// One step of the path, if no switch forbids it.
    fn step(&mut self, by: [i32; 2]) -> Result<()> {
        let directions = by.map(direction);
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
        let machine = self.machine;
        let motors = core::mem::replace(&mut self.record.motors, Motors::new(&machine));
        let stages = [&self.stage, &self.uncorrected];
        let rule = self.settings.stepping.path_rule();
        Ok(Run {
            machine,
            settings: self.settings,
            commanded: self.commanded,
            duration_s: seconds(self.ticks),
            closing_mm: stages.map(|stage| stage.at_mm().distance(self.end)),
            lost: stages.map(Stage::lost),
            followed: motors.finish(),
            at_feed: FollowedAxes::at_feed(&machine, &self.record.programmed, rule)?,
            unshaped: unshaped::vibration(&machine, &self.settings, &self.record)?,
            record: self.record,
        })
    }
}

/// A chain of motions, and how far it is.
struct Chain<'m> {
    motions: &'m [Motion],
    /// None before the first step.
    current: Option<usize>,
}

impl Chain<'_> {
    fn target(&self) -> String {
        let motion = self.motions.get(self.current.unwrap_or(0));
        let to = motion.map_or(Point::ORIGIN, |motion| motion.to);
        format!("on the way to ({:.3}, {:.3}) mm", to.x, to.y)
    }

    /// Whether a place is nearer to the next motion than to this one.
    fn is_past(&self, number: usize, at: Point) -> bool {
        let distance_mm = |number: usize| Some(self.motions.get(number)?.distance_mm(at));
        distance_mm(number + 1) < distance_mm(number)
    }
}

/// Where a chain of motions was broken off, and why.
#[derive(Debug)]
pub(crate) struct BrokenOff {
    /// From 0.
    pub(crate) motion: usize,
    pub(crate) error: Error,
}

fn home(stage: &mut Stage, axis: usize) -> Result<()> {
    let mut homing = Homing::new(HomingSettings {
        direction: Direction::Negative,
        max_steps: 15_000,
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
