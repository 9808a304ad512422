//! A motion averaged over a window of time.

use crate::Knot;

/// Replaces the motion s(t) of all segments but the last `late` by its mean over the `window_s`
/// before t, and lets those run it out.
///
/// ```text
/// s̄(t) = 1/w ∫ s(u) du,  u = t - w..t      ds̄/dt = (s(t) - s(t - w)) / w
/// ```
///
/// Before the motion s is 0, after it the length. The mean at t needs nothing later than t: from the end
/// to the start it is taken in place. The integral is kept as that of s(t) - s(u), which has the
/// digits of near positions.
pub(crate) fn average(knots: &mut [Knot], late: u32, window_s: f64, length: f64) {
    let late_knots = usize::try_from(late).unwrap_or(usize::MAX);
    let end = knots.len().saturating_sub(1);
    let last = end.saturating_sub(late_knots);
    let Some(mut now) = knots.get(last).copied() else {
        return;
    };
    let mut tail = Tail::new(last, now);
    let mut lag = 0.0;
    for index in (0..end).rev() {
        let (before, gained) = match knots.get(index) {
            Some(before) if index < last => (*before, lag_of_segment(before, &now)),
            _ => {
                let duration_s = window_s / f64::from(late);
                (Knot { duration_s, ..now }, 0.0)
            }
        };
        let time = before.duration_s;
        lag -= gained + (now.s - before.s) * (window_s - time);
        lag += tail.back(knots, time, before.s);
        now = before;
        if let Some(knot) = knots.get_mut(index) {
            *knot = Knot {
                s: now.s - lag / window_s,
                speed: (now.s - tail.s()) / window_s,
                duration_s: time,
                after: 0.0,
            };
        }
    }
    if let Some(knot) = knots.last_mut() {
        *knot = Knot {
            s: length,
            ..Knot::default()
        };
    }
    if let Some(knot) = knots.first_mut() {
        (knot.s, knot.speed) = (0.0, 0.0);
    }
}

/// ∫ (s(end) - s(u)) du over a segment of even acceleration: h² (v₀ + 2 v₁) / 6.
fn lag_of_segment(from: &Knot, to: &Knot) -> f64 {
    let time = from.duration_s;
    (from.speed + to.speed + to.speed) * time * time / 6.0
}

/// Where the window begins, moving back along the motion.
struct Tail {
    /// Knots before the segment.
    index: usize,
    /// The segment's first knot; at rest at 0 before the motion.
    from: Knot,
    acceleration: f64,
    /// Time since the segment's first knot.
    offset_s: f64,
}

impl Tail {
    /// At a knot.
    fn new(index: usize, knot: Knot) -> Self {
        Self {
            index,
            from: knot,
            acceleration: 0.0,
            offset_s: 0.0,
        }
    }

    fn s(&self) -> f64 {
        let mean = self.from.speed + self.acceleration * self.offset_s * 0.5;
        self.from.s + mean * self.offset_s
    }

    /// Goes back by a time; ∫ (s - s(u)) du over it.
    fn back(&mut self, knots: &[Knot], time: f64, s: f64) -> f64 {
        let mut left = time;
        let mut integral = 0.0;
        while left > self.offset_s {
            left -= self.offset_s;
            integral += self.within(self.offset_s, s);
            let Some(index) = self.index.checked_sub(1) else {
                // Nothing has moved before.
                return integral + s * left;
            };
            self.enter(index, knots);
        }
        integral + self.within(left, s)
    }

    /// Goes back by a time within the segment.
    fn within(&mut self, time: f64, s: f64) -> f64 {
        self.offset_s -= time;
        let speed = self.from.speed + self.acceleration * self.offset_s;
        let mean = (speed + self.acceleration * time / 3.0) * time * 0.5;
        (s - self.s() - mean) * time
    }

    /// Enters a segment at its end.
    fn enter(&mut self, index: usize, knots: &[Knot]) {
        let Some(from) = knots.get(index).copied() else {
            return;
        };
        *self = Self {
            index,
            from,
            acceleration: (self.from.speed - from.speed) / from.duration_s,
            offset_s: from.duration_s,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::{Knot, average};

    const SEGMENTS: u32 = 6;
    const TIMES: [f64; 6] = [0.3, 0.1, 0.5, 0.2, 0.4, 0.25];
    const SPEEDS: [f64; 7] = [0.0, 0.9, 0.6, 0.75, 0.75, 0.2, 0.0];
    /// Of the sum that stands for an integral.
    const SLICES: u32 = 20_000;
    /// What the sum is off by, and a length that is 1 but for the last digits of its times.
    const TOLERANCE: f64 = 1e-8;

    /// Position and speed at a time, from the numbers above alone.
    fn motion(time: f64, scale: f64) -> [f64; 2] {
        let (mut s, mut left) = (0.0, time);
        if left <= 0.0 {
            return [0.0; 2];
        }
        for (duration, pair) in TIMES.iter().zip(SPEEDS.windows(2)) {
            let rate = (pair[1] - pair[0]) / duration;
            let within = left.min(*duration);
            s += (pair[0] + rate * within / 2.0) * within;
            if left <= *duration {
                return [s * scale, (pair[0] + rate * left) * scale];
            }
            left -= duration;
        }
        [1.0, 0.0]
    }

    /// The motion's knots, with room for late ones.
    fn knots(scale: f64) -> [Knot; 12] {
        let mut time = 0.0;
        let mut knots = [Knot::default(); 12];
        let times = TIMES.iter().chain([&0.0]);
        for ((knot, duration), speed) in knots.iter_mut().zip(times).zip(SPEEDS) {
            *knot = Knot {
                s: motion(time, scale)[0],
                speed: speed * scale,
                duration_s: *duration,
                after: 0.0,
            };
            time += duration;
        }
        knots
    }

    #[test]
    fn a_window_of_any_length_takes_the_mean() {
        let scale = 1.0 / motion(TIMES.iter().sum::<f64>() - 1e-15, 1.0)[0];
        for (late, window) in [(1, 0.01), (2, 0.35), (3, 1.1), (5, 1.75), (4, 9.0)] {
            let mut knots = knots(scale);
            let knots = &mut knots[..1 + (SEGMENTS + late) as usize];
            average(knots, late, window, 1.0);
            let knots = knots.iter();
            let mut time = 0.0;
            for knot in knots.clone() {
                let slice = window / f64::from(SLICES);
                let sum: f64 = (0..SLICES)
                    .map(|number| motion(time - (f64::from(number) + 0.5) * slice, scale)[0])
                    .sum();
                let mean = sum / f64::from(SLICES);
                assert!((knot.s - mean).abs() < TOLERANCE, "{window} s at {time}");
                let gained = motion(time, scale)[0] - motion(time - window, scale)[0];
                assert!((knot.speed - gained / window).abs() < TOLERANCE / window);
                time += knot.duration_s;
            }
            assert!((time - TIMES.iter().sum::<f64>() - window).abs() < TOLERANCE);
            let mut ends = knots.map(|knot| [knot.s, knot.speed]);
            assert_eq!(ends.next(), Some([0.0, 0.0]));
            assert_eq!(ends.next_back(), Some([1.0, 0.0]));
        }
    }
}
