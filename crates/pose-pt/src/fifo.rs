//! Points to a controller that buffers them.

use nalgebra::RealField;

use crate::number::largest;
use crate::short::short;
use crate::{PtPoint, PvtPoint};

/// Something that takes a controller a time to run.
pub trait Timed<T> {
    /// Seconds from the point before to this one.
    fn segment_s(&self) -> T;
}

impl<const N: usize, T: Copy> Timed<T> for PtPoint<N, T> {
    fn segment_s(&self) -> T {
        self.segment_s
    }
}

impl<const N: usize> Timed<f64> for PvtPoint<N> {
    fn segment_s(&self) -> f64 {
        self.segment_s
    }
}

/// How full a controller's buffer is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct FifoState<T = f64> {
    /// Points that have not been run to their end.
    pub filled: usize,
    /// Points that there is room for.
    pub free: usize,
    /// Seconds until nothing is left to run.
    pub until_underrun_s: T,
}

/// What goes wrong between the sender and the controller.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FifoError<T: RealField + Copy = f64> {
    /// The controller has run out of points: it stopped, or went on blindly.
    #[error("underrun: the buffer was empty at {} s, {} s ago, after {points} points", short(.at_s), short(.late_s))]
    Underrun {
        /// When the last point was reached.
        at_s: T,
        /// Seconds since then.
        late_s: T,
        /// Points handed out until then.
        points: u64,
    },
    /// Time ran backwards, is not a number, or is beyond the range of the crate.
    #[error("time {} s is not within {}..={} s", short(.now_s), short(.last_s), short(.max_s))]
    Time {
        /// The time given.
        now_s: T,
        /// The time given before; at first the smallest.
        last_s: T,
        /// The largest time.
        max_s: T,
    },
    /// A segment has no positive finite time.
    #[error("point {point} takes {} s, not above 0 and at most {} s", short(.segment_s), short(.max_s))]
    Segment {
        /// The point, counted from 0 over all that were handed out.
        point: u64,
        /// Its time.
        segment_s: T,
        /// The longest time.
        max_s: T,
    },
    /// The first point was not handed out before the start.
    #[error("nothing to start with")]
    Empty,
}

/// The buffer of a controller as the sender sees it: `SLOTS` points, each of which is free again
/// when it has been run; 512 in Galil's contour mode.
///
/// It keeps no clock: every call is told the time, in seconds of any epoch. Points are handed
/// out by [`next`](Self::next) as room appears; calls that come early get nothing, calls that
/// come late only shorten the time until underrun. The controller runs from
/// [`start`](Self::start). After an underrun each call reports it again, until
/// [`restart`](Self::restart).
///
/// A first point of a table takes no time: it is where the machine stands, fills no slot, and is
/// passed on like all others.
#[derive(Debug, Clone, PartialEq)]
pub struct Fifo<const SLOTS: usize, T = f64> {
    /// When each buffered point will have been run; since the start. A ring.
    ends: [T; SLOTS],
    first: usize,
    filled: usize,
    /// When the last buffered point will have been run, since the start.
    last_end: T,
    started_s: Option<T>,
    now_s: Option<T>,
    points: u64,
    finished: bool,
    underrun: bool,
}

impl<const SLOTS: usize, T: RealField + Copy> Default for Fifo<SLOTS, T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const SLOTS: usize, T: RealField + Copy> Fifo<SLOTS, T> {
    /// An empty buffer that does not run.
    #[must_use]
    pub fn new() -> Self {
        Self {
            ends: [T::zero(); SLOTS],
            first: 0,
            filled: 0,
            last_end: T::zero(),
            started_s: None,
            now_s: None,
            points: 0,
            finished: false,
            underrun: false,
        }
    }

    /// The controller begins to run what it has.
    ///
    /// # Errors
    /// [`FifoError::Empty`] without a point, [`FifoError::Time`].
    pub fn start(&mut self, now_s: T) -> Result<(), FifoError<T>> {
        self.tell(now_s)?;
        if self.filled == 0 && !self.finished {
            return Err(FifoError::Empty);
        }
        self.started_s.get_or_insert(now_s);
        Ok(())
    }

    /// The next of `points` if there is room for it. `None` when the buffer is full, and when
    /// `points` has no more: then nothing more is expected, until it has again.
    ///
    /// # Errors
    /// [`FifoError`]. Nothing has been taken from `points`, but for a segment that is wrong.
    pub fn next<I>(&mut self, now_s: T, points: &mut I) -> Result<Option<I::Item>, FifoError<T>>
    where
        I: Iterator<Item: Timed<T>>,
    {
        if self.state(now_s)?.free == 0 {
            return Ok(None);
        }
        let Some(point) = points.next() else {
            self.finished = true;
            return Ok(None);
        };
        let segment_s = point.segment_s();
        let number = self.points;
        self.points = self.points.saturating_add(1);
        if segment_s == T::zero() && number == 0 {
            return Ok(Some(point));
        }
        let max_s = largest();
        if !(segment_s > T::zero() && segment_s <= max_s) {
            return Err(FifoError::Segment {
                point: number,
                segment_s,
                max_s,
            });
        }
        self.push(now_s, segment_s);
        Ok(Some(point))
    }

    /// How full the buffer is now.
    ///
    /// # Errors
    /// [`FifoError::Underrun`], [`FifoError::Time`].
    pub fn state(&mut self, now_s: T) -> Result<FifoState<T>, FifoError<T>> {
        self.tell(now_s)?;
        let elapsed = self.started_s.map_or(T::zero(), |start| now_s - start);
        while self.filled > 0 && self.ends.get(self.first).is_some_and(|end| *end <= elapsed) {
            self.first = self.slot(1);
            self.filled = self.filled.saturating_sub(1);
        }
        let left = self.last_end - elapsed;
        let runs = self.started_s.is_some() && !self.finished;
        if self.underrun || (runs && self.filled == 0) {
            self.underrun = true;
            return Err(FifoError::Underrun {
                at_s: now_s - (elapsed - self.last_end),
                late_s: -left,
                points: self.points,
            });
        }
        Ok(FifoState {
            filled: self.filled,
            free: SLOTS.saturating_sub(self.filled),
            until_underrun_s: left.max(T::zero()),
        })
    }

    /// Whether all points have been handed out and run.
    #[must_use]
    pub const fn is_done(&self) -> bool {
        self.finished && self.filled == 0
    }

    /// Begins anew after an underrun: the buffer is empty and does not run.
    pub fn restart(&mut self) {
        let now_s = self.now_s;
        *self = Self::new();
        self.now_s = now_s;
    }

    fn push(&mut self, now_s: T, segment_s: T) {
        if self.finished && self.filled == 0 {
            // It had come to rest: what follows begins now.
            let elapsed = self.started_s.map_or(T::zero(), |start| now_s - start);
            self.last_end = self.last_end.max(elapsed);
        }
        self.finished = false;
        self.last_end += segment_s;
        let slot = self.slot(self.filled);
        if let Some(end) = self.ends.get_mut(slot) {
            *end = self.last_end;
            self.filled = self.filled.saturating_add(1);
        }
    }

    /// The slot a number of places after the first.
    const fn slot(&self, after: usize) -> usize {
        let slot = self.first.saturating_add(after);
        if slot < SLOTS {
            slot
        } else {
            slot.saturating_sub(SLOTS)
        }
    }

    fn tell(&mut self, now_s: T) -> Result<(), FifoError<T>> {
        let max_s = largest::<T>();
        let last_s = self.now_s.unwrap_or(-max_s);
        if now_s >= last_s && now_s <= max_s {
            self.now_s = Some(now_s);
            return Ok(());
        }
        Err(FifoError::Time {
            now_s,
            last_s,
            max_s,
        })
    }
}
