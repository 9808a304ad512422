//! The numbers of a run, for programs and for people.

use core::fmt;

use pattern_codec::dance::{Data, Fit, Packing, ProgramMemory, Sizes};
use serde::Serialize;

use crate::MOTORS;
use crate::law::Law;
use crate::score::{Choreography, Score};
use crate::simulation::Run;

/// `report.json`; displayed, a summary in lines.
#[derive(Debug, Clone, Serialize)]
pub struct Report<'a> {
    law: Law,
    motors: Vec<&'a str>,
    frames: u64,
    duration_s: f64,
    bytes_raw: u64,
    bytes_packed: u64,
    packing: Packing,
    code_bytes: u64,
    fits_at89c52: bool,
    /// Half steps of each motor, both directions together.
    steps: [u64; MOTORS],
    /// Where each motor ends, in half steps from the start.
    positions: [i32; MOTORS],
    turns: usize,
    /// The largest distance, in half steps, between the end of a turn and the angle asked for.
    worst_angle_error_steps: f64,
    /// Whether every motor ends where the plan has it.
    ends_as_planned: bool,
    other_law: OtherLaw,
    #[serde(skip)]
    fit: Fit,
}

#[derive(Debug, Clone, Serialize)]
struct OtherLaw {
    law: Law,
    positions: [i32; MOTORS],
}

impl<'a> Report<'a> {
    /// The numbers of a run, for a firmware with `code_bytes` beside the frames.
    #[must_use]
    pub fn new(
        score: &'a Score,
        dance: &Choreography<MOTORS>,
        data: &Data<'_, MOTORS>,
        run: &Run,
        code_bytes: u64,
    ) -> Self {
        let last = |positions: &[[i32; MOTORS]]| positions.last().copied().unwrap_or_default();
        let sizes = Sizes::of(data.frames());
        let fit = ProgramMemory::AT89C52.fit(data.bytes(), code_bytes);
        let off = dance.landings.iter().map(|landing| {
            let frame = usize::try_from(landing.frame).unwrap_or(usize::MAX);
            let there = run.positions.get(frame);
            let there = there.and_then(|all| all.get(landing.motor));
            there.map_or(f64::INFINITY, |there| {
                (f64::from(*there) - landing.asked_half_steps).abs()
            })
        });
        let positions = last(&run.positions);
        Self {
            law: run.law,
            motors: score.motors().map(|(name, _)| name).collect(),
            frames: sizes.frames(),
            duration_s: run.duration_s,
            bytes_raw: sizes.bytes(Packing::Raw),
            bytes_packed: data.bytes(),
            packing: data.packing(),
            code_bytes,
            fits_at89c52: fit.fits(),
            steps: run.steps,
            positions,
            turns: dance.landings.len(),
            worst_angle_error_steps: off.fold(0.0, f64::max),
            ends_as_planned: positions.map(i64::from) == dance.end,
            other_law: OtherLaw {
                law: run.law.other(),
                positions: last(&run.other),
            },
            fit,
        }
    }

    /// Whether every turn ends within a half step of what was asked, and the dance as planned.
    #[must_use]
    pub fn is_as_asked(&self) -> bool {
        self.worst_angle_error_steps <= 1.0 && self.ends_as_planned
    }
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} frames, {} s", self.frames, self.duration_s)?;
        let (bytes, packing) = (self.bytes_packed, self.packing.name());
        writeln!(
            f,
            "data.h: {bytes} bytes as {packing}, {} raw",
            self.bytes_raw
        )?;
        writeln!(f, "AT89C52: {}", self.fit)?;
        writeln!(
            f,
            "simulated from data.h alone under the law {}: {} half steps",
            self.law.name(),
            self.steps.iter().sum::<u64>()
        )?;
        writeln!(
            f,
            "{} turns end at most {:.2} half steps from what was asked{}",
            self.turns,
            self.worst_angle_error_steps,
            if self.is_as_asked() {
                ""
            } else {
                ": NOT AS ASKED"
            }
        )?;
        let apart = self.positions.iter().zip(self.other_law.positions);
        let apart = apart.map(|(here, there)| here.abs_diff(there)).max();
        writeln!(
            f,
            "the same frames under the law {} would end up to {} half steps away",
            self.other_law.law.name(),
            apart.unwrap_or(0)
        )
    }
}
