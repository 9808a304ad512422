use core::iter::FusedIterator;

use thiserror::Error;

use super::motor::ticks;
use super::{Easing, Law, Motor};

/// Frames at the end of a turn under [`Law::Reset`] whose speeds are searched together.
const ENDING: usize = 3;

/// By how many half steps the frames before may run ahead of the way or stay behind it, so that the
/// last ones find their end: the widest gap between the half steps that one frame makes at a
/// threshold of 600, 33 to 40, and one more.
const MOST_AHEAD: i64 = 8;

impl Motor {
    /// The speeds that turn the motor by so many half steps in so many frames, from where it is and
    /// with what its accumulator holds.
    ///
    /// ```
    /// use pattern_codec::dance::{Easing, Law, Motor, Timing};
    ///
    /// let mut wheel = Motor::new(Law::CarryMagnitude, 600, Timing::DEFAULT)?;
    /// assert!(wheel.turn(500, 25, Easing::Linear)?.eq([60; 25]));
    /// for speed in wheel.turn(-101, 4, Easing::Smooth)? {
    ///     wheel.run(speed);
    /// }
    /// assert_eq!(wheel.position(), -101);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    /// Under the carry laws the sum of the speeds decides where the motor ends. It is
    /// ```text
    /// V = ⌈(threshold · |half steps| - accumulator) / frame ticks⌉
    /// ```
    /// the least that makes all half steps, and frame k ends at V s(k/n), rounded. The end is exact
    /// as long as a frame has no more ticks than the threshold; with more, the sum is V or V - 1,
    /// whichever ends nearer.
    ///
    /// Under [`Law::Reset`] each frame takes the one of the distinct speeds that ends nearest to
    /// the way; the last three are searched together for the end nearest to what was asked, at
    /// first from the way itself, then from up to 8 half steps ahead of it or behind.
    ///
    /// # Errors
    /// [`TurnError::TooFast`] when a frame needs a speed above [`Motor::max_speed`];
    /// [`TurnError::Unreachable`] when no plan was found that ends within one half step.
    pub fn turn(&self, half_steps: i32, frames: u16, easing: Easing) -> Result<Turn, TurnError> {
        let mut turn = Turn::new(*self, half_steps, frames, easing);
        let sum = turn.sum;
        let mut before = 0;
        for frame in 1..=frames {
            let after = easing.way(sum, frame, frames);
            let speed = after.saturating_sub(before);
            if speed > self.max_speed().into() {
                return Err(TurnError::TooFast {
                    frame,
                    frames,
                    speed,
                    max: self.max_speed(),
                });
            }
            before = after;
        }
        let mut nearest = self.end(&turn);
        for ahead in (1..=MOST_AHEAD).flat_map(|ahead| [ahead, ahead.saturating_neg()]) {
            if nearest == i64::from(half_steps) {
                break;
            }
            let other = Turn {
                ahead,
                ..turn.clone()
            };
            let end = self.end(&other);
            if end.abs_diff(half_steps.into()) < nearest.abs_diff(half_steps.into()) {
                (turn, nearest) = (other, end);
            }
        }
        if nearest.abs_diff(half_steps.into()) > 1 {
            return Err(TurnError::Unreachable {
                half_steps,
                frames,
                nearest,
            });
        }
        Ok(turn)
    }

    /// Half steps that a plan makes.
    pub(super) fn end(&self, turn: &Turn) -> i64 {
        let mut motor = *self;
        turn.clone().for_each(|speed| motor.run(speed));
        motor.position.saturating_sub(self.position)
    }
}

/// Why a motor cannot turn so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TurnError {
    /// A frame needs more than the highest speed.
    #[error("frame {frame} of {frames} needs a speed of {speed}, {max} is the most")]
    TooFast {
        /// The frame, from 1.
        frame: u16,
        /// Frames of the turn.
        frames: u16,
        /// The speed that it needs.
        speed: u64,
        /// The highest speed of the motor.
        max: u8,
    },
    /// The distinct speeds of the law do not add up to the turn.
    #[error(
        "{half_steps} half steps in {frames} frames: the nearest that the law's speeds make is \
         {nearest}"
    )]
    Unreachable {
        /// Half steps asked for.
        half_steps: i32,
        /// Frames of the turn.
        frames: u16,
        /// Half steps of the best plan found.
        nearest: i64,
    },
}

/// The speeds of one turn, made by [`Motor::turn`].
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Turn {
    /// As it is after the frames so far.
    motor: Motor,
    start: i64,
    /// 1, -1, or 0 for no way at all.
    direction: i8,
    half_steps: u64,
    /// The speeds together, without loss.
    sum: u64,
    frames: u16,
    made: u16,
    easing: Easing,
    /// Half steps by which the frames before the last run ahead.
    ahead: i64,
    /// The speeds of the last frames once they have been found.
    ending: Option<[u8; ENDING]>,
}

impl Turn {
    fn new(motor: Motor, half_steps: i32, frames: u16, easing: Easing) -> Self {
        let mut turn = Self {
            motor,
            start: motor.position,
            direction: if half_steps < 0 { -1 } else { 1 },
            half_steps: half_steps.unsigned_abs().into(),
            sum: 0,
            frames,
            made: 0,
            easing,
            ahead: 0,
            ending: None,
        };
        if half_steps == 0 {
            turn.direction = 0;
        } else {
            turn.sum = turn.least_sum();
        }
        turn
    }

    /// The sum of speeds that ends nearest to the half steps without loss.
    fn least_sum(&self) -> u64 {
        let (motor, ticks_per_frame) = (&self.motor, self.motor.frame_ticks());
        let gathered = motor.gathered(self.direction.into());
        let wanted = self.half_steps.cast_signed();
        let lacking = motor
            .threshold()
            .saturating_mul(wanted)
            .saturating_sub(gathered);
        let sum = ticks(lacking, ticks_per_frame).unwrap_or(0);
        // Where one more speed makes several half steps, one less may be nearer.
        let off = |sum: i64| {
            let all = ticks_per_frame.saturating_mul(sum).saturating_add(gathered);
            let steps = all.checked_div(motor.threshold()).unwrap_or(0);
            steps.abs_diff(wanted)
        };
        let less = sum.saturating_sub(1);
        let sum = if off(less) < off(sum) { less } else { sum };
        sum.max(0).cast_unsigned()
    }

    /// Half steps made so far, in the direction of the turn.
    fn way(&self, motor: &Motor) -> i64 {
        let way = motor.position.saturating_sub(self.start);
        way.saturating_mul(self.direction.into())
    }

    /// Half steps of the way after a number of frames.
    fn wanted(&self, frame: u16) -> i64 {
        if frame == self.frames {
            return self.half_steps.cast_signed();
        }
        let wanted = self.easing.way(self.half_steps, frame, self.frames);
        let done = i64::from(frame).saturating_mul(self.ahead);
        let ahead = done.checked_div(self.frames.into()).unwrap_or(0);
        wanted.cast_signed().saturating_add(ahead)
    }

    fn speed(&self, magnitude: u8) -> i8 {
        magnitude.cast_signed().saturating_mul(self.direction)
    }

    /// The motor after one more frame.
    fn after(&self, motor: &Motor, magnitude: u8) -> Motor {
        let mut motor = *motor;
        motor.run(self.speed(magnitude));
        motor
    }

    /// The speed that ends the next frame nearest to the way, and not beyond its end.
    fn nearest(&self) -> u8 {
        let wanted = self.wanted(self.made.saturating_add(1));
        let end = self.half_steps.cast_signed();
        let fitting = distinct(&self.motor)
            .map(|magnitude| (magnitude, self.after(&self.motor, magnitude)))
            .filter(|(_, motor)| self.way(motor) <= end);
        let nearest = fitting.min_by_key(|(_, motor)| self.way(motor).abs_diff(wanted));
        nearest.map_or(0, |(magnitude, _)| magnitude)
    }

    /// The best speeds of the last frames: how far off the end they are, how far off the way
    /// together, and they themselves. Speeds more than `most_off` from the end are not looked at.
    fn search(&self, motor: &Motor, frame: u16, most_off: u64) -> (u64, u64, [u8; ENDING]) {
        let end = self.half_steps.cast_signed();
        if frame == self.frames {
            return (self.way(motor).abs_diff(end), 0, [0; ENDING]);
        }
        let next = frame.saturating_add(1);
        let (wanted, reach) = (self.wanted(next), self.reach(next));
        let mut best = (most_off, u64::MAX, [0; ENDING]);
        for magnitude in distinct(motor) {
            let motor = self.after(motor, magnitude);
            let (way, off) = (self.way(&motor), best.0.cast_signed());
            // No speed leads back, and the next ones go further.
            if way > end.saturating_add(off) {
                break;
            }
            // The highest speed to the end is not enough.
            if way.saturating_add(reach) < end.saturating_sub(off) {
                continue;
            }
            let (off_end, off, [second, third, _]) = self.search(&motor, next, best.0);
            let off = off.saturating_add(way.abs_diff(wanted));
            best = best.min((off_end, off, [magnitude, second, third]));
        }
        best
    }

    /// The most half steps from a frame to the end.
    fn reach(&self, frame: u16) -> i64 {
        let period = ticks(self.motor.threshold(), self.motor.max_speed().into());
        let frames = i64::from(self.frames.saturating_sub(frame));
        // What has been gathered may add one step.
        let all = frames.saturating_mul(self.motor.frame_ticks());
        let steps = period.and_then(|period| all.checked_div(period));
        steps.unwrap_or(0).saturating_add(frames)
    }
}

/// The speeds that differ under [`Law::Reset`]: of those with the same ticks between half steps the
/// slowest, which loses least.
fn distinct(motor: &Motor) -> impl Iterator<Item = u8> + use<> {
    let (threshold, most) = (motor.threshold(), motor.max_speed());
    core::iter::successors(Some(0), move |magnitude: &u8| {
        let next = match ticks(threshold, (*magnitude).into()) {
            None => 1,
            // The slowest with a tick less.
            Some(period) => ticks(threshold, period.saturating_sub(1))?,
        };
        u8::try_from(next).ok().filter(|next| *next <= most)
    })
}

impl Iterator for Turn {
    type Item = i8;

    fn next(&mut self) -> Option<i8> {
        let left = self
            .frames
            .checked_sub(self.made)
            .filter(|left| *left > 0)?;
        let magnitude = match self.motor.law() {
            _ if self.direction == 0 => 0,
            Law::Reset if usize::from(left) > ENDING => self.nearest(),
            Law::Reset => {
                let ending = match self.ending {
                    Some(ending) => ending,
                    None => self.search(&self.motor, self.made, u32::MAX.into()).2,
                };
                let [first, second, third] = ending;
                self.ending = Some([second, third, 0]);
                first
            }
            Law::CarryMagnitude | Law::CarrySigned => {
                let way = |done| self.easing.way(self.sum, done, self.frames);
                let speed = way(self.made.saturating_add(1)).saturating_sub(way(self.made));
                // `Motor::turn` has refused more.
                u8::try_from(speed).unwrap_or(self.motor.max_speed())
            }
        };
        self.made = self.made.saturating_add(1);
        self.motor = self.after(&self.motor, magnitude);
        Some(self.speed(magnitude))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::from(self.frames.saturating_sub(self.made));
        (left, Some(left))
    }
}

impl ExactSizeIterator for Turn {}

impl FusedIterator for Turn {}
