//! How fast the tool moves in the glass, and how long it stands there while the disc turns.

use nalgebra::Point2;
use serde::Serialize;

/// What is measured of the records that are played with the tool in the glass, in ticks and mm.
#[derive(Debug, Default)]
pub(crate) struct Meter {
    /// Where the tool was at the last record's end, if in the glass.
    from: Option<Point2<f64>>,
    begin: u64,
    /// Last edge of the disc's train, which comes before those of the arms.
    disc_until: Option<u64>,
    in_glass: u64,
    dwell: u64,
    /// Min and max distance per tick of a record's arms.
    range: Option<[f64; 2]>,
}

/// The same in seconds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ToolSpeed {
    pub(crate) in_glass_s: f64,
    /// Of this, the disc turns and the arms stand.
    pub(crate) dwell_s: f64,
    /// Min and max mean speed of a record, in mm/s; none where no record moves the arms.
    pub(crate) range_mm_s: Option<[f64; 2]>,
}

impl Meter {
    /// An edge of the disc's train.
    pub(crate) const fn disc_edge(&mut self, ticks: u64) {
        self.disc_until = Some(ticks);
    }

    /// A record is done, with the tool in the glass at a position, or above it. Returns the mean
    /// speed of the tool, in mm per tick, where the record moved it along a stroke.
    pub(crate) fn record(&mut self, ticks: u64, tool: Option<Point2<f64>>) -> Option<f64> {
        let disc_until = self.disc_until.take().unwrap_or(self.begin);
        let begin = core::mem::replace(&mut self.begin, ticks);
        // What lowers or lifts the tool is no part of a stroke.
        let (from, to) = (core::mem::replace(&mut self.from, tool)?, tool?);
        self.in_glass += ticks - begin;
        self.dwell += disc_until - begin;
        let arms = ticks - disc_until;
        if arms == 0 {
            return None;
        }
        #[expect(
            clippy::cast_precision_loss,
            reason = "a record lasts far below 2^53 ticks"
        )]
        let speed = (to - from).norm() / arms as f64;
        let [min, max] = self.range.unwrap_or([speed; 2]);
        self.range = Some([min.min(speed), max.max(speed)]);
        Some(speed)
    }

    pub(crate) fn finish(self, tick_s: f64) -> ToolSpeed {
        #[expect(clippy::cast_precision_loss, reason = "2^53 ticks are centuries")]
        let seconds = |ticks: u64| ticks as f64 * tick_s;
        ToolSpeed {
            in_glass_s: seconds(self.in_glass),
            dwell_s: seconds(self.dwell),
            range_mm_s: self.range.map(|range| range.map(|speed| speed / tick_s)),
        }
    }
}

/// Path over which a speed is measured, in mm: some fifteen steps of a joint, so that single steps
/// do not show.
const STRETCH_MM: f64 = 4.0;

/// The tool's speed in the glass over each 4 mm of its path, stops included.
#[derive(Debug, Default)]
pub(crate) struct Pace {
    /// Where the stretch began, and when.
    from: Option<(u64, Point2<f64>)>,
    count: f64,
    sum: f64,
    squares: f64,
    range: Option<[f64; 2]>,
}

/// The same in mm/s.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Spread {
    pub(crate) min_mm_s: f64,
    pub(crate) max_mm_s: f64,
    pub(crate) mean_mm_s: f64,
    /// Standard deviation.
    pub(crate) deviation_mm_s: f64,
}

impl Pace {
    /// The tool is out of the glass.
    pub(crate) const fn lifted(&mut self) {
        self.from = None;
    }

    /// The tool is at a point in the glass.
    pub(crate) fn at(&mut self, ticks: u64, tool: Point2<f64>) {
        let (begin, from) = *self.from.get_or_insert((ticks, tool));
        let distance = (tool - from).norm();
        if distance < STRETCH_MM || ticks <= begin {
            return;
        }
        #[expect(clippy::cast_precision_loss, reason = "2^53 ticks are centuries")]
        let speed = distance / (ticks - begin) as f64;
        self.count += 1.0;
        self.sum += speed;
        self.squares += speed * speed;
        let [min, max] = self.range.unwrap_or([speed; 2]);
        self.range = Some([min.min(speed), max.max(speed)]);
        self.from = Some((ticks, tool));
    }

    /// None where the tool never went so far.
    pub(crate) fn finish(self, tick_s: f64) -> Option<Spread> {
        let [min, max] = self.range?;
        let mean = self.sum / self.count;
        let variance = (self.squares / self.count - mean * mean).max(0.0);
        Some(Spread {
            min_mm_s: min / tick_s,
            max_mm_s: max / tick_s,
            mean_mm_s: mean / tick_s,
            deviation_mm_s: variance.sqrt() / tick_s,
        })
    }
}
