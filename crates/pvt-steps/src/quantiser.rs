//! From floating point to rows.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "ticks below 2^52, and numbers whose range is checked"
)]

use crate::row::{PvtKnot, PvtRow};
use crate::{Rate, StepScale};
use thiserror::Error;
use trig_kernels::SixDigits;

/// Why a knot has no row.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum KnotError {
    /// A position that is no number, or past ±2^31 steps.
    #[error("axis {axis}: position {} steps, not within 2^31", SixDigits(*.position))]
    Position {
        /// Index of the axis.
        axis: usize,
        /// Position, in steps.
        position: f64,
    },
    /// A velocity that is no number, or of 128 steps a tick and more.
    #[error("axis {axis}: velocity {} steps a tick, not within 128", SixDigits(*.velocity))]
    Velocity {
        /// Index of the axis.
        axis: usize,
        /// Velocity, in steps a tick.
        velocity: f64,
    },
    /// A time that is no number, before the knot before, or 2^32 ticks after it: rows of path-timing
    /// that last so long are cut by its `ShortRows`.
    #[error(
        "time {} s is not 0 to 2^32 - 1 whole ticks after {} s",
        SixDigits(*.time_s), SixDigits(*.last_s)
    )]
    Time {
        /// Time given, in s.
        time_s: f64,
        /// Time of the knot before, in s.
        last_s: f64,
    },
    /// A knot in the tick of the one before, that is elsewhere by more than 2^-8 steps.
    #[error(
        "axis {axis}: {} steps between two knots of a tick, not the {} of their velocities",
        SixDigits(*.distance), SixDigits(*.expected)
    )]
    Moved {
        /// Index of the axis.
        axis: usize,
        /// From the knot before, in steps.
        distance: f64,
        /// What the mean of both velocities makes of the time between them, in steps.
        expected: f64,
    },
    /// A velocity that jumps by more than the motor starts and stops with, which is 0 unless
    /// [given](PvtQuantiser::with_start_stop_speeds).
    #[error(
        "axis {axis}: velocity jumps by {} steps a tick, more than {}",
        SixDigits(*.jump), SixDigits(*.max)
    )]
    Jump {
        /// Index of the axis.
        axis: usize,
        /// Change of the velocity, in steps a tick.
        jump: f64,
        /// The start-stop speed, in steps a tick.
        max: f64,
    },
}

/// Turns knots in seconds and units into rows of whole ticks and steps: the last floating point
/// before the steps.
///
/// With F ticks a second and knots (t, q, v) whose cubics are the motion, a knot at t = n / F + δ,
/// n whole and 0 <= δ < 1 / F, is taken at tick n, with the position and velocity that the cubic
/// before it has there:
/// ```text
/// q - v δ + a δ²/2 - j δ³/6        v - a δ + j δ²/2        a, j at the end of that cubic
/// ```
/// Rounding the time alone would add accelerations of up to 6 v δ / T² in a row of T seconds.
///
/// # What it is off
/// Let A be the most by which the accelerations of two cubics that meet differ within a tick of
/// their knot, h = 1 / F. A row's cubic departs from the motion by at most
/// ```text
/// position      A h (4/27 T + h/2)   + 2^-33 steps + 0.3 · 2^-57 T F
/// velocity      A h (1 + 3/4 h/T)    + 2^-57 steps a tick + 1.5 · 2^-32 steps / T
/// acceleration  A (4 h/T + 3 h²/T²)  + 6 · 2^-57 steps a tick / T + 6 · 2^-32 steps / T²
/// ```
/// and what `f64` loses: less than 2^-30 steps while positions stay below 2^20 steps and times
/// below 2^32 ticks. At 72 MHz, rows of 1 ms and jumps of 10⁵ steps/s² that is 2·10⁻⁷ steps,
/// 0.0014 steps/s and 5.6 steps/s².
///
/// # Knots in one tick
/// A knot later than the one before, but in the same tick n, is merged with it: it has no row of
/// its own, but one of 0 ticks that changes nothing, and the next row goes from what the axes were
/// at tick n to where the motion comes from the last of them. So no motion stops for a row that is
/// shorter than a tick. Where the velocities of the first and the last of them differ by D steps a
/// tick, that row departs by
/// ```text
/// position      D (4/27 T + 1)        velocity      D (1 + 1.5 / T)
/// acceleration  D (4 / T + 6 / T²)
/// ```
/// more, T in ticks: nothing for a motion, but much for a table that brings an axis to its speed
/// within a tick, which is to say so by a [jump](Self::jump). A knot that is elsewhere by more than
/// 2^-8 steps than its velocity and the one before make it, is no such motion and refused.
///
/// # Jumps
/// With [`start-stop speeds`](Self::with_start_stop_speeds), a knot of the same time and positions
/// as the one before sets other velocities, by a row of 0 ticks at the tick n of both, as at the
/// corners of a table of path-timing. Where an axis jumps by D steps a tick, and its accelerations
/// before and after are at most a, the row after it departs by
/// ```text
/// position      D        velocity      a h + 1.5 D / T        acceleration  4 a h/T + 6 D / T²
/// ```
/// more, with h and T in ticks.
///
/// # Refusals
/// A knot is refused before anything of its row is put out, and the state is as before then:
/// another one may follow in its place, such as one at rest within the machine's accelerations.
///
/// # Examples
/// ```
/// use pvt_steps::{PvtQuantiser, Rate, StepScale};
/// // 100 steps/mm; 10 mm in 0.2 s from rest to rest.
/// let mut pvt = PvtQuantiser::new(Rate::from_hz(72_000_000)?, [StepScale::new(100.0)?], [0.0])?;
/// let row = pvt.row(0.2, [10.0], [0.0])?;
/// assert_eq!((row.ticks, row.knots[0].position), (14_400_000, 1000 << 32));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PvtQuantiser<const N: usize> {
    tick_hz: f64,
    steps_per_unit: [f64; N],
    /// Of each axis, in steps a tick.
    start_stop: [f64; N],
    /// The knot given last.
    last_s: f64,
    last_ticks: f64,
    last: [Motion; N],
    /// The tick it was taken at, and what it was there.
    whole_ticks: u64,
    knots: [PvtKnot; N],
}

/// Units of a position in a step.
const POSITION_UNITS: f64 = (1_u64 << PvtKnot::POSITION_BITS) as f64;
/// Units of a velocity in a step a tick.
const VELOCITY_UNITS: f64 = (1_u64 << PvtKnot::VELOCITY_BITS) as f64;
/// Of a velocity by its scale and the tick rate, and of a sum, relative.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// What a knot may be off from where the velocities of two knots in one tick have it, in steps.
const MOVED: f64 = 1.0 / 256.0;
/// From here on an `f64` has no half ticks.
const MAX_TICKS: f64 = (1_u64 << 52) as f64;

impl<const N: usize> PvtQuantiser<N> {
    /// For ticks of `tick_rate`, a scale for each axis, and positions at rest at time 0.
    ///
    /// # Errors
    /// [`KnotError::Position`].
    pub fn new(
        tick_rate: Rate,
        scales: [StepScale; N],
        positions: [f64; N],
    ) -> Result<Self, KnotError> {
        let mut quantiser = Self {
            tick_hz: hz(tick_rate),
            steps_per_unit: scales.map(StepScale::steps_per_unit),
            start_stop: [0.0; N],
            last_s: 0.0,
            last_ticks: 0.0,
            last: [Motion::default(); N],
            whole_ticks: 0,
            knots: [PvtKnot::default(); N],
        };
        quantiser.last = quantiser.motions(positions, [0.0; N]);
        quantiser.knots = rounded(&quantiser.last)?;
        Ok(quantiser)
    }

    /// The same for motors that start and stop at once with up to `speeds`, in the axes' units a
    /// second: by these the velocities may jump from a knot to the next one of the same time.
    #[must_use]
    pub fn with_start_stop_speeds(mut self, speeds: [f64; N]) -> Self {
        let motions = self.motions([0.0; N], speeds);
        self.start_stop = motions.map(|motion| motion.velocity);
        self
    }

    /// Where the axes are at the end of the last row.
    #[must_use]
    pub const fn knots(&self) -> [PvtKnot; N] {
        self.knots
    }

    /// The row to the knot at `time_s`, with positions in the axes' units, and velocities in these
    /// a second. A knot of the same time and positions is a jump of the velocities, where
    /// [start-stop speeds](Self::with_start_stop_speeds) allow one; a later one in the same tick is
    /// merged with the one before, by a row of 0 ticks that changes nothing.
    ///
    /// # Errors
    /// [`KnotError`]: the state is as before then.
    pub fn row(
        &mut self,
        time_s: f64,
        positions: [f64; N],
        velocities: [f64; N],
    ) -> Result<PvtRow<N>, KnotError> {
        let now_ticks = time_s * self.tick_hz;
        // Not a number neither.
        let is_later = now_ticks >= self.last_ticks && now_ticks < MAX_TICKS;
        let whole_ticks = if is_later { now_ticks as u64 } else { 0 };
        let ticks = u32::try_from(whole_ticks.saturating_sub(self.whole_ticks))
            .ok()
            .filter(|_| is_later)
            .ok_or(KnotError::Time {
                time_s,
                last_s: self.last_s,
            })?;
        let to = self.motions(positions, velocities);
        rounded(&to)?;
        let duration = now_ticks - self.last_ticks;
        if ticks == 0 {
            self.check_merged(&to, duration)?;
            if duration <= 0.0 {
                self.check_jump(&to)?;
                return self.jump_to(&to);
            }
        } else {
            let early = now_ticks - whole_ticks as f64;
            let mut at_tick = to;
            for (motion, from) in at_tick.iter_mut().zip(self.last) {
                *motion = from.before(*motion, duration, early);
            }
            self.knots = rounded(&at_tick)?;
        }
        self.last_s = time_s;
        self.last_ticks = now_ticks;
        self.last = to;
        self.whole_ticks = whole_ticks;
        Ok(PvtRow {
            ticks,
            knots: self.knots,
        })
    }

    /// Whether the axes are where their velocities bring them in `ticks`, less than one.
    fn check_merged(&self, to: &[Motion; N], ticks: f64) -> Result<(), KnotError> {
        for (axis, (to, last)) in to.iter().zip(self.last).enumerate() {
            let distance = to.position - last.position;
            let expected = (to.velocity + last.velocity) / 2.0 * ticks;
            if (distance - expected).abs() > MOVED {
                return Err(KnotError::Moved {
                    axis,
                    distance,
                    expected,
                });
            }
        }
        Ok(())
    }

    /// Whether the motors jump to other velocities at the time of the last knot.
    fn check_jump(&self, to: &[Motion; N]) -> Result<(), KnotError> {
        let axes = to.iter().zip(self.last).zip(self.start_stop).enumerate();
        for (axis, ((to, last), max)) in axes {
            let jump = (to.velocity - last.velocity).abs();
            let rounding = ROUNDING * (to.velocity.abs() + last.velocity.abs());
            // A limit that is no number allows none, not even of 0.
            let is_within = jump <= max + rounding;
            if !is_within {
                return Err(KnotError::Jump { axis, jump, max });
            }
        }
        Ok(())
    }

    /// A row of no time that sets other velocities at the last knot, however different.
    ///
    /// # Errors
    /// [`KnotError::Velocity`].
    pub fn jump(&mut self, velocities: [f64; N]) -> Result<PvtRow<N>, KnotError> {
        let to = self.motions([0.0; N], velocities);
        self.jump_to(&to)
    }

    /// A row of no time to other velocities.
    fn jump_to(&mut self, to: &[Motion; N]) -> Result<PvtRow<N>, KnotError> {
        let velocities = rounded(to)?;
        for ((last, to), (knot, new)) in self
            .last
            .iter_mut()
            .zip(to)
            .zip(self.knots.iter_mut().zip(velocities))
        {
            last.velocity = to.velocity;
            knot.velocity = new.velocity;
        }
        Ok(PvtRow {
            ticks: 0,
            knots: self.knots,
        })
    }

    /// In steps and ticks.
    fn motions(&self, positions: [f64; N], velocities: [f64; N]) -> [Motion; N] {
        let mut motions = [Motion::default(); N];
        let given = positions.into_iter().zip(velocities);
        for ((motion, (position, velocity)), steps_per_unit) in
            motions.iter_mut().zip(given).zip(self.steps_per_unit)
        {
            *motion = Motion {
                position: position * steps_per_unit,
                velocity: velocity * steps_per_unit / self.tick_hz,
            };
        }
        motions
    }
}

/// A rate in Hz.
pub(crate) fn hz(rate: Rate) -> f64 {
    f64::from(rate.numerator()) / f64::from(rate.denominator())
}

/// Position in steps, velocity in steps a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Motion {
    position: f64,
    velocity: f64,
}

impl Motion {
    /// Where the cubic from `self` to `to` in `ticks` is `early` ticks before its end.
    fn before(self, to: Self, ticks: f64, early: f64) -> Self {
        let mean = (to.position - self.position) / ticks;
        let (v0, v1) = (self.velocity, to.velocity);
        let acceleration = (2.0 * v0 + 4.0 * v1 - 6.0 * mean) / ticks;
        let jerk = (6.0 * (v0 + v1) - 12.0 * mean) / (ticks * ticks);
        Self {
            position: to.position
                - early * (v1 - early * (acceleration / 2.0 - early * jerk / 6.0)),
            velocity: v1 - early * (acceleration - early * jerk / 2.0),
        }
    }
}

fn rounded<const N: usize>(motions: &[Motion; N]) -> Result<[PvtKnot; N], KnotError> {
    let mut knots = [PvtKnot::default(); N];
    for (axis, (knot, motion)) in knots.iter_mut().zip(motions).enumerate() {
        let &Motion { position, velocity } = motion;
        *knot = PvtKnot {
            position: nearest(position * POSITION_UNITS)
                .ok_or(KnotError::Position { axis, position })?,
            velocity: nearest(velocity * VELOCITY_UNITS)
                .ok_or(KnotError::Velocity { axis, velocity })?,
        };
    }
    Ok(knots)
}

/// The nearest whole number, halves away from zero; `None` past 63 bits.
fn nearest(value: f64) -> Option<i64> {
    const LIMIT: f64 = (1_u64 << 63) as f64;
    let away = if value < 0.0 { -0.5 } else { 0.5 };
    // From 2^53 on there is no fraction, and the sum changes nothing or rounds to even.
    (value.abs() < LIMIT).then_some((value + away) as i64)
}
