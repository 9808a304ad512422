//! The planner: jobs to rows, rows to steps.

use core::fmt::Display;

use path_timing::{Curve, FeedCeiling, Knot, PathFn, PathPoint, Playback, Row, Table, ToolLimits};
use pvt_steps::{PvtQuantiser, PvtSteps};
use scara_kin::Joints;

use crate::blocks::BlockWriter;
use crate::command::{Job, Joint};
use crate::homing::{NoHome, home};
use crate::panel::{Panel, State, Wanted};
use crate::settings::{Machine, SettingsError};
use crate::{Text, text};

/// Most segments of a motion.
const MAX_SEGMENTS: u32 = 100;
/// Segments of a short one.
const MIN_SEGMENTS: u32 = 12;
/// Length of a segment of a line, until there are too many.
const SEGMENT_MM: f64 = 3.0;
/// Farthest that a line may begin from the joints, in radians: rounding.
const START_TOLERANCE: f64 = 1e-6;

/// The planner of a machine: takes jobs from a panel, and puts blocks on it.
pub struct Motion<'m> {
    machine: &'m Machine,
    panel: &'m Panel,
    axes: Axes<'m>,
    knots: [Knot<[f64; 2]>; MAX_SEGMENTS as usize + 1],
    ceilings: [FeedCeiling; MAX_SEGMENTS as usize + 1],
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
    pub fn new(machine: &'m Machine, panel: &'m Panel) -> Result<Self, SettingsError> {
        Ok(Self {
            machine,
            panel,
            axes: Axes::home(machine, BlockWriter::new(machine, panel))?,
            knots: [Knot::default(); _],
            ceilings: [FeedCeiling::default(); _],
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
        let path = path.map_err(refused)?;
        let start = path.joints(0.0).map_err(refused)?;
        if (start - joints).amax() > START_TOLERANCE {
            return Err(refused("the elbow is on the other side, jog it over"));
        }
        let path = path.in_f32().map_err(refused)?;
        let segments = (line.length() / SEGMENT_MM) as u32;
        let table = Table::plan_in_f32(
            [path],
            machine.limits,
            |_| segments.clamp(MIN_SEGMENTS, MAX_SEGMENTS),
            &mut self.knots,
        );
        let table = table.map_err(refused)?;
        let departures = table.spans().map(|span| path.departure(&span));
        let departure = departures.fold(0.0, f64::max);
        if departure > machine.tolerance_mm {
            let allowed = machine.tolerance_mm;
            return Err(refused(format_args!(
                "the tool would leave the line by up to {departure:.3} mm, {allowed:.3} are allowed"
            )));
        }
        let playback = table.playback(1.0, &mut self.ceilings).map_err(refused)?;
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
        let table = Table::plan_in_f32([path], machine.limits, |_| MIN_SEGMENTS, &mut self.knots);
        let table = table.map_err(refused)?;
        let playback = table.playback(1.0, &mut self.ceilings).map_err(refused)?;
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
