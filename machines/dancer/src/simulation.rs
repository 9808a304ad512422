//! The firmware, the bus and the motors, from the frames of a header alone.

use std::io::Write;

use anyhow::{Context as _, Result, ensure};
use motor_phases::{
    Accumulation, Accumulators, LatchWrites, Latches, Phase, Phases, Rate, Stepping, Wiring,
};
use pattern_codec::dance::Data;

use crate::MOTORS;
use crate::bus_log::BusLog;
use crate::law::Law;

/// Highest number of ticks that are simulated: three days of 1 ms, some seconds of a PC.
const MAX_TICKS: u64 = 1 << 28;

/// What the motors did.
#[derive(Debug, Clone)]
pub struct Run {
    pub(crate) law: Law,
    /// Half steps from the start at the end of every frame, before the first one too.
    pub(crate) positions: Vec<[i32; MOTORS]>,
    /// The same for the same frames under the law to compare with.
    pub(crate) other: Vec<[i32; MOTORS]>,
    /// Half steps made, in both directions together.
    pub(crate) steps: [u64; MOTORS],
    /// Length of the dance, without the digits that binary rounding adds.
    pub(crate) duration_s: f64,
}

impl Run {
    /// Half steps from the start at the end of every frame, before the first one too.
    #[must_use]
    pub fn positions(&self) -> &[[i32; MOTORS]] {
        &self.positions
    }

    /// The same for the same frames under the law to compare with.
    #[must_use]
    pub fn other_positions(&self) -> &[[i32; MOTORS]] {
        &self.other
    }

    /// Length of a frame.
    pub(crate) fn frame_s(&self) -> f64 {
        let frames = u32::try_from(self.positions.len() - 1).map_or(f64::INFINITY, f64::from);
        self.duration_s / frames
    }
}

/// What runs in the microcontroller.
struct Firmware {
    accumulators: Accumulators<MOTORS>,
    phases: Phases,
    at: [Phase; MOTORS],
    frame_ticks: u32,
}

impl Firmware {
    fn new(data: &Data<'_, MOTORS>, law: Law) -> Result<Self> {
        let timing = data.timing();
        let tick = Rate::new(1_000_000, timing.tick_us())?;
        let accumulation =
            Accumulation::new(law.into(), data.threshold().get(), tick).context("data.h")?;
        let phases = Phases::new(Stepping::Half, Wiring::UNIPOLAR)?;
        Ok(Self {
            accumulators: accumulation.motors(),
            phases,
            at: [phases.start(); MOTORS],
            frame_ticks: timing.frame_ticks(),
        })
    }

    /// One tick: the bytes that have changed.
    fn tick(&mut self) -> [Option<u8>; MOTORS] {
        let mut bytes = [None; MOTORS];
        let steps = self.accumulators.tick();
        for ((byte, at), step) in bytes.iter_mut().zip(&mut self.at).zip(steps) {
            if step != 0 {
                *at = self.phases.advance(*at, step);
                *byte = Some(self.phases.byte(*at));
            }
        }
        bytes
    }

    /// The positions that the accumulators alone come to.
    fn count(mut self, frames: impl Iterator<Item = [i8; MOTORS]>) -> Vec<[i32; MOTORS]> {
        let mut position = [0; MOTORS];
        let mut positions = vec![position];
        for speeds in frames {
            self.accumulators.set_speeds(speeds);
            for _ in 0..self.frame_ticks {
                for (position, step) in position.iter_mut().zip(self.accumulators.tick()) {
                    *position += step;
                }
            }
            positions.push(position);
        }
        positions
    }
}

/// A motor at its latch: it sees currents and nothing else.
#[derive(Clone, Copy)]
struct Rotor {
    half_step: u8,
    position: i32,
    steps: u64,
}

impl Rotor {
    /// Follows the currents of a byte; a rotor follows to the neighbouring half step only.
    fn follow(&mut self, phases: &Phases, byte: u8) -> Result<()> {
        let phase = phases.phase_of(byte);
        let phase = phase.with_context(|| format!("{byte:#06b} is no phase"))?;
        let turn = match phase.half_step().wrapping_sub(self.half_step) & 7 {
            0 => return Ok(()),
            1 => 1,
            7 => -1,
            jump => anyhow::bail!("a jump of {jump} half steps"),
        };
        self.half_step = phase.half_step();
        self.position += turn;
        self.steps += 1;
        Ok(())
    }
}

/// Dances the frames of a header: every write goes over the bus into the latches, and the rotors
/// follow those. The bus over time goes to `vcd` as a value change dump, the frames that are done
/// and all of them to `progress`.
///
/// # Errors
/// A dance of over 2^28 ticks, what the firmware's accumulators refuse, or `vcd` does not take it.
pub fn simulate(
    data: &Data<'_, MOTORS>,
    law: Law,
    vcd: impl Write,
    progress: impl Fn(u64, u64),
) -> Result<Run> {
    let (timing, frames) = (data.timing(), data.frame_count());
    let ticks = frames.saturating_mul(timing.frame_ticks().into());
    ensure!(ticks <= MAX_TICKS, "data.h: {ticks} ticks, max {MAX_TICKS}");
    let mut firmware = Firmware::new(data, law)?;
    let mut log = BusLog::new(vcd, timing)?;
    let phases = firmware.phases;
    let rest = Rotor {
        half_step: phases.start().half_step(),
        position: 0,
        steps: 0,
    };
    let mut rotors = [rest; MOTORS];
    let mut latches = Latches::<MOTORS>::new();
    let mut positions = vec![[0; MOTORS]];
    // The windings carry current before the first tick.
    let start = [Some(phases.byte(phases.start())); MOTORS];
    log.tick(&mut latches, LatchWrites::new(start))?;
    for (speeds, done) in data.frames().zip(0..) {
        progress(done, frames);
        firmware.accumulators.set_speeds(speeds);
        for _ in 0..firmware.frame_ticks {
            let bytes = firmware.tick();
            log.tick(&mut latches, LatchWrites::new(bytes))?;
            for (number, (rotor, byte)) in rotors.iter_mut().zip(latches.outputs()).enumerate() {
                let followed = rotor.follow(&phases, byte);
                followed.with_context(|| format!("motor {number}"))?;
            }
        }
        positions.push(rotors.map(|rotor| rotor.position));
    }
    log.finish()?;
    #[expect(
        clippy::cast_precision_loss,
        reason = "a dance has fewer ticks than 2^28"
    )]
    let duration_s = ticks as f64 * f64::from(timing.tick_us()) / 1e6;
    Ok(Run {
        law,
        positions,
        other: Firmware::new(data, law.other())?.count(data.frames()),
        steps: rotors.map(|rotor| rotor.steps),
        duration_s: (duration_s * 1e6).round() / 1e6,
    })
}
