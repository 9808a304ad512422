//! Motion from rest to rest with limited speed, acceleration and jerk.

use nalgebra::RealField;

use crate::number::{count, cube_root, half, two};

/// Seven phases of constant jerk over a way of 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SCurve<T> {
    /// Duration and jerk of each phase.
    phases: [(T, T); 7],
}

/// State of the motion: way, speed, acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Motion<T> {
    pub(super) way: T,
    pub(super) speed: T,
    acceleration: T,
}

/// Share of a ramp's time below which a phase is left out.
const NEGLIGIBLE: f64 = 1e-3;

/// Most parts that are needed for seven phases.
pub(super) const PHASES: u32 = 7;

impl<T: RealField + Copy> SCurve<T> {
    /// The shortest motion with these limits, in 1/s, 1/s² and 1/s³.
    pub(super) fn new(speed: T, acceleration: T, jerk: T) -> Self {
        let top = speed.min(Self::top_of_short_way(acceleration, jerk));
        // Whether the acceleration is reached before the speed.
        let (rise, hold) = if top * jerk > acceleration * acceleration {
            let rise = acceleration / jerk;
            (rise, top / acceleration - rise)
        } else {
            ((top / jerk).sqrt(), T::zero())
        };
        // Both ramps together make the way top · (2 rise + hold).
        let ramps = top * (two::<T>() * rise + hold);
        let cruise = (T::one() - ramps) / top;
        let zero = T::zero();
        // Next to nothing would be a segment of its own.
        let least = (two::<T>() * rise + hold) * nalgebra::convert(NEGLIGIBLE);
        let kept = |time: T| if time > least { time } else { zero };
        let (hold, cruise) = (kept(hold), kept(cruise));
        let mut curve = Self {
            phases: [
                (rise, jerk),
                (hold, zero),
                (rise, -jerk),
                (cruise, zero),
                (rise, -jerk),
                (hold, zero),
                (rise, jerk),
            ],
        };
        let way = curve.end().way;
        for (_, jerk) in &mut curve.phases {
            *jerk /= way;
        }
        curve
    }

    fn end(&self) -> Motion<T> {
        let phases = self.phases.iter();
        phases.fold(Motion::rest(), |state, (time, jerk)| {
            state.after(*time, *jerk)
        })
    }

    /// The top speed with which both ramps together make the whole way.
    ///
    /// ```text
    /// v (v/A + A/J) = 1      where A is reached,  v J ≥ A²
    /// v · 2 √(v/J) = 1       else
    /// ```
    fn top_of_short_way(acceleration: T, jerk: T) -> T {
        let rise = acceleration / jerk;
        let four = two::<T>() + two();
        let root = (rise * rise + four / acceleration).sqrt();
        // A (√(rise² + 4/A) - rise) / 2, without cancellation.
        let top = two::<T>() / (root + rise);
        if top * jerk >= acceleration * acceleration {
            top
        } else {
            cube_root(jerk / four)
        }
    }

    /// Calls `knot` with the state and the time to the next for `parts` parts, each within a
    /// phase, and with the end.
    pub(super) fn knots(&self, parts: u32, mut knot: impl FnMut(Motion<T>, T)) {
        let total = self
            .phases
            .iter()
            .fold(T::zero(), |sum, (time, _)| sum + *time);
        let used = self.phases.iter().filter(|(time, _)| *time > T::zero());
        let mut phases_left = used.count().try_into().unwrap_or(PHASES);
        let (mut parts_left, mut time_left) = (parts, total);
        let mut state = Motion::rest();
        for (time, jerk) in self.phases {
            if time <= T::zero() {
                continue;
            }
            phases_left = u32::saturating_sub(phases_left, 1);
            // One part at least, and one for each phase to come.
            let free = parts_left.saturating_sub(phases_left).max(1);
            let parts = share(free, time / time_left).min(free).max(1);
            let parts = if phases_left == 0 { parts_left } else { parts };
            let step = time / count(parts);
            for part in 0..parts {
                knot(state.after(step * count(part), jerk), step);
            }
            state = state.after(time, jerk);
            parts_left = parts_left.saturating_sub(parts);
            time_left -= time;
        }
        let end = Motion {
            way: T::one(),
            ..Motion::rest()
        };
        knot(end, T::zero());
    }
}

/// The share of a count, rounded.
pub(super) fn share<T: RealField + Copy>(whole: u32, share: T) -> u32 {
    let value: Option<f64> = nalgebra::try_convert((count::<T>(whole) * share).round());
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of a u32; a cast saturates"
    )]
    value.map_or(0, |value| value as u32)
}

impl<T: RealField + Copy> Motion<T> {
    fn rest() -> Self {
        Self {
            way: T::zero(),
            speed: T::zero(),
            acceleration: T::zero(),
        }
    }

    fn after(self, time: T, jerk: T) -> Self {
        let third = T::one() / nalgebra::convert(3.0);
        let speeding = self.acceleration + jerk * time * half();
        let way = self.speed + (self.acceleration + jerk * time * third) * time * half();
        Self {
            way: self.way + way * time,
            speed: self.speed + speeding * time,
            acceleration: self.acceleration + jerk * time,
        }
    }
}
