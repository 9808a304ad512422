//! Segments that reach across rows.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    clippy::integer_division_remainder_used,
    reason = "times below 2^63, sums of them with counts below 2^125; no divisor is zero"
)]

use crate::axis::AxisSegments;
use crate::row::PvtKnot;
use crate::row_error::RowError;
use crate::segment::{MAX_COUNT, Segment, Units};
use crate::{Direction, MinIntervals};

/// What the series of the rows may leave out, in 2^-32 ticks: 1/16 tick.
const TOLERANCE: u64 = (1 << 32) / 16;
/// What the tick of a step may be off the time of the row's segment, in 2^-32 ticks: 7/8 tick.
/// With the series, 0.0463 ticks of its differences and 1/64 of its fixed point that is 0.9995.
const LIMIT: i64 = (7 << 32) / 8;
/// A tick, in 2^-32 ticks.
const TICK: i64 = 1 << 32;
/// Ticks between the first and the last step of a segment, at most.
const MAX_SPAN_TICKS: u64 = 1 << 30;
/// Steps that wait for others.
const CAPACITY: usize = MAX_COUNT as usize;

/// The steps of one axis along the cubics of a PVT table in few segments, which reach across rows:
/// for a wire.
///
/// The steps of [`AxisSegments`] with finer times wait here until they are 1024, turn round or are
/// [`finish`](Self::finish)ed; then the longest run of them that one cubic meets becomes a segment.
/// Each step is tried, so that the ticks are as near to the cubics of the rows as those of
/// [`AxisSegments`]: less than a tick; a step that waits for the driver comes within 2 ticks of the
/// end of its wait. 8 KiB of memory, and some 20 trials a step: for the PC
/// that sends, not the microcontroller that plays.
///
/// # Examples
/// ```
/// use pvt_steps::{JoinedSegments, MinIntervals, PvtKnot, Segment};
/// let min_intervals = MinIntervals { step_ticks: 100, reversal_ticks: 100 };
/// let mut axis = JoinedSegments::new(PvtKnot::at_rest(0), min_intervals);
/// let mut wire = Vec::new();
/// let mut send = |segment: Segment| {
///     wire.extend_from_slice(segment.encode(&mut [0; Segment::MAX_ENCODED_LEN]));
/// };
/// for (ticks, steps) in [(10_000, 3), (10_000, 6)] {
///     axis.push(ticks, PvtKnot::at_rest(steps))?;
///     axis.by_ref().for_each(&mut send);
/// }
/// axis.finish();
/// axis.for_each(&mut send);
/// # Ok::<(), pvt_steps::RowError>(())
/// ```
#[derive(Clone, Debug)]
pub struct JoinedSegments {
    axis: AxisSegments,
    /// What is left of a segment of the row.
    rest: Option<Rest>,
    /// Steps that wait, all in one direction.
    direction: Direction,
    len: usize,
    /// Half a tick after their times, in 2^-32 ticks after `origin`.
    times: [i64; CAPACITY],
    origin: u64,
    /// Steps of the last segment.
    guess: usize,
    /// Tick of its last step.
    last_ticks: u64,
    finishing: bool,
}

/// The steps of a segment that do not wait yet; times in 2^-32 ticks.
#[derive(Clone, Debug)]
struct Rest {
    direction: Direction,
    left: u16,
    row_start: u64,
    /// Half a tick after the time of the next step, from the start of the row.
    time: u64,
    differences: [i64; 3],
}

impl Rest {
    /// The time from `origin`, if that is not too long.
    fn time_from(&self, origin: u64) -> Option<i64> {
        let ticks = (self.row_start + (self.time >> 32)).checked_sub(origin)?;
        let time = (ticks << 32) | (self.time & u64::from(u32::MAX));
        (ticks < MAX_SPAN_TICKS).then_some(time as i64)
    }

    /// The steps after the first.
    fn after(mut self) -> Option<Self> {
        self.left -= 1;
        let [first, second, third] = self.differences;
        self.time = self.time.wrapping_add_signed(first);
        self.differences = [
            first.wrapping_add(second),
            second.wrapping_add(third),
            third,
        ];
        (self.left > 0).then_some(self)
    }
}

impl JoinedSegments {
    /// An axis at a knot; it counts from the whole step nearest to it, of two the upper one.
    #[must_use]
    pub fn new(start: PvtKnot, min_intervals: MinIntervals) -> Self {
        // Two steps may each be a tick nearer to the other than the rows have them; in one
        // direction the rows leave them 2 ticks, of which a late one may take a third.
        let min_intervals = MinIntervals {
            step_ticks: min_intervals.step_ticks.saturating_add(1),
            reversal_ticks: min_intervals.reversal_ticks.saturating_add(2),
        };
        Self {
            axis: AxisSegments::within(TOLERANCE, start, min_intervals),
            rest: None,
            direction: Direction::Positive,
            len: 0,
            times: [0; CAPACITY],
            origin: 0,
            guess: 1,
            last_ticks: 0,
            finishing: false,
        }
    }

    /// Takes the next row: where the axis is `ticks` ticks after the end of the last one.
    ///
    /// # Errors
    /// [`RowError`]: the whole row is checked here, and the state is as before then.
    pub fn push(&mut self, ticks: u32, knot: PvtKnot) -> Result<(), RowError> {
        if self.rest.is_some() {
            return Err(self.axis.busy(0));
        }
        self.axis.push(ticks, knot)
    }

    /// Lets the steps that wait go out without those of later rows.
    pub const fn finish(&mut self) {
        self.finishing = true;
    }

    /// Takes steps of the row while there is room and they go in the same direction; whether some
    /// are left.
    fn fill(&mut self) -> bool {
        loop {
            let Some(rest) = self.rest.take().or_else(|| self.next_rest()) else {
                return false;
            };
            if self.len == 0 {
                self.direction = rest.direction;
                self.origin = rest.row_start + (rest.time >> 32);
            }
            let time = rest
                .time_from(self.origin)
                .filter(|_| rest.direction == self.direction);
            let (Some(time), Some(place)) = (time, self.times.get_mut(self.len)) else {
                self.rest = Some(rest);
                return true;
            };
            *place = time;
            self.len += 1;
            self.rest = rest.after();
        }
    }

    /// The next segment of the row.
    fn next_rest(&mut self) -> Option<Rest> {
        let (first, segment) = self.axis.next_timed()?;
        let player = segment.intervals();
        Some(Rest {
            direction: segment.direction,
            left: segment.count,
            row_start: self.axis.row_start(),
            time: first.wrapping_add(TICK as u64 / 2),
            differences: player.differences(),
        })
    }

    /// The segment of the most steps that wait, to one in 32: twice as many as the last one had or
    /// half, until they are not met or are, then between these.
    fn longest(&self) -> Segment {
        let [first, ..] = self.times;
        let mut best = Segment {
            delay_ticks: (first >> 32) as u64,
            count: 1,
            direction: self.direction,
            phase: 0,
            interval: 0,
            second: 0,
            third: 0,
        };
        let (mut met, mut missed) = (1, self.len + 1);
        let mut trial = self.guess.clamp(1, self.len);
        while missed - met > 1 + met / 32 {
            trial = trial.clamp(met + 1, missed - 1);
            match self.fit(trial) {
                Some(segment) => {
                    best = segment;
                    met = trial;
                }
                None => missed = trial,
            }
            trial = if missed > self.len {
                met * 2
            } else if met == 1 {
                missed / 2
            } else {
                usize::midpoint(met, missed)
            };
        }
        best
    }

    /// The first `count` steps, 2 and more, as a segment whose delay counts from the origin;
    /// `None` when a step would be too far from its time.
    fn fit(&self, count: usize) -> Option<Segment> {
        let times = self.times.get(..count)?;
        let polynomial = Newton::through(times)?;
        let segment = polynomial.segment(count as u16, self.direction);
        let mut time = ((segment.delay_ticks as i64) << 32) | (i64::from(segment.phase) << 24);
        let [mut first, mut second, third] = segment.intervals().differences();
        let last = count - 1;
        for (number, wanted) in times.iter().enumerate() {
            let off = (time & !(TICK - 1)) - (wanted - TICK / 2);
            if off.abs() > LIMIT || (number < last && first < TICK) {
                return None;
            }
            time = time.wrapping_add(first);
            first = first.wrapping_add(second);
            second = second.wrapping_add(third);
        }
        Some(segment)
    }

    /// Takes the steps of a segment from those that wait.
    fn take(&mut self, mut segment: Segment) -> Segment {
        let count = usize::from(segment.count);
        // The first step may be a tick before the origin.
        let ticks = self.origin.wrapping_add(segment.delay_ticks);
        segment.delay_ticks = ticks - self.last_ticks;
        self.last_ticks = ticks + u64::from(segment.span_ticks());
        self.guess = count;
        self.times.copy_within(count..self.len, 0);
        self.len -= count;
        let [first, ..] = self.times;
        self.origin += (first >> 32) as u64;
        for time in self.times.iter_mut().take(self.len) {
            *time -= first & !(TICK - 1);
        }
        segment
    }
}

impl Iterator for JoinedSegments {
    type Item = Segment;

    /// The next segment that no later row can lengthen; `None` when the next row may come.
    fn next(&mut self) -> Option<Segment> {
        let full = self.fill();
        if self.len == 0 {
            self.finishing = false;
            return None;
        }
        if !full && !self.finishing && (self.len == 1 || self.fit(self.len).is_some()) {
            return None;
        }
        let segment = self.longest();
        Some(self.take(segment))
    }
}

/// A polynomial of degree 3 at most in Newton's form.
struct Newton {
    places: [i128; 3],
    /// Its value at the first place, and divided differences, in 2^-52 ticks.
    differences: [i128; 4],
}

impl Newton {
    /// Through four of the times, spread like the zeros of a Chebyshev polynomial, or through all
    /// of four and fewer.
    fn through(times: &[i64]) -> Option<Self> {
        /// (1 - cos((2 i + 1) π/8)) / 2 in 2^-10.
        const SPREAD: [usize; 4] = [39, 316, 708, 985];
        let last = times.len().checked_sub(1)?;
        let [p0, p1, p2, p3] = if last < 4 {
            [0, 1, 2, 3]
        } else {
            SPREAD.map(|fraction| (fraction * last + 512) / 1024)
        };
        let time = |place: usize| times.get(place).map(|&time| i128::from(time) << 20);
        let [i0, i1, i2, i3] = [p0, p1, p2, p3].map(|place| place as i128);
        let (t0, t1) = (time(p0)?, time(p1)?);
        let a01 = (t1 - t0) / (i1 - i0);
        let (mut b012, mut c0123) = (0, 0);
        if let Some(t2) = time(p2) {
            let a12 = (t2 - t1) / (i2 - i1);
            b012 = (a12 - a01) / (i2 - i0);
            if let Some(t3) = time(p3) {
                let b123 = ((t3 - t2) / (i3 - i2) - a12) / (i3 - i1);
                c0123 = (b123 - b012) / (i3 - i0);
            }
        }
        Some(Self {
            places: [i0, i1, i2],
            differences: [t0, a01, b012, c0123],
        })
    }

    /// The same by differences from 0 on, for `count` steps.
    fn segment(&self, count: u16, direction: Direction) -> Segment {
        let [i, j, k] = self.places;
        let [value, a, b, c] = self.differences;
        let start = value - a * i + b * i * j - c * i * j * k;
        let first = a + b * (1 - i - j) + c * ((1 - i) * (1 - j) * (1 - k) + i * j * k);
        let second = 2 * b + c * (6 - 2 * (i + j + k));
        let third = 6 * c;
        let units = Units::of(count);
        let phase = rounded(start, 52 - 8);
        Segment {
            delay_ticks: (phase >> 8) as u64,
            count,
            direction,
            phase: phase as u8,
            interval: rounded(first, 52 - units.interval),
            second: rounded(second, 52 - units.second),
            third: rounded(third, 52 - units.third),
        }
    }
}

/// n 2^-bits to the nearest.
const fn rounded(n: i128, bits: u32) -> i64 {
    ((n + (1 << (bits - 1))) >> bits) as i64
}
