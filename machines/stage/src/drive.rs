//! Rows to the edges of both axes.

use anyhow::Result;
use kurbo::Point;
use path_timing::Row;
use pvt_steps::{Direction, PvtQuantiser, PvtSteps, Rate, StepDirTiming, StepScale};

use crate::grid::{STEPS_PER_MM, TICKS_PER_S, seconds};

/// Both axes along the rows of one chain of motions after the other.
#[derive(Debug)]
pub(crate) struct Drive {
    quantiser: PvtQuantiser<2>,
    steps: PvtSteps<2>,
    /// When it began, by the clock of all steps.
    start_ticks: u64,
    /// When the chain of the rows began, since then.
    chain_s: f64,
    /// The last row.
    now_s: f64,
}

impl Drive {
    /// Both axes at rest, at a tick and a position in mm, with what they start and stop with.
    ///
    /// # Errors
    /// The position is too far away.
    pub(crate) fn at_rest(
        start_ticks: u64,
        position_mm: Point,
        start_stop_mm_s: f64,
    ) -> Result<Self> {
        let rate = Rate::from_hz(TICKS_PER_S)?;
        let scale = StepScale::new(STEPS_PER_MM)?;
        let quantiser = PvtQuantiser::new(rate, [scale; 2], [position_mm.x, position_mm.y])?;
        let timing = StepDirTiming::DRV8825.min_intervals(rate);
        Ok(Self {
            steps: PvtSteps::new(quantiser.knots(), timing),
            quantiser: quantiser.with_start_stop_speeds([start_stop_mm_s; 2]),
            start_ticks,
            chain_s: 0.0,
            now_s: 0.0,
        })
    }

    /// Begins a chain of rows, at rest where the last one has ended.
    pub(crate) const fn begin(&mut self) {
        self.chain_s = self.now_s;
    }

    /// The time of the last row by the clock of all steps, in s.
    pub(crate) fn time_s(&self) -> f64 {
        seconds(self.start_ticks) + self.now_s
    }

    /// Takes the next row; the steps up to it, with their ticks.
    ///
    /// # Errors
    /// The row asks for more than whole numbers of steps and ticks can say.
    pub(crate) fn row(
        &mut self,
        row: &Row<[f64; 2]>,
    ) -> Result<impl Iterator<Item = (u64, [i32; 2])>> {
        self.now_s = self.chain_s + row.time_s;
        let row = self.quantiser.row(self.now_s, row.position, row.velocity)?;
        self.steps.push(&row)?;
        let start = self.start_ticks;
        Ok((&mut self.steps).map(move |edge| {
            let by = match edge.direction {
                Direction::Positive => 1,
                Direction::Negative => -1,
            };
            let step = if edge.axis == 0 { [by, 0] } else { [0, by] };
            (start + edge.ticks, step)
        }))
    }
}
