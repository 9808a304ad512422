//! Turns: the speeds of the frames that bring a motor by so many half steps.

mod reset;

use core::iter::FusedIterator;

use thiserror::Error;

use super::motor::ticks;
use super::{Easing, Law, Motor};
use reset::Plan;

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
    /// the way, half steps and what the accumulator holds of the next; the last three are searched
    /// together for the end nearest to what was asked, at first from the way itself, then from up
    /// to 8 half steps ahead of it or behind.
    ///
    /// # Errors
    /// [`TurnError::TooFast`] when a frame needs a speed above [`Motor::max_speed`];
    /// [`TurnError::Unreachable`] when no plan was found that ends within one half step, or there is
    /// no frame to turn in.
    pub fn turn(&self, half_steps: i32, frames: u16, easing: Easing) -> Result<Turn, TurnError> {
        let turn = Turn::new(*self, half_steps, frames, easing)?;
        let off = turn.end.abs_diff(half_steps.into());
        if off > 1 || frames == 0 && off > 0 {
            return Err(TurnError::Unreachable {
                half_steps,
                frames,
                nearest: turn.end,
            });
        }
        Ok(turn)
    }

    /// The least sum of speeds that makes so many half steps without loss, or the one below where
    /// it ends nearer.
    fn least_sum(&self, half_steps: i32) -> u64 {
        let ticks_per_frame = self.frame_ticks();
        let gathered = self.gathered(half_steps.signum().into());
        let wanted = i64::from(half_steps.unsigned_abs());
        let lacking = self
            .threshold()
            .saturating_mul(wanted)
            .saturating_sub(gathered);
        let sum = ticks(lacking, ticks_per_frame).unwrap_or(0);
        // Where one more speed makes several half steps, one less may be nearer.
        let off = |sum: i64| {
            let all = ticks_per_frame.saturating_mul(sum).saturating_add(gathered);
            let steps = all.checked_div(self.threshold()).unwrap_or(0);
            steps.abs_diff(wanted)
        };
        let less = sum.saturating_sub(1);
        let sum = if off(less) < off(sum) { less } else { sum };
        sum.max(0).cast_unsigned()
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
    /// No plan was found whose speeds add up to the turn under the law.
    #[error("{half_steps} half steps in {frames} frames: the nearest plan found makes {nearest}")]
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
    /// 1 or -1.
    direction: i8,
    frames: u16,
    made: u16,
    magnitudes: Magnitudes,
    /// Half steps of all frames.
    end: i64,
}

/// Where the magnitudes of the speeds come from.
#[derive(Debug, Clone, Copy)]
enum Magnitudes {
    /// Shares of a sum that no law loses anything of.
    Shares { sum: u64, easing: Easing },
    /// What [`Law::Reset`] makes of a way.
    Tracked(Plan),
}

impl Turn {
    /// The plan that ends nearest, however far off.
    fn new(motor: Motor, half_steps: i32, frames: u16, easing: Easing) -> Result<Self, TurnError> {
        let sum = motor.least_sum(half_steps);
        let mut turn = Self {
            motor,
            direction: if half_steps < 0 { -1 } else { 1 },
            frames,
            made: 0,
            magnitudes: Magnitudes::Shares { sum, easing },
            end: 0,
        };
        turn.check_speeds(sum, easing)?;
        if motor.law() == Law::Reset && half_steps != 0 {
            let (plan, way) = Plan::nearest(motor, half_steps, frames, easing);
            turn.magnitudes = Magnitudes::Tracked(plan);
            turn.end = way.saturating_mul(turn.direction.into());
        } else {
            let mut motor = motor;
            turn.clone().for_each(|speed| motor.run(speed));
            turn.end = motor.position.saturating_sub(turn.motor.position);
        }
        Ok(turn)
    }

    /// Refuses shares of the sum above the highest speed.
    fn check_speeds(&self, sum: u64, easing: Easing) -> Result<(), TurnError> {
        let (frames, max) = (self.frames, self.motor.max_speed());
        let mut before = 0;
        for frame in 1..=frames {
            let after = easing.way(sum, frame, frames);
            let speed = after.saturating_sub(before);
            if speed > max.into() {
                return Err(TurnError::TooFast {
                    frame,
                    frames,
                    speed,
                    max,
                });
            }
            before = after;
        }
        Ok(())
    }

    /// Half steps of all frames, with their sign.
    #[cfg(feature = "score")]
    pub(super) const fn end(&self) -> i64 {
        self.end
    }
}

impl Iterator for Turn {
    type Item = i8;

    fn next(&mut self) -> Option<i8> {
        if self.made == self.frames {
            return None;
        }
        let magnitude = match &self.magnitudes {
            Magnitudes::Shares { sum, easing } => {
                let way = |done| easing.way(*sum, done, self.frames);
                let speed = way(self.made.saturating_add(1)).saturating_sub(way(self.made));
                // `check_speeds` has refused more.
                u8::try_from(speed).unwrap_or(self.motor.max_speed())
            }
            Magnitudes::Tracked(plan) => plan.magnitude(&self.motor, self.made),
        };
        self.made = self.made.saturating_add(1);
        let speed = magnitude.cast_signed().saturating_mul(self.direction);
        self.motor.run(speed);
        Some(speed)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::from(self.frames.saturating_sub(self.made));
        (left, Some(left))
    }
}

impl ExactSizeIterator for Turn {}

impl FusedIterator for Turn {}
