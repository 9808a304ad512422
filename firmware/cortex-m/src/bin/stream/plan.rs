//! The line as it is sent: rows to segments, and from any row to rest.

use cortex_m_firmware::arm_line::LEAST;
use cortex_m_firmware::stream::Joints;
use path_timing::Playback;
use pvt_steps::{AxisSegments, PvtQuantiser, Segment};

use super::Result;

/// A playback of the line at one of its rows. A copy of it can go another way from there.
#[derive(Clone)]
pub struct Plan<'a> {
    playback: Playback<'a, [f64; 2]>,
    quantiser: PvtQuantiser<2>,
    axes: Joints<AxisSegments>,
}

impl<'a> Plan<'a> {
    pub fn new(playback: Playback<'a, [f64; 2]>, quantiser: PvtQuantiser<2>) -> Self {
        Self {
            playback,
            axes: quantiser.knots().map(|knot| AxisSegments::new(knot, LEAST)),
            quantiser,
        }
    }

    pub fn end_ticks(&self) -> u64 {
        self.axes[0].end_ticks()
    }

    pub fn is_finished(&self) -> bool {
        self.playback.is_finished()
    }

    /// The next rows as bytes, at most so many: fewer before a rest.
    pub fn rows(&mut self, most: usize) -> Result<Joints<Vec<u8>>> {
        let mut wire = [Vec::new(), Vec::new()];
        for _ in 0..most {
            let Some(row) = self.playback.next_row() else {
                break;
            };
            if row.duration_s == 0.0 {
                continue;
            }
            let row = self.quantiser.row(row.time_s, row.position, row.velocity)?;
            for ((axis, knot), wire) in self.axes.iter_mut().zip(row.knots).zip(&mut wire) {
                axis.push(row.ticks, knot)?;
                for segment in axis {
                    wire.extend(segment.encode(&mut [0; Segment::MAX_ENCODED_LEN]));
                }
            }
        }
        Ok(wire)
    }

    /// The rows to rest.
    pub fn stop(&mut self) -> Result<Joints<Vec<u8>>> {
        self.playback.stop();
        self.rows(usize::MAX)
    }

    /// At rest: goes on.
    pub fn resume(&mut self) -> Result<()> {
        Ok(self.playback.set_feed(1.0)?)
    }
}
