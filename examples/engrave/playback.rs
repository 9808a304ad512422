//! The controller: reads pattern bytes and drives pins.

use std::io::BufRead;

use anyhow::Result;
use pose2pulse::pattern_codec::engraving::{Axis, Decoder, Format, JointPulses, Record};
use pose2pulse::stepper_sync::{Direction, Edge, Level, Ramp, RampLimits, Timer, Trains};

use crate::machine::Machine;

/// What the controller's pins are wired to; times in timer ticks, never going back.
pub(crate) trait Wires {
    fn direction(&mut self, ticks: u64, axis: Axis, direction: Direction) -> Result<()>;
    fn step(&mut self, ticks: u64, axis: Axis, level: Level) -> Result<()>;
    /// A record is done.
    fn record(&mut self, ticks: u64) -> Result<()>;
}

/// Plays a pattern, chunk by chunk, in constant memory.
pub(crate) fn play(
    machine: &Machine,
    mut pattern: impl BufRead,
    wires: &mut impl Wires,
) -> Result<()> {
    let mut controller = Controller {
        format: machine.format,
        timer: machine.timer,
        half_period_ticks: machine.half_period_ticks,
        rapid: machine.rapid,
        now: 0,
    };
    let mut decoder = Decoder::new(controller.format);
    loop {
        let mut chunk = pattern.fill_buf()?;
        let length = chunk.len();
        if length == 0 {
            break;
        }
        while let Some(located) = decoder.decode(&mut chunk) {
            controller.play(located?.record, wires)?;
        }
        pattern.consume(length);
    }
    decoder.finish()?;
    Ok(())
}

struct Controller {
    format: Format,
    timer: Timer,
    half_period_ticks: u64,
    rapid: RampLimits,
    now: u64,
}

impl Controller {
    fn play(&mut self, record: Record, wires: &mut impl Wires) -> Result<()> {
        match record {
            Record::Fast(fast) => {
                let ramp = Ramp::new([fast.pulses()], &self.rapid, self.timer.tick_rate())?;
                self.start([fast.axis()], ramp.directions(), wires)?;
                self.run([fast.axis()], ramp.edges(), ramp.end_ticks(), wires)?;
            }
            Record::Slow(slow) => {
                let JointPulses {
                    theta1,
                    theta2,
                    theta3,
                } = slow.pulses();
                // The disc turns first, then both arms together.
                self.process([Axis::Theta3], [theta3], wires)?;
                self.process([Axis::Theta1, Axis::Theta2], [theta1, theta2], wires)?;
            }
        }
        wires.record(self.now)
    }

    fn process<const N: usize>(
        &mut self,
        axes: [Axis; N],
        steps: [i32; N],
        wires: &mut impl Wires,
    ) -> Result<()> {
        let trains = Trains::new(steps, self.half_period_ticks)?;
        self.start(axes, trains.directions(), wires)?;
        self.run(axes, trains.edges(), trains.end_ticks(), wires)
    }

    fn start<const N: usize>(
        &self,
        axes: [Axis; N],
        directions: [Option<Direction>; N],
        wires: &mut impl Wires,
    ) -> Result<()> {
        for (axis, direction) in axes.into_iter().zip(directions) {
            if let Some(direction) = direction {
                wires.direction(self.now, axis, direction)?;
            }
        }
        Ok(())
    }

    fn run<const N: usize>(
        &mut self,
        axes: [Axis; N],
        edges: impl Iterator<Item = Edge>,
        end_ticks: u64,
        wires: &mut impl Wires,
    ) -> Result<()> {
        for edge in edges {
            if let Some(axis) = axes.get(edge.axis) {
                wires.step(self.now + edge.ticks, *axis, edge.level)?;
            }
        }
        self.now += end_ticks;
        Ok(())
    }
}
