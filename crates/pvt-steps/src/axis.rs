//! The segments of one axis.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    reason = "ticks of rows below 2^32, of the move below 2^64"
)]

use crate::polynomial::{Cubic, Turns};
use crate::row::PvtKnot;
use crate::row_error::RowError;
use crate::run::{Back, Batch, Fit, Run};
use crate::segment::Segment;
use crate::series::time_of;
use crate::too_fast::{TooFast, max_velocity};
use crate::{Direction, MinIntervals};

/// What the series of a segment may leave out, in 2^-32 ticks: 7/16 tick. The differences of a
/// segment add 0.0463 ticks and the whole ticks 1/2.
const TOLERANCE: u64 = 7 << 28;

/// The steps of one axis along the cubics of a PVT table, as segments.
///
/// [`push`](Self::push) a row, take its segments until there are none, push the next. The state has
/// a fixed size; a step costs nothing, a segment some hundred operations on integers.
///
/// # Which steps
/// The count of steps k stays while |q - k| <= 1/2, and changes by one where the position q leaves
/// this range: a place k + 1/2 that is touched makes no step, and no rounding adds up. At a place
/// that is passed by no more than e before the axis turns round within a row, the driver is spared
/// two steps at once. Here e is 2^-8 steps, or what the axis moves in a tick at its greatest
/// velocity, if that is less. So at the end of a row, as at rest,
/// ```text
/// |q - k| <= 1/2 + e     at most 1/2 + 2^-8 = 0.50390625
/// ```
/// which is above 1/2 only where the axis has turned round past a place in that row, or rests
/// there. The next row that moves on makes the step at once.
///
/// Where the velocity jumps to the other direction, a step back may come in the first
/// [`reversal_ticks`](MinIntervals::reversal_ticks) after the last step. It waits for their end,
/// when the axis is then no more than e past its place, or neither turns round nor gets to the next
/// place for as long again as the driver may need; else the row is refused. A pen that jumps from
/// 10 to -10 mm/s on 400 steps/mm is 0.04 steps further after 10 us.
///
/// # How near to the cubic
/// Each step but one back that waits comes less than a tick from the time at which the row's exact
/// cubic passes its place, where the axis moves by u and more in a tick; elsewhere
/// |q - (k + 1/2)| at the tick of the step is at most what the axis moves in a tick, and u. Here u
/// is 2^-40 steps, or 2^-47 of the greatest of the row's travel and its duration times its
/// velocities, if that is more than 128 steps.
///
/// Proof. No root is searched for each step. Let s be the fraction of the row's time, and
/// q = d0 + d1 σ + d2 σ² + d3 σ³ round a centre `s_c` = s - σ with d1 > 0. For the positions
/// d0 + h x, |x| <= 1, put w = h / d1 and σ = w y:
/// ```text
/// x = y + g2 y² + g3 y³           g2 = d2 w / d1,  g3 = d3 w² / d1
/// ```
/// Its inverse series (Lagrange) is y = x + b2 x² + b3 x³ + ... with
/// ```text
/// b2 = -g2                        b4 = 5 g2 (g3 - g2²)
/// b3 = 2 g2² - g3                 b5 = 14 g2⁴ - 21 g2² g3 + 3 g3²
/// b6 = -g2 (42 g2⁴ - 84 g2² g3 + 28 g3²)
/// ```
/// x⁴ and x⁵ are replaced by the cubics that come nearest to them on |x| <= 1 (Chebyshev), x² - 1/8
/// and 5/4 x³ - 5/16 x, which are off by 1/8 and 1/16 at most. So
/// ```text
/// p(x) = -b4/8 + (1 - 5/16 b5) x + (b2 + b4) x² + (b3 + 5/4 b5) x³
/// |y - p(x)| <= |b4|/8 + |b5|/16 + |b6| + (|b7| + |b8| + ...)
/// ```
/// Let γ² = max(g2², |g3|). No coefficient of y + g2 y² + g3 y³ is greater than that of
/// y + γ y² + γ² y³ + γ³ y⁴ + ...; with all signs against it, the inverse of the latter has the
/// coefficients S(n) γ^(n-1) with the little Schröder numbers S(n) = 1, 1, 3, 11, 45, 197, 903,
/// 4279, ... Hence |b(n)| <= S(n) γ^(n-1), and with γ <= 1/16 the sum from b7 on is at most
/// 1300 γ⁶. So small a γ also keeps y + g2 y² + g3 y³ rising, and the root the one that is meant.
///
/// p is a cubic of the number of the step, so that differences of third order make its values. A
/// centre is taken, and h as its distance from the next step's place: where the bound times w is
/// at most 7/16 tick, the steps up to h beyond the centre are a segment; else the centre is moved,
/// and at last the root is halved in between. Together
/// ```text
/// 1/2 tick of rounding + 7/16 + 0.0463 of the differences + 1/64 of the fixed point < 0.9995
/// ```
///
/// # Examples
/// ```
/// use pvt_steps::{AxisSegments, MinIntervals, PvtKnot};
/// let min_intervals = MinIntervals { step_ticks: 100, reversal_ticks: 100 };
/// let mut axis = AxisSegments::new(PvtKnot::at_rest(0), min_intervals);
/// // From rest to rest, 3 steps in 10,000 ticks: 3 s² - 2 s³ of them at the fraction s of the time.
/// axis.push(10_000, PvtKnot::at_rest(3))?;
/// let steps: u32 = axis.by_ref().map(|segment| u32::from(segment.count())).sum();
/// assert_eq!((steps, axis.steps()), (3, 3));
/// # Ok::<(), pvt_steps::RowError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AxisSegments {
    min_intervals: MinIntervals,
    /// Rows pushed.
    rows: u64,
    /// Start and end of the present row, in ticks since the start.
    row_start: u64,
    row_end: u64,
    /// At the end of the present row.
    knot: PvtKnot,
    /// Whole steps from zero, after the segments taken.
    steps: i64,
    last: Option<Direction>,
    /// Ticks since the start that the next segment's delay counts from.
    last_ticks: u64,
    /// Made by `push` already.
    ready: Option<Batch>,
    run: Option<Run>,
    fit: Fit,
}

impl AxisSegments {
    /// An axis at a knot; it counts from the whole step nearest to it, of two the upper one.
    #[must_use]
    pub fn new(start: PvtKnot, min_intervals: MinIntervals) -> Self {
        Self::within(TOLERANCE, start, min_intervals)
    }

    /// With series that leave out less than a tolerance in 2^-32 ticks.
    pub(crate) fn within(tolerance: u64, start: PvtKnot, min_intervals: MinIntervals) -> Self {
        let max_velocity = max_velocity(min_intervals.step_ticks);
        Self {
            min_intervals,
            rows: 0,
            row_start: 0,
            row_end: 0,
            knot: start,
            steps: nearest(start.position),
            last: None,
            last_ticks: 0,
            ready: None,
            run: None,
            fit: Fit {
                tolerance,
                max_velocity,
                halves: 0,
            },
        }
    }

    /// Takes the next row: where the axis is `ticks` ticks after the end of the last one.
    ///
    /// # Errors
    /// [`RowError`]: the whole row is checked here, and the state is as before then.
    pub fn push(&mut self, ticks: u32, knot: PvtKnot) -> Result<(), RowError> {
        let start = self.check(0, ticks, knot)?;
        self.begin(ticks, knot, start);
        Ok(())
    }

    /// Whether segments of the present row are still to be taken.
    #[must_use]
    pub const fn is_busy(&self) -> bool {
        self.ready.is_some() || self.run.is_some()
    }

    /// Whole steps from zero, after the segments taken.
    #[must_use]
    pub const fn steps(&self) -> i64 {
        self.steps
    }

    /// The end of the present row, in ticks since the start.
    #[must_use]
    pub const fn end_ticks(&self) -> u64 {
        self.row_end
    }

    /// Checks a row of the axis that errors call `axis`, up to its first steps.
    pub(crate) fn check(
        &self,
        axis: usize,
        ticks: u32,
        knot: PvtKnot,
    ) -> Result<Option<Start>, RowError> {
        let row = self.rows;
        if self.is_busy() {
            return Err(self.busy(axis));
        }
        if ticks == 0 && knot.position != self.knot.position {
            return Err(RowError::NoTime { row, axis });
        }
        let cubic = self.cubic(ticks, knot).map_err(|fast| RowError::TooFast {
            row,
            axis,
            ticks: self.row_end + u64::from(fast.tick),
            interval_ticks: fast.interval_ticks,
            min_ticks: self.min_intervals.step_ticks.saturating_add(2),
        })?;
        let Some(cubic) = cubic else {
            return Ok(None);
        };
        self.start(cubic, ticks, knot)
            .map_err(|tick| RowError::ReversalTooQuick {
                row,
                axis,
                ticks: self.row_end + u64::from(tick),
                min_ticks: self.min_intervals.reversal_ticks,
            })
    }

    /// The cubic of a row, `None` without time.
    fn cubic(&self, ticks: u32, knot: PvtKnot) -> Result<Option<Cubic>, TooFast> {
        let limit = self.fit.max_velocity;
        if knot.velocity.unsigned_abs() > limit.unsigned_abs() {
            return Err(TooFast::at_knot(ticks, knot));
        }
        if ticks == 0 {
            return Ok(None);
        }
        let from = self.knot;
        if from.velocity.unsigned_abs() > limit.unsigned_abs() {
            return Err(TooFast::at_knot(0, from));
        }
        let Some(cubic) = Cubic::new(from, knot, ticks, self.steps) else {
            // 2^31 steps and more in less than 2^32 ticks.
            return Err(TooFast {
                tick: 0,
                interval_ticks: 1,
            });
        };
        if let Some(peak) = cubic.peak_above(limit, ticks) {
            let tick = whole_ticks(peak, ticks);
            let velocity = cubic.at(peak).velocity;
            return Err(TooFast::new(tick, velocity, ticks, cubic.bits));
        }
        Ok(Some(cubic))
    }

    /// The first steps of a row, if it has any.
    ///
    /// # Errors
    /// The tick of the row where a step back comes too soon.
    fn start(&self, cubic: Cubic, ticks: u32, knot: PvtKnot) -> Result<Option<Start>, u32> {
        let Some(turns) = cubic.turns() else {
            return Ok(None);
        };
        let mut run = self.run_with(cubic, ticks, knot, turns);
        if let Some(turn) = run.first_turn()
            && run.turns_within(self.min_intervals.reversal_ticks.saturating_add(2))
        {
            return Err(whole_ticks(turn, ticks));
        }
        let MinIntervals {
            step_ticks,
            reversal_ticks,
        } = self.min_intervals;
        let back = self.last.map(|last| Back {
            last,
            wait_ticks: self
                .last_ticks
                .saturating_add(reversal_ticks)
                .saturating_sub(self.row_end),
            // A tick for the rounding of the next step.
            apart_ticks: step_ticks.max(reversal_ticks).saturating_add(2),
        });
        let batch = run.first(back)?;
        Ok(batch.map(|batch| Start { run, batch }))
    }

    fn run_with(&self, cubic: Cubic, ticks: u32, knot: PvtKnot, turns: Turns) -> Run {
        let end = knot
            .position
            .wrapping_sub(self.steps << PvtKnot::POSITION_BITS);
        Run::new(cubic, ticks, end, turns, self.fit)
    }

    /// Begins a row that keeps its direction, as all of its axis do, with velocities of up to half
    /// a step a tick: it needs no check.
    pub(crate) fn push_one_way(&mut self, ticks: u32, knot: PvtKnot) {
        let direction = if knot.position < self.knot.position {
            Direction::Negative
        } else {
            Direction::Positive
        };
        let cubic = Cubic::new(self.knot, knot, ticks, self.steps);
        let start = cubic.and_then(|cubic| {
            let mut run = self.run_with(cubic, ticks, knot, Turns::none(direction));
            let batch = run.next()?;
            Some(Start { run, batch })
        });
        self.begin(ticks, knot, start);
    }

    /// Begins a row that is checked.
    pub(crate) fn begin(&mut self, ticks: u32, knot: PvtKnot, start: Option<Start>) {
        self.rows += 1;
        self.row_start = self.row_end;
        self.row_end += u64::from(ticks);
        self.knot = knot;
        if let Some(Start { run, batch }) = start {
            self.run = Some(run);
            self.ready = Some(batch);
        }
    }

    /// The start of the present row, in ticks since the start.
    pub(crate) const fn row_start(&self) -> u64 {
        self.row_start
    }

    /// The error for a row that comes too soon.
    pub(crate) const fn busy(&self, axis: usize) -> RowError {
        let row = self.rows;
        RowError::Busy { row, axis }
    }

    /// The next steps of the present row, which are then made, and the time of the first in 2^-32
    /// ticks since the start of the row.
    pub(crate) fn next_timed(&mut self) -> Option<(u64, Segment)> {
        let batch = match (self.ready.take(), &mut self.run) {
            (Some(batch), _) => batch,
            (None, None) => return None,
            (None, Some(run)) => match run.next() {
                Some(batch) => batch,
                None => {
                    self.fit.halves = run.halves();
                    self.run = None;
                    return None;
                }
            },
        };
        Some((batch.times.first, self.segment(&batch)))
    }

    fn segment(&mut self, batch: &Batch) -> Segment {
        let first = batch.start();
        let ticks = self.row_start + (first >> 32);
        let segment = Segment {
            delay_ticks: ticks - self.last_ticks,
            count: batch.count,
            direction: batch.direction,
            phase: if batch.count > 1 {
                (first >> 24) as u8
            } else {
                0
            },
            interval: batch.times.interval,
            second: batch.times.second,
            third: batch.times.third,
        };
        self.last_ticks = ticks + u64::from(segment.span_ticks());
        self.last = Some(batch.direction);
        let count = i64::from(batch.count);
        self.steps += match batch.direction {
            Direction::Positive => count,
            Direction::Negative => -count,
        };
        segment
    }
}

impl Iterator for AxisSegments {
    type Item = Segment;

    /// The next segment of the present row; `None` when the next row may come.
    fn next(&mut self) -> Option<Segment> {
        self.next_timed().map(|(_, segment)| segment)
    }
}

/// A row that is checked, and its first steps.
#[derive(Clone, Debug)]
pub(crate) struct Start {
    run: Run,
    batch: Batch,
}

/// A fraction in ticks, to the nearest.
fn whole_ticks(fraction: u64, ticks: u32) -> u32 {
    (((time_of(fraction, ticks) >> 31) + 1) >> 1) as u32
}

/// The whole step nearest to a position, of two the upper one.
const fn nearest(position: i64) -> i64 {
    // Without the sum, which may not fit.
    (position >> PvtKnot::POSITION_BITS) + ((position >> (PvtKnot::POSITION_BITS - 1)) & 1)
}
