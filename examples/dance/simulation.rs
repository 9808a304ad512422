//! The firmware, the bus and the motors.

use std::io::Write;

use anyhow::{Context as _, Result, ensure};
use pose2pulse::pattern_codec::dance::Data;
use pose2pulse::stepper_sync::{
    Accumulation, Accumulators, LatchWrites, Latches, Phase, Phases, Rate, SpeedLaw, Stepping,
    Wiring,
};

use crate::MOTORS;
use crate::waves::Waves;

/// The most ticks that are simulated: three days of 1 ms, some seconds of a PC.
const MOST_TICKS: u64 = 1 << 28;

/// What the motors did.
pub(crate) struct Danced {
    /// Half steps from the start at the end of every frame, before the first one too.
    pub(crate) positions: Vec<[i32; MOTORS]>,
    /// Half steps made, in both directions together.
    pub(crate) steps: [u64; MOTORS],
    /// Period of a frame, in s.
    frame_s: f64,
}

impl Danced {
    /// Length of the dance in s, without the digits that binary rounding adds.
    pub(crate) fn duration_s(&self) -> f64 {
        let frames = u32::try_from(self.positions.len() - 1).map_or(f64::INFINITY, f64::from);
        (frames * self.frame_s * 1e6).round() / 1e6
    }
}

/// What runs in the microcontroller.
pub(crate) struct Firmware {
    accumulators: Accumulators<MOTORS>,
    phases: Phases,
    at: [Phase; MOTORS],
    frame_ticks: u32,
    frame_s: f64,
}

impl Firmware {
    pub(crate) fn new(data: &Data<'_, MOTORS>, law: SpeedLaw) -> Result<Self> {
        let timing = data.timing();
        let frames = data.frames().remaining();
        let ticks = frames.saturating_mul(timing.frame_ticks().into());
        ensure!(
            ticks <= MOST_TICKS,
            "data.h: {ticks} ticks, {MOST_TICKS} are the most"
        );
        let tick = Rate::new(1_000_000, timing.tick_us())?;
        let accumulation = Accumulation::new(law, data.threshold(), tick).context("data.h")?;
        let phases = Phases::new(Stepping::Half, Wiring::UNIPOLAR)?;
        Ok(Self {
            accumulators: accumulation.motors(),
            phases,
            at: [phases.start(); MOTORS],
            frame_ticks: timing.frame_ticks(),
            frame_s: f64::from(timing.tick_us()) * f64::from(timing.frame_ticks()) / 1e6,
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
    pub(crate) fn count(
        mut self,
        frames: impl Iterator<Item = [i8; MOTORS]>,
    ) -> Vec<[i32; MOTORS]> {
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

/// Dances frames: every write goes over the bus into the latches, and the rotors follow those.
pub(crate) fn simulate<W: Write>(
    mut firmware: Firmware,
    frames: impl Iterator<Item = [i8; MOTORS]>,
    mut waves: Waves<W>,
) -> Result<Danced> {
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
    waves.tick(&mut latches, LatchWrites::new(start))?;
    for speeds in frames {
        firmware.accumulators.set_speeds(speeds);
        for _ in 0..firmware.frame_ticks {
            let bytes = firmware.tick();
            waves.tick(&mut latches, LatchWrites::new(bytes))?;
            for (number, (rotor, byte)) in rotors.iter_mut().zip(latches.outputs()).enumerate() {
                let followed = rotor.follow(&phases, byte);
                followed.with_context(|| format!("motor {number}"))?;
            }
        }
        positions.push(rotors.map(|rotor| rotor.position));
    }
    waves.finish()?;
    Ok(Danced {
        positions,
        steps: rotors.map(|rotor| rotor.steps),
        frame_s: firmware.frame_s,
    })
}
