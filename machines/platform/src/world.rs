//! Everything at one table, and the time.

use core::time::Duration;

use anyhow::{Context as _, Result, ensure};
use handwheel::{Key, Position, RotarySwitch, WheelSampler};
use nalgebra::Vector3;
use proto3964r::Transmit;

use crate::drives::Drives;
use crate::line::{Line, Side};
use crate::machine::isometry;
use crate::panel::{Action, Input, PanelSettings, Refusal};
use crate::pendant::Pendant;
use crate::planner::{Plan, Planner};
use crate::pose::{Pose, changed};
use crate::table::Table;
use crate::workstation::{Telegrams, Workstation};

/// A jog: what the wheel says, what the axis is commanded to do, and what it does.
#[derive(Default)]
pub(crate) struct Jog {
    /// End of each sample, in seconds, and its counts.
    pub(crate) samples: Vec<(f64, i32)>,
    /// Time in seconds, commanded speed in mm per second.
    pub(crate) commanded: Vec<[f64; 2]>,
    /// Time, speed of the axis.
    pub(crate) done: Vec<[f64; 2]>,
    pub(crate) locator: usize,
    pub(crate) axis: usize,
}

/// What has come of it all.
pub(crate) struct Outcome {
    pub(crate) jog: Jog,
    /// The plan that was run.
    pub(crate) plan: Option<Plan>,
    pub(crate) telegrams: Telegrams,
    pub(crate) line_log: String,
    pub(crate) line_bytes: usize,
}

pub(crate) struct World<'a, const N: usize> {
    pub(crate) planner: Planner<N>,
    now_us: u64,
    pub(crate) pendant: Pendant,
    line: Line<'a>,
    workstation: Workstation<N>,
    pub(crate) drives: Drives<N>,
    /// Pulses of the wheel, on their own wires.
    counter: u32,
    sampler: WheelSampler,
    /// Axis positions as they are shown: of the last sample.
    positions_um: [[i32; 3]; N],
    /// Where the body is, as it was last moved.
    pose: Pose,
    jog: Jog,
    plan: Option<Plan>,
}

impl<'a, const N: usize> World<'a, N> {
    /// The body at rest, the pendant without power.
    pub(crate) fn new(
        planner: Planner<N>,
        panel: PanelSettings,
        pose: Pose,
        wire: impl FnMut(Side, u8) -> Result<u8> + 'a,
    ) -> Result<Self> {
        let axes = planner.platform.axes(&isometry(pose));
        let drives = Drives::new(&planner.platform, &axes);
        Ok(Self {
            planner,
            now_us: 0,
            pendant: Pendant::new(),
            line: Line::new(wire),
            workstation: Workstation::new(panel)?,
            drives,
            counter: 0,
            sampler: WheelSampler::new(Duration::ZERO, 0),
            positions_um: micrometres(&axes),
            pose,
            jog: Jog::default(),
            plan: None,
        })
    }

    /// Lets time pass.
    pub(crate) fn wait_ms(&mut self, millis: u64) -> Result<()> {
        self.advance_to(self.now_us + 1000 * millis)
    }

    /// Lets time pass until something holds.
    pub(crate) fn wait_until(
        &mut self,
        what: &str,
        patience_s: u64,
        holds: impl Fn(&Self) -> bool,
    ) -> Result<()> {
        let end = self.now_us + 1_000_000 * patience_s;
        while !holds(self) {
            ensure!(self.now_us < end, "{what}: not within {patience_s} s");
            self.wait_ms(10)?;
        }
        Ok(())
    }

    pub(crate) fn press(&mut self, key: Key) {
        self.pendant.press(Some(key));
    }

    pub(crate) fn release(&mut self) {
        self.pendant.press(None);
    }

    pub(crate) fn turn(&mut self, switch: RotarySwitch, position: Position) {
        self.pendant.turn(switch, position);
    }

    /// The enabling switches have their own wires.
    pub(crate) fn switches(&mut self, left: bool, right: bool) -> Result<()> {
        let action = self.workstation.input(Input::Enable { left, right });
        self.act(action)
    }

    /// Turns the wheel by some counts, now.
    pub(crate) const fn turn_wheel(&mut self, counts: i32) {
        self.counter = self.counter.wrapping_add_signed(counts);
    }

    /// Turns the wheel by some counts, evenly over the next sample.
    pub(crate) fn wheel(&mut self, counts: i32) -> Result<()> {
        self.turn_wheel(counts);
        let due = micros(self.sampler.due()).context("the sampler's clock")?;
        self.advance_to(due)
    }

    /// Waits for the end of the present sample.
    pub(crate) fn wait_sample(&mut self) -> Result<()> {
        self.wheel(0)
    }

    pub(crate) fn is_moving(&self) -> bool {
        self.workstation.panel.is_moving()
    }

    pub(crate) fn axis_limits(&self, locator: usize, axis: usize) -> Option<(f64, f64, f64)> {
        let limits = self.planner.platform.locators().get(locator)?.limits;
        let limits = limits.get(axis)?;
        let position = self.drives.states().get(locator)?.get(axis)?.position;
        Some((limits.min, position, limits.max))
    }

    /// How far the axes are from where they hold the body in its pose, in mm.
    pub(crate) fn largest_residual(&self) -> f64 {
        let pose = isometry(self.pose);
        let held = self.planner.platform.axes(&pose);
        let axes = self.drives.axes();
        let residuals = held.iter().zip(&axes).map(|(held, is)| (held - is).norm());
        residuals.fold(0.0, f64::max)
    }

    pub(crate) fn finish(mut self) -> Result<Outcome> {
        self.wait_until("quiet line", 10, |world| {
            world.pendant.is_quiet() && world.workstation.station.is_idle()
        })?;
        ensure!(
            self.pendant.faults == 0,
            "{} telegrams did not reach or leave the pendant",
            self.pendant.faults
        );
        Ok(Outcome {
            jog: self.jog,
            plan: self.plan,
            telegrams: self.workstation.telegrams,
            line_bytes: self.line.bytes(),
            line_log: self.line.into_log(),
        })
    }

    fn advance_to(&mut self, end_us: u64) -> Result<()> {
        loop {
            self.work()?;
            let next = self.next_due().filter(|due| *due <= end_us);
            let Some(next) = next else {
                self.now_us = end_us;
                return Ok(());
            };
            self.now_us = next;
        }
    }

    /// The next moment at which something happens by itself.
    fn next_due(&self) -> Option<u64> {
        let timeouts = [
            self.workstation.station.poll_timeout(),
            self.pendant.station.poll_timeout(),
            self.workstation.driver.poll_timeout(),
            Some(self.sampler.due()),
        ];
        let timeouts = timeouts.map(|due| due.and_then(micros));
        let others = [self.line.due_us(), self.drives.due_us()];
        let all = timeouts.into_iter().chain(others).flatten();
        all.filter(|due| *due > self.now_us).min()
    }

    /// Does everything that is due now.
    fn work(&mut self) -> Result<()> {
        let now = self.now();
        while let Some(byte) = self.line.carry(Side::Control, self.now_us)? {
            self.pendant.hear(now, byte);
        }
        while let Some(byte) = self.line.carry(Side::Pendant, self.now_us)? {
            self.workstation.station.handle_byte(now, byte);
        }
        self.pendant.work(now);
        for action in self.workstation.work(now) {
            self.act(Some(action))?;
        }
        if let Some(counts) = self.sampler.sample(now, self.counter) {
            self.jog.samples.push((self.now_s(), counts));
            self.positions_um = micrometres(&self.drives.axes());
            let action = self.workstation.input(Input::Wheel(counts));
            self.act(action)?;
        }
        while self.drives.due_us().is_some_and(|due| due <= self.now_us) {
            let at_rest = self.drives.cycle();
            self.note_speed();
            if at_rest {
                self.at_rest()?;
            }
        }
        self.workstation.talk(now, &self.positions_um)?;
        self.transmit()
    }

    /// Hands what both stations send to the line.
    fn transmit(&mut self) -> Result<()> {
        let now = self.now();
        let mut bytes = [0; 64];
        while let Some(transmit) = self.workstation.station.poll_transmit(now, &mut bytes) {
            send(&mut self.line, Side::Control, self.now_us, transmit);
        }
        while let Some(transmit) = self.pendant.station.poll_transmit(now, &mut bytes) {
            send(&mut self.line, Side::Pendant, self.now_us, transmit);
        }
        Ok(())
    }

    fn act(&mut self, action: Option<Action>) -> Result<()> {
        match action {
            None => Ok(()),
            Some(Action::Jog {
                locator,
                axis,
                speed_um_s,
            }) => {
                let speed = f64::from(speed_um_s) / 1000.0;
                (self.jog.locator, self.jog.axis) = (locator.into(), axis.index());
                self.jog.commanded.push([self.now_s(), speed]);
                self.drives.jog(self.now_us, locator, axis, speed);
                Ok(())
            }
            Some(Action::Move(change)) => {
                let to = changed(self.pose, &change);
                let plan = match self.plan_to(to) {
                    Ok(plan) => plan,
                    Err(refusal) => {
                        let none = self.workstation.input(Input::Refused(refusal));
                        return self.act(none);
                    }
                };
                let table = Table::read(&plan.csv, &self.planner.platform)?;
                self.drives.run(self.now_us, table);
                self.plan = Some(plan);
                self.pose = to;
                Ok(())
            }
            Some(Action::Stop(_)) => {
                self.jog.commanded.push([self.now_s(), 0.0]);
                if self.drives.stop() {
                    self.at_rest()?;
                }
                Ok(())
            }
        }
    }

    /// The motion of the body to a pose, unless that is out of reach, or a locator has been jogged
    /// from where it holds the body.
    fn plan_to(&self, to: Pose) -> Result<Plan, Refusal> {
        if self.largest_residual() > self.planner.settings.max_distance_error_mm() {
            return Err(Refusal::NotReady);
        }
        let plan = self.planner.plan(self.pose, to);
        plan.map_err(|_| Refusal::OutOfReach)
    }

    fn at_rest(&mut self) -> Result<()> {
        self.positions_um = micrometres(&self.drives.axes());
        let action = self.workstation.input(Input::AtRest);
        self.act(action)
    }

    fn note_speed(&mut self) {
        let states = self.drives.states().get(self.jog.locator);
        let state = states.and_then(|states| states.get(self.jog.axis));
        if let Some(state) = state.filter(|_| self.plan.is_none()) {
            let time = self.now_s();
            self.jog.done.push([time, state.speed]);
        }
    }

    fn now(&self) -> Duration {
        Duration::from_micros(self.now_us)
    }

    pub(crate) fn now_s(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "hours of microseconds")]
        let micros = self.now_us as f64;
        micros * 1e-6
    }
}

/// Whole microseconds, rounded up; `None` beyond half a million years.
fn micros(time: Duration) -> Option<u64> {
    u64::try_from(time.as_nanos().div_ceil(1000)).ok()
}

fn send(line: &mut Line<'_>, side: Side, now_us: u64, transmit: Transmit<'_>) {
    match transmit {
        Transmit::Bytes(bytes) => line.send(side, now_us, bytes),
        Transmit::Discard => line.discard(side),
    }
}

fn micrometres<const N: usize>(axes: &[Vector3<f64>; N]) -> [[i32; 3]; N] {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a stroke of kilometres would be shown wrong"
    )]
    axes.map(|it| [it.x, it.y, it.z].map(|mm| (mm * 1000.0).round() as i32))
}
