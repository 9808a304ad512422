//! The planner: jobs to rows, rows to steps.

use core::fmt::Display;

use path_timing::{
    Curve, FeedCeiling, Knot, PathFn, PathPoint, PlanError, Playback, Row, Table, ToolLimits,
};
use pvt_steps::{PvtQuantiser, PvtSteps};
use scara_kin::{ArmPath, ArmPathError, ArmPathF32, Joints};
use trig_kernels::sqrt;

use crate::blocks::BlockWriter;
use crate::command::{Job, Joint};
use crate::homing::{NoHome, home};
use crate::panel::{Panel, State, Wanted};
use crate::reason::Reason;
use crate::settings::{Machine, SettingsError};
use crate::{Text, text};

/// Memory for tables, in rows: of all attempts at a line.
const ROWS: usize = 100;
/// Segments of a jog.
const JOG_SEGMENTS: u32 = 12;
/// Segments of a line: so many, and others for what the joints turn, shoulder and elbow added up. At a
/// constant feed a third of them would do; where a hold ends, the joints go straight from row to row.
const LEAST_SEGMENTS: f64 = 6.0;
const SEGMENTS_PER_RAD: f64 = 6.0;
/// Places between which the joints are looked at for what they turn.
const LOOKS: u32 = 4;
/// More than what the fourth power says, for an attempt that is to be the last.
const FINER: f64 = 1.15;
/// Farthest that a line may begin from the joints, in radians: rounding.
const START_TOLERANCE: f64 = 1e-6;

/// The planner of a machine: takes jobs from a panel, and puts blocks on it.
pub struct Motion<'m> {
    machine: &'m Machine,
    panel: &'m Panel,
    axes: Axes<'m>,
    memory: &'m mut PlanMemory,
}

/// Memory for the table of a motion: apart from [`Motion`], too large for a stack.
#[derive(Clone, Debug)]
pub struct PlanMemory {
    knots: [Knot<[f64; 2]>; ROWS],
    ceilings: [FeedCeiling; ROWS],
}

impl PlanMemory {
    /// Memory that nothing is in yet.
    #[must_use]
    pub fn new() -> Self {
        Self {
            knots: [Knot::default(); _],
            ceilings: [FeedCeiling::default(); _],
        }
    }
}

impl Default for PlanMemory {
    fn default() -> Self {
        Self::new()
    }
}

/// Where the joints are, and the way from there to the pins.
struct Axes<'m> {
    writer: BlockWriter<'m>,
    quantiser: PvtQuantiser<2>,
    steps: PvtSteps<2>,
    /// At the end of the last row: radians, and seconds since the machine was homed.
    joints: [f64; 2],
    time_s: f64,
}

/// How a motion ended.
enum End {
    Done,
    Stopped,
}

/// Why a motion did not end.
enum Failure {
    /// Nothing has moved.
    Refused(Text),
    /// In the middle, at speed.
    Failed(Text),
}

fn refused(reason: impl Display) -> Failure {
    Failure::Refused(text!("refused: {reason}"))
}

fn failed(reason: impl Display) -> Failure {
    Failure::Failed(text!("failed, home again: {reason}"))
}

impl<'m> Axes<'m> {
    /// At rest at home.
    fn home(machine: &Machine, writer: BlockWriter<'m>) -> Result<Self, SettingsError> {
        let quantiser = PvtQuantiser::new(machine.rate, machine.scales, machine.home)?;
        Ok(Self {
            writer,
            steps: PvtSteps::new(quantiser.knots(), machine.pins.min_intervals()),
            quantiser,
            joints: machine.home,
            time_s: 0.0,
        })
    }

    /// The steps of a row of a motion that began at `start_s`.
    async fn follow(&mut self, start_s: f64, row: &Row<[f64; 2]>) -> Result<(), Failure> {
        if row.duration_s == 0.0 {
            return Ok(());
        }
        let time_s = start_s + row.time_s;
        let pvt = self.quantiser.row(time_s, row.position, row.velocity);
        self.steps.push(&pvt.map_err(failed)?).map_err(failed)?;
        (self.joints, self.time_s) = (row.position, time_s);
        for step in &mut self.steps {
            self.writer
                .step(step.axis, step.ticks, step.direction)
                .await;
        }
        Ok(())
    }

    async fn rest(&mut self) {
        self.writer.rest(self.steps.end_ticks()).await;
    }
}

impl<'m> Motion<'m> {
    /// A machine that is not homed.
    ///
    /// # Errors
    /// [`SettingsError`]: home is past 2^31 steps.
    pub fn new(
        machine: &'m Machine,
        panel: &'m Panel,
        memory: &'m mut PlanMemory,
    ) -> Result<Self, SettingsError> {
        Ok(Self {
            machine,
            panel,
            axes: Axes::home(machine, BlockWriter::new(machine, panel))?,
            memory,
        })
    }

    /// Takes one job after the other. `closed` says which home switches are.
    pub async fn run(mut self, mut closed: impl FnMut() -> [bool; 2]) -> ! {
        loop {
            match self.panel.next_job().await {
                Job::Home => self.home(&mut closed).await,
                Job::Line { to_mm, feed_mm_s } => {
                    let result = self.line(to_mm, feed_mm_s).await;
                    self.finish(result).await;
                }
                Job::Jog { joint, by_deg } => {
                    let result = self.jog(joint, by_deg).await;
                    self.finish(result).await;
                }
            }
        }
    }

    async fn home(&mut self, closed: &mut impl FnMut() -> [bool; 2]) {
        let (machine, panel) = (self.machine, self.panel);
        let found = home(machine, panel, &mut self.axes.writer, closed).await;
        let (state, answer) = match found {
            Ok(()) => match self.axes.set_home(machine) {
                Ok(()) => (
                    State::Ready,
                    text!("done, {}", machine.place(panel.steps())),
                ),
                Err(error) => (State::NotHomed, text!("failed: {error}")),
            },
            Err(NoHome::Stopped) => (State::NotHomed, text!("stopped, not homed")),
            Err(NoHome::Switch { joint, error }) => {
                let name = Joint::ALL[joint];
                (State::NotHomed, text!("failed: {name}: {error}"))
            }
        };
        panel.set_state(state);
        panel.answer(answer);
    }

    async fn line(&mut self, to_mm: [f64; 2], feed_mm_s: Option<f64>) -> Result<End, Failure> {
        let machine = self.machine;
        let [shoulder, elbow] = self.axes.joints;
        let joints = Joints::new(shoulder, elbow);
        let from = machine.arm.forward(joints);
        let mut line = Curve::line([from.x, from.y], to_mm).map_err(refused)?;
        if let Some(feed) = feed_mm_s {
            line = line.with_tool(ToolLimits {
                feed,
                acceleration: None,
            });
        }
        let path = machine.arm.path_from(line, machine.elbow, joints);
        let path = path.map_err(|error| refused(Reason(error)))?;
        let start = path.joints(0.0);
        let start = start.map_err(|error| refused(Reason(error)))?;
        if (start - joints).amax() > START_TOLERANCE {
            return Err(refused("the elbow is on the other side, jog it over"));
        }
        let segments = LEAST_SEGMENTS + SEGMENTS_PER_RAD * turned(&path);
        let path = path.in_f32().map_err(refused)?;
        let table = plan(machine, &path, segments, &mut self.memory.knots);
        let (table, departure) = table.map_err(refused)?;
        let playback = table
            .playback(1.0, &mut self.memory.ceilings)
            .map_err(refused)?;
        self.panel.answer(text!(
            "ok, {:.3} mm in {:.3} s, within {departure:.4} mm",
            line.length(),
            table.duration_s()
        ));
        self.axes.run(machine, self.panel, playback).await
    }

    async fn jog(&mut self, joint: Joint, by_deg: f64) -> Result<End, Failure> {
        let machine = self.machine;
        let from = self.axes.joints;
        let by = by_deg.to_radians();
        let axis = joint as usize;
        let (to, range) = (from[axis] + by, machine.ranges()[axis]);
        if !range.contains(to) {
            return Err(refused(format_args!(
                "{joint} at {:.3} degrees, not within {:.3} to {:.3}",
                to.to_degrees(),
                range.min().to_degrees(),
                range.max().to_degrees()
            )));
        }
        let mut slope = [0.0; 2];
        slope[axis] = by.signum();
        let path = PathFn::new(by.abs(), move |s| {
            let position = [from[0] + slope[0] * s, from[1] + slope[1] * s];
            Ok::<_, core::convert::Infallible>(PathPoint { position, slope })
        });
        let table = Table::plan_in_f32(
            [path],
            machine.limits,
            |_| JOG_SEGMENTS,
            &mut self.memory.knots,
        );
        let table = table.map_err(refused)?;
        let playback = table
            .playback(1.0, &mut self.memory.ceilings)
            .map_err(refused)?;
        self.panel
            .answer(text!("ok, in {:.3} s", table.duration_s()));
        self.axes.run(machine, self.panel, playback).await
    }

    /// Says how a motion ended.
    async fn finish(&mut self, result: Result<End, Failure>) {
        self.axes.rest().await;
        self.panel.all_played().await;
        let place = self.machine.place(self.panel.steps());
        let (state, answer) = match result {
            Ok(End::Done) => (State::Ready, text!("done, {place}")),
            Ok(End::Stopped) => (State::Ready, text!("stopped, {place}")),
            Err(Failure::Refused(reason)) => (State::Ready, reason),
            Err(Failure::Failed(reason)) => (State::NotHomed, reason),
        };
        self.panel.set_state(state);
        self.panel.answer(answer);
    }
}

/// Why there is no table of a line.
#[derive(Debug, thiserror::Error)]
enum NoTable {
    #[error("{}", Reason(*.0))]
    Plan(#[from] PlanError<ArmPathError>),
    #[error("the tool would leave the line by up to {departure:.3} mm, {allowed:.3} are allowed")]
    Departs { departure: f64, allowed: f64 },
}

/// The table of a line with its largest departure, within the tolerance: in about so many segments.
fn plan<'k>(
    machine: &Machine,
    path: &ArmPathF32,
    mut segments: f64,
    mut free: &'k mut [Knot<[f64; 2]>],
) -> Result<(Table<'k, [f64; 2]>, f64), NoTable> {
    let allowed = machine.tolerance_mm;
    loop {
        let rows = (segments as usize + 1).min(free.len());
        let (own, rest) = free.split_at_mut(rows);
        let count = rows as u32 - 1;
        let table = Table::plan_in_f32([path], machine.limits, |_| count, own)?;
        let departures = table.spans().map(|span| path.departure(&span));
        let departure = departures.fold(0.0, f64::max);
        if departure <= allowed {
            return Ok((table, departure));
        }
        // It falls with the fourth power of the number of segments.
        segments = f64::from(count) * sqrt(sqrt(departure / allowed)) * FINER + 1.0;
        if rest.len() <= rows {
            return Err(NoTable::Departs { departure, allowed });
        }
        free = rest;
    }
}

/// By how much the joints turn along a path, in radians, as some places tell.
fn turned(path: &ArmPath) -> f64 {
    let step = path.curve().length() / f64::from(LOOKS);
    let places = (0..=LOOKS).filter_map(|look| path.joints(f64::from(look) * step).ok());
    let turns = places.clone().zip(places.skip(1)).map(|(from, to)| {
        let turn = to - from;
        turn.x.abs() + turn.y.abs()
    });
    turns.sum()
}

impl Axes<'_> {
    /// Here is home.
    fn set_home(&mut self, machine: &Machine) -> Result<(), SettingsError> {
        let quantiser = PvtQuantiser::new(machine.rate, machine.scales, machine.home)?;
        self.steps = PvtSteps::new(quantiser.knots(), machine.pins.min_intervals());
        self.quantiser = quantiser;
        (self.joints, self.time_s) = (machine.home, 0.0);
        self.writer.restart(0);
        self.writer
            .set_steps(self.steps.steps().map(|steps| steps as i32));
        Ok(())
    }

    /// Runs a table to its end, or to where the user stops it.
    async fn run(
        &mut self,
        machine: &Machine,
        panel: &Panel,
        mut playback: Playback<'_, [f64; 2]>,
    ) -> Result<End, Failure> {
        let start_s = self.time_s;
        loop {
            let (wanted, feed_percent) = panel.wanted();
            match wanted {
                Wanted::Run => playback
                    .set_feed(f64::from(feed_percent) / 100.0)
                    .map_err(failed)?,
                Wanted::Hold | Wanted::Stop => playback.stop(),
            }
            if let Some(row) = playback.next_row() {
                self.follow(start_s, &row).await?;
                continue;
            }
            if playback.is_finished() {
                return Ok(End::Done);
            }
            self.rest().await;
            panel.all_played().await;
            match wanted {
                Wanted::Run => {}
                Wanted::Stop => return Ok(End::Stopped),
                Wanted::Hold => {
                    panel.set_state(State::Held);
                    panel.answer(text!("held, {}", machine.place(panel.steps())));
                    while panel.wanted().0 == Wanted::Hold {
                        panel.changed().await;
                    }
                    panel.set_state(State::Moving);
                }
            }
        }
    }
}
