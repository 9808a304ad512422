//! Turns: the speeds of the frames that turn a motor by a number of half steps.

mod reset;

use thiserror::Error;

use crate::easing::Easing;
use crate::law::Law;
use crate::motor::{Motor, ticks_to};

impl Motor {
    /// The speeds that turn the motor by `half_steps` in `frames`, from where it is and with what
    /// its accumulator holds.
    ///
    /// ```
    /// use dancer::{Easing, Law, Motor};
    /// use pattern_codec::dance::{Threshold, Timing};
    ///
    /// let mut wheel = Motor::new(Law::CarryMagnitude, Threshold::DEFAULT, Timing::DEFAULT);
    /// assert_eq!(wheel.turn(500, 25, Easing::Linear)?, [60; 25]);
    /// for speed in wheel.turn(-101, 4, Easing::Smooth)? {
    ///     wheel.run(speed);
    /// }
    /// assert_eq!(wheel.position(), -101);
    /// # Ok::<(), dancer::TurnError>(())
    /// ```
    /// Under the carry laws the sum of the speeds decides where the motor ends. It is
    /// ```text
    /// V = ⌈(threshold · |half steps| - accumulator) / frame ticks⌉
    /// ```
    /// the smallest that makes all half steps, and frame k ends at V s(k/n), rounded. The end is
    /// exact as long as a frame has no more ticks than the threshold; with more, the sum is V or
    /// V - 1, whichever ends nearer.
    ///
    /// Under [`Law::Reset`] each frame takes the one of the distinct speeds that ends nearest to
    /// where the easing has it, half steps and what the accumulator holds of the next; the last
    /// three are searched together for the end nearest to what was asked, at first from where the
    /// easing has it, then from up to 8 half steps before or after. What would be refused then is
    /// searched once more, among all speeds of the last 3 to 12 frames, as many as 2 million tries
    /// reach: a turn of so few frames is refused only where no speeds make it.
    ///
    /// # Errors
    /// [`TurnError::TooFast`] when a frame needs a speed above [`Motor::max_speed`];
    /// [`TurnError::Unreachable`] when no plan was found that ends within one half step, or there
    /// is no frame to turn in.
    pub fn turn(&self, half_steps: i32, frames: u16, easing: Easing) -> Result<Vec<i8>, TurnError> {
        let mut magnitudes = self.distributed(self.smallest_sum(half_steps), frames, easing)?;
        if self.law() == Law::Reset && half_steps != 0 && frames > 0 {
            magnitudes = reset::magnitudes(*self, half_steps, frames, easing);
        }
        let backwards = half_steps < 0;
        let signed = magnitudes.into_iter().map(|magnitude| {
            // At most 127.
            let speed = magnitude.cast_signed();
            if backwards { -speed } else { speed }
        });
        let speeds: Vec<i8> = signed.collect();
        let mut motor = *self;
        speeds.iter().for_each(|speed| motor.run(*speed));
        let nearest = motor.position() - self.position();
        let off = nearest.abs_diff(half_steps.into());
        if off > 1 || frames == 0 && off > 0 {
            return Err(TurnError::Unreachable {
                half_steps,
                frames,
                nearest,
            });
        }
        Ok(speeds)
    }

    /// The smallest sum of speeds that makes the half steps without loss, or the one below
    /// where it ends nearer.
    fn smallest_sum(&self, half_steps: i32) -> u64 {
        let ticks_per_frame = self.frame_ticks();
        let accumulated = self.accumulated(half_steps.signum().into());
        let wanted = i64::from(half_steps.unsigned_abs());
        let sum = ticks_to(self.threshold() * wanted - accumulated, ticks_per_frame);
        // Where one more speed makes several half steps, one less may be nearer.
        let off = |sum: i64| {
            let steps = (ticks_per_frame * sum + accumulated) / self.threshold();
            steps.abs_diff(wanted)
        };
        let sum = if off(sum - 1) < off(sum) {
            sum - 1
        } else {
            sum
        };
        sum.max(0).cast_unsigned()
    }

    /// A sum of speeds, distributed over the frames.
    fn distributed(&self, sum: u64, frames: u16, easing: Easing) -> Result<Vec<u8>, TurnError> {
        let max = self.max_speed();
        let mut before = 0;
        let speeds = (1..=frames).map(|frame| {
            let after = easing.position(sum, frame, frames);
            let speed = after - before;
            before = after;
            let fits = u8::try_from(speed).ok().filter(|speed| *speed <= max);
            fits.ok_or(TurnError::TooFast {
                frame,
                frames,
                speed,
                max,
            })
        });
        speeds.collect()
    }
}

/// Why a motor cannot turn so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TurnError {
    /// A frame needs more than the highest speed.
    #[error("frame {frame} of {frames} needs a speed of {speed}, max {max}")]
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
