//! The numbers of a run, for programs and for people.

use std::io::Write;
use std::path::Path;

use anyhow::Result;
use pose2pulse::pattern_codec::dance::{Choreography, Data, Fit, Packing, ProgramMemory, Sizes};
use serde::Serialize;

use crate::law::Law;
use crate::simulation::Danced;
use crate::{Args, MOTORS};

/// `report.json`.
#[derive(Serialize)]
pub(crate) struct Report<'a> {
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

#[derive(Serialize)]
struct OtherLaw {
    law: Law,
    positions: [i32; MOTORS],
}

impl<'a> Report<'a> {
    pub(crate) fn new(
        args: &Args,
        motors: Vec<&'a str>,
        data: &Data<'_, MOTORS>,
        dance: &Choreography<MOTORS>,
        danced: &Danced,
        other: &[[i32; MOTORS]],
    ) -> Self {
        let last = |positions: &[[i32; MOTORS]]| positions.last().copied().unwrap_or_default();
        let sizes = Sizes::of(data.frames());
        let fit = ProgramMemory::AT89C52.fit(data.bytes(), args.code_bytes);
        let off = dance.landings.iter().map(|landing| {
            let frame = usize::try_from(landing.frame).unwrap_or(usize::MAX);
            let there = danced
                .positions
                .get(frame)
                .and_then(|all| all.get(landing.motor));
            there.map_or(f64::INFINITY, |there| {
                (f64::from(*there) - landing.asked_half_steps).abs()
            })
        });
        let positions = last(&danced.positions);
        Self {
            law: args.law,
            motors,
            frames: sizes.frames(),
            duration_s: danced.duration_s(),
            bytes_raw: sizes.bytes(Packing::Raw),
            bytes_packed: data.bytes(),
            packing: data.packing(),
            code_bytes: args.code_bytes,
            fits_at89c52: fit.fits(),
            steps: danced.steps,
            positions,
            turns: dance.landings.len(),
            worst_angle_error_steps: off.fold(0.0, f64::max),
            ends_as_planned: positions.map(i64::from) == dance.end,
            other_law: OtherLaw {
                law: args.law.other(),
                positions: last(other),
            },
            fit,
        }
    }

    /// Whether every turn ends within a half step of what was asked, and the dance as planned.
    pub(crate) fn is_as_asked(&self) -> bool {
        self.worst_angle_error_steps <= 1.0 && self.ends_as_planned
    }

    /// Writes what a person wants to know first.
    pub(crate) fn write_summary(
        &self,
        mut out: impl Write,
        score: &Path,
        folder: &Path,
    ) -> Result<()> {
        let Self {
            frames, duration_s, ..
        } = self;
        writeln!(out, "{}: {frames} frames, {duration_s} s", file_name(score))?;
        writeln!(
            out,
            "data.h: {} bytes as {}, {} raw",
            self.bytes_packed,
            self.packing.name(),
            self.bytes_raw
        )?;
        writeln!(out, "AT89C52: {}", self.fit)?;
        writeln!(
            out,
            "simulated from data.h alone under the law {}: {} half steps",
            self.law.name(),
            self.steps.iter().sum::<u64>()
        )?;
        writeln!(
            out,
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
            out,
            "the same frames under the law {} would end up to {} half steps away",
            self.other_law.law.name(),
            apart.unwrap_or(0)
        )?;
        writeln!(
            out,
            "in {}: data.h, dance.vcd, dance.svg, report.json",
            folder.display()
        )?;
        Ok(())
    }
}

/// The last part of a path, for people.
fn file_name(path: &Path) -> std::path::Display<'_> {
    Path::new(path.file_name().unwrap_or(path.as_os_str())).display()
}
