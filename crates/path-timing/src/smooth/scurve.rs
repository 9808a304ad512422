//! Motion from rest to rest with limited speed, acceleration and jerk.

use crate::number::{cube_root, sqrt};

/// Seven phases of constant jerk over a length of 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SCurve {
    /// Duration and jerk of each phase.
    phases: [(f64, f64); 7],
}

/// State of the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Motion {
    /// Of the length.
    pub(crate) fraction: f64,
    pub(crate) speed: f64,
    acceleration: f64,
}

/// Fraction of a ramp's time below which a phase is left out.
const NEGLIGIBLE: f64 = 1e-3;

/// Most segments that are needed for seven phases.
pub(crate) const PHASES: u32 = 7;

impl SCurve {
    /// The shortest motion with these limits, in 1/s, 1/s² and 1/s³.
    pub(crate) fn new(speed: f64, acceleration: f64, jerk: f64) -> Self {
        let top = speed.min(Self::top_of_short_path(acceleration, jerk));
        // Whether the acceleration is reached before the speed.
        let (rise, hold) = if top * jerk > acceleration * acceleration {
            let rise = acceleration / jerk;
            (rise, top / acceleration - rise)
        } else {
            (sqrt(top / jerk), 0.0)
        };
        // Both ramps together take the length top · (2 rise + hold).
        let ramps = top * (2.0 * rise + hold);
        let cruise = (1.0 - ramps) / top;
        // Next to nothing would be a segment of its own.
        let least = (2.0 * rise + hold) * NEGLIGIBLE;
        let kept = |time: f64| if time > least { time } else { 0.0 };
        let (hold, cruise) = (kept(hold), kept(cruise));
        let mut curve = Self {
            phases: [
                (rise, jerk),
                (hold, 0.0),
                (rise, -jerk),
                (cruise, 0.0),
                (rise, -jerk),
                (hold, 0.0),
                (rise, jerk),
            ],
        };
        let length = curve.end().fraction;
        for (_, jerk) in &mut curve.phases {
            *jerk /= length;
        }
        curve
    }

    fn end(&self) -> Motion {
        let phases = self.phases.iter();
        phases.fold(Motion::rest(), |state, (time, jerk)| {
            state.after(*time, *jerk)
        })
    }

    /// The top speed with which both ramps together take the whole length.
    ///
    /// ```text
    /// v (v/A + A/J) = 1      where A is reached,  v J ≥ A²
    /// v · 2 √(v/J) = 1       else
    /// ```
    fn top_of_short_path(acceleration: f64, jerk: f64) -> f64 {
        let rise = acceleration / jerk;
        let root = sqrt(rise * rise + 4.0 / acceleration);
        // A (√(rise² + 4/A) - rise) / 2, without cancellation.
        let top = 2.0 / (root + rise);
        if top * jerk >= acceleration * acceleration {
            top
        } else {
            cube_root(jerk / 4.0)
        }
    }

    /// Calls `knot` with the state and the time to the next for each of `segments` segments, each within a
    /// phase, and with the end.
    pub(crate) fn knots(&self, segments: u32, mut knot: impl FnMut(Motion, f64)) {
        let total = self.phases.iter().fold(0.0, |sum, (time, _)| sum + *time);
        let used = self.phases.iter().filter(|(time, _)| *time > 0.0);
        let mut phases_left = used.fold(0_u32, |count, _| count.saturating_add(1));
        let (mut segments_left, mut time_left) = (segments, total);
        let mut state = Motion::rest();
        for (time, jerk) in self.phases {
            if time <= 0.0 {
                continue;
            }
            phases_left = phases_left.saturating_sub(1);
            // One segment at least, and one for each phase to come.
            let free = segments_left.saturating_sub(phases_left).max(1);
            let segments = part(free, time / time_left).min(free).max(1);
            let segments = if phases_left == 0 {
                segments_left
            } else {
                segments
            };
            let step = time / f64::from(segments);
            for number in 0..segments {
                knot(state.after(step * f64::from(number), jerk), step);
            }
            state = state.after(time, jerk);
            segments_left = segments_left.saturating_sub(segments);
            time_left -= time;
        }
        let end = Motion {
            fraction: 1.0,
            ..Motion::rest()
        };
        knot(end, 0.0);
    }
}

/// A fraction of a count, rounded.
pub(crate) fn part(whole: u32, fraction: f64) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a fraction of a u32; a cast saturates"
    )]
    let rounded = (f64::from(whole) * fraction + 0.5) as u32;
    rounded
}

impl Motion {
    fn rest() -> Self {
        Self {
            fraction: 0.0,
            speed: 0.0,
            acceleration: 0.0,
        }
    }

    fn after(self, time: f64, jerk: f64) -> Self {
        let speeding = self.acceleration + jerk * time * 0.5;
        let mean = self.speed + (self.acceleration + jerk * time / 3.0) * time * 0.5;
        Self {
            fraction: self.fraction + mean * time,
            speed: self.speed + speeding * time,
            acceleration: self.acceleration + jerk * time,
        }
    }
}
