//! The planner: jobs to rows, rows to steps.

use core::fmt::Display;

use path_timing::{
    Curve, FeedCeiling, Knot, Path, PathFn, PathPoint, PlanError, Playback, Row, Table, ToolLimits,
};
use pvt_steps::{PvtQuantiser, PvtSteps};
use trig_kernels::sqrt;

use crate::arcs::arc;
use crate::blocks::BlockWriter;
use crate::command::{Job, Turn};
use crate::homing::{NoHome, home};
use crate::inputs::Inputs;
use crate::kinematics::{Kinematics, Reason, Reasoned};
use crate::loops::Loops;
use crate::panel::{Panel, State, Wanted};
use crate::settings::Machine;
use crate::settings_error::SettingsError;
use crate::{Text, text};

/// Memory for tables, in rows: of all attempts at a line.
const ROWS: usize = 100;
/// Segments of a jog.
const JOG_SEGMENTS: u32 = 12;
/// More than what the fourth power says, for an attempt that is to be the last.
const FINER: f64 = 1.15;
/// The planner of a machine: takes jobs from a panel, and puts blocks on it.
pub struct Motion<'m, K, I, const N: usize> {
    machine: &'m Machine<K, N>,
    panel: &'m Panel<N>,
    inputs: &'m I,
    axes: Axes<'m, I, N>,
    memory: &'m mut PlanMemory<N>,
}

/// Memory for the table of a motion: apart from [`Motion`], too large for a stack.
#[derive(Clone, Debug)]
pub struct PlanMemory<const N: usize> {
    knots: [Knot<[f64; N]>; ROWS],
    ceilings: [FeedCeiling; ROWS],
}

impl<const N: usize> PlanMemory<N> {
    /// Memory that nothing is in yet.
    #[must_use]
    pub fn new() -> Self {
        Self {
            knots: [Knot::default(); _],
            ceilings: [FeedCeiling::default(); _],
        }
    }
}

impl<const N: usize> Default for PlanMemory<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// Where the axes are, and the way from there to the pins.
struct Axes<'m, I, const N: usize> {
    writer: BlockWriter<'m, N>,
    quantiser: PvtQuantiser<N>,
    steps: PvtSteps<N>,
    loops: Loops<'m, I, N>,
    /// At the end of the last row: radians or mm, and seconds since the machine was homed.
    position: [f64; N],
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

impl<'m, I: Inputs<N>, const N: usize> Axes<'m, I, N> {
    /// At rest at home.
    fn home<K>(
        machine: &Machine<K, N>,
        panel: &'m Panel<N>,
        inputs: &'m I,
    ) -> Result<Self, SettingsError> {
        let quantiser = PvtQuantiser::new(machine.rate, machine.scales, machine.home)?;
        Ok(Self {
            writer: BlockWriter::new(machine, panel),
            steps: PvtSteps::new(quantiser.knots(), machine.pins.min_intervals()),
            quantiser,
            loops: Loops::new(machine, panel, inputs),
            position: machine.home,
            time_s: 0.0,
        })
    }

    /// The steps of a row of a motion that began at `start_s`.
    async fn follow(&mut self, start_s: f64, row: &Row<[f64; N]>) -> Result<(), Failure> {
        if row.duration_s == 0.0 {
            return Ok(());
        }
        let time_s = start_s + row.time_s;
        let pvt = self.quantiser.row(time_s, row.position, row.velocity);
        self.steps.push(&pvt.map_err(failed)?).map_err(failed)?;
        (self.position, self.time_s) = (row.position, time_s);
        for step in &mut self.steps {
            self.writer
                .step(step.axis, step.ticks, step.direction)
                .await;
        }
        Ok(())
    }

    /// Until the pins have made all steps.
    async fn rest(&mut self, panel: &Panel<N>) {
        self.writer.rest(self.steps.end_ticks()).await;
        panel.all_played().await;
    }
}

impl<'m, K: Kinematics<N>, I: Inputs<N>, const N: usize> Motion<'m, K, I, N> {
    /// A machine that is not homed.
    ///
    /// # Errors
    /// [`SettingsError`]: home is past 2^31 steps.
    pub fn new(
        machine: &'m Machine<K, N>,
        panel: &'m Panel<N>,
        inputs: &'m I,
        memory: &'m mut PlanMemory<N>,
    ) -> Result<Self, SettingsError> {
        Ok(Self {
            machine,
            panel,
            inputs,
            axes: Axes::home(machine, panel, inputs)?,
            memory,
        })
    }

    /// Takes one job after the other.
    pub async fn run(mut self) -> ! {
        loop {
            let result = match self.panel.next_job().await {
                Job::Home => {
                    self.home().await;
                    continue;
                }
                Job::Line { to_mm, feed_mm_s } => self.line(to_mm, feed_mm_s).await,
                Job::Arc {
                    turn,
                    to_mm,
                    centre_mm,
                    feed_mm_s,
                } if K::HAS_ARCS => self.arc(turn, to_mm, centre_mm, feed_mm_s).await,
                // No telegram says so.
                Job::Arc { .. } => Err(refused("no arcs")),
                Job::Jog { axis, by } => self.jog(axis, by).await,
            };
            self.finish(result).await;
        }
    }

    async fn home(&mut self) {
        let (machine, panel) = (self.machine, self.panel);
        let found = home(machine, panel, self.inputs, &mut self.axes.writer).await;
        let (state, answer) = match found {
            Ok(()) => match self.axes.set_home(machine).await {
                Ok(()) => (
                    State::Ready,
                    text!("done, {}", machine.place(panel.steps())),
                ),
                Err(error) => (State::NotHomed, text!("failed: {error}")),
            },
            Err(NoHome::Stopped) => (State::NotHomed, text!("stopped, not homed")),
            Err(NoHome::Switch { axis, error }) => {
                let name = K::AXES[axis];
                (State::NotHomed, text!("failed: {name}: {error}"))
            }
        };
        panel.set_state(state);
        panel.answer(answer);
    }

    /// Where the planner is, in mm.
    fn tool(&self) -> Result<[f64; N], K::NoPlace> {
        self.machine.kinematics.tool_mm(self.axes.position)
    }

    async fn line(&mut self, to_mm: [f64; N], feed_mm_s: Option<f64>) -> Result<End, Failure> {
        let from = self.tool().map_err(refused)?;
        let line = Curve::line(from, to_mm).map_err(refused)?;
        self.curve(line, feed_mm_s).await
    }

    async fn arc(
        &mut self,
        turn: Turn,
        to_mm: [f64; N],
        centre_mm: [f64; 2],
        feed_mm_s: Option<f64>,
    ) -> Result<End, Failure> {
        let from = self.tool().map_err(refused)?;
        let arc = arc(turn, from, to_mm, centre_mm, self.machine.tolerance_mm);
        self.curve(arc.map_err(refused)?, feed_mm_s).await
    }

    async fn curve(&mut self, mut curve: Curve<N>, feed_mm_s: Option<f64>) -> Result<End, Failure> {
        let machine = self.machine;
        if let Some(feed) = feed_mm_s {
            curve = curve.with_tool(ToolLimits {
                feed,
                acceleration: None,
            });
        }
        let kinematics = &machine.kinematics;
        let path = kinematics.path(curve, self.axes.position, &machine.limits);
        let (path, segments) = path.map_err(refused)?;
        let table = plan(machine, &path, segments, &mut self.memory.knots);
        let (table, departure) = table.map_err(refused)?;
        let playback = table
            .playback(1.0, &mut self.memory.ceilings)
            .map_err(refused)?;
        self.panel.answer(text!(
            "ok, {:.3} mm in {:.3} s, within {departure:.4} mm",
            path.length(),
            table.duration_s()
        ));
        self.axes.run(machine, self.panel, playback).await
    }

    async fn jog(&mut self, axis: usize, by: f64) -> Result<End, Failure> {
        let machine = self.machine;
        let unit = Machine::<K, N>::UNIT;
        let from = self.axes.position;
        let by = unit.computed(by);
        let (to, [min, max]) = (from[axis] + by, machine.ranges[axis]);
        if !(min..=max).contains(&to) {
            let [to, min, max] = [to, min, max].map(|value| unit.shown(value));
            return Err(refused(format_args!(
                "{} at {to:.3} {}, not within {min:.3} to {max:.3}",
                K::AXES[axis],
                unit.name()
            )));
        }
        let mut slope = [0.0; N];
        slope[axis] = by.signum();
        let path = PathFn::new(by.abs(), move |s| {
            let mut position = from;
            position[axis] += slope[axis] * s;
            machine.kinematics.check(position)?;
            Ok::<_, K::NoPlace>(PathPoint { position, slope })
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
        self.axes.rest(self.panel).await;
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
enum NoTable<E: Reasoned> {
    #[error("{}", .0)]
    Plan(Reason<PlanError<E>>),
    #[error("the tool would leave the line by up to {departure:.3} mm, {allowed:.3} are allowed")]
    Departs { departure: f64, allowed: f64 },
}

/// A table with its largest departure, or why there is none.
type Planned<'k, E, const N: usize> = Result<(Table<'k, [f64; N]>, f64), NoTable<E>>;

/// The table of a line with its largest departure, within the tolerance: in about so many segments.
fn plan<'k, K: Kinematics<N>, const N: usize>(
    machine: &Machine<K, N>,
    path: &K::Path,
    mut segments: f64,
    mut free: &'k mut [Knot<[f64; N]>],
) -> Planned<'k, <K::Path as Path>::Error, N> {
    let allowed = machine.tolerance_mm;
    loop {
        let rows = (segments as usize + 1).min(free.len());
        let (own, rest) = free.split_at_mut(rows);
        let count = rows as u32 - 1;
        let table = Table::plan_in_f32([path], machine.limits, |_| count, own);
        let table = table.map_err(|error| NoTable::Plan(Reason(error)))?;
        let departures = table.spans().map(|span| K::departure(path, &span));
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

impl<I: Inputs<N>, const N: usize> Axes<'_, I, N> {
    /// Here is home.
    async fn set_home<K>(&mut self, machine: &Machine<K, N>) -> Result<(), SettingsError> {
        let quantiser = PvtQuantiser::new(machine.rate, machine.scales, machine.home)?;
        self.steps = PvtSteps::new(quantiser.knots(), machine.pins.min_intervals());
        self.quantiser = quantiser;
        (self.position, self.time_s) = (machine.home, 0.0);
        let steps = self.steps.steps().map(|steps| steps as i32);
        self.writer.restart(0);
        self.writer.set_steps(steps);
        self.settle(machine).await;
        self.loops.set_home(steps);
        Ok(())
    }

    /// Runs a table to its end, or to where the user stops it.
    async fn run<K: Kinematics<N>>(
        &mut self,
        machine: &Machine<K, N>,
        panel: &Panel<N>,
        mut playback: Playback<'_, [f64; N]>,
    ) -> Result<End, Failure> {
        let start_s = self.time_s;
        // Something may have pushed them.
        self.close_loops(machine).await?;
        let mut lost = None;
        loop {
            if lost.is_none() {
                lost = self.loops.check::<K>().err();
            }
            let (wanted, feed_percent) = panel.wanted();
            match wanted {
                Wanted::Run if lost.is_none() => playback
                    .set_feed(f64::from(feed_percent) / 100.0)
                    .map_err(failed)?,
                Wanted::Run | Wanted::Hold | Wanted::Stop => playback.stop(),
            }
            if let Some(row) = playback.next_row() {
                self.follow(start_s, &row).await?;
                continue;
            }
            self.rest(panel).await;
            if let Some(lost) = lost {
                return Err(failed(lost));
            }
            self.settle(machine).await;
            self.close_loops(machine).await?;
            if playback.is_finished() {
                return Ok(End::Done);
            }
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

    /// Waits until the axes stand, which are at rest, where their scales are read.
    async fn settle<K>(&mut self, machine: &Machine<K, N>) {
        let end = self.steps.end_ticks();
        self.loops.settle(machine, &mut self.writer, end).await;
    }

    /// Brings the axes, which stand, to where the steps have brought them, by their scales.
    async fn close_loops<K: Kinematics<N>>(
        &mut self,
        machine: &Machine<K, N>,
    ) -> Result<(), Failure> {
        let end = self.steps.end_ticks();
        let closed = self.loops.close(machine, &mut self.writer, end);
        closed.await.map_err(failed)
    }
}
