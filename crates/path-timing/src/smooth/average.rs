//! A motion averaged over a window of time.

use crate::Knot;
use crate::profile::segment_s;

/// The mean of a motion s(t) along legs over the window before t, computed at the knots of that motion.
///
/// ```text
/// s̄(t) = 1/w ∫ s(u) du,  u = t - w..t      ds̄/dt = (s(t) - s(t - w)) / w
/// ```
///
/// Before the motion s is 0, after it the length. Between two knots the speed of s is linear in time;
/// so between two times at which t or t - w is at a knot, s̄ is a cubic of the time. The mean lasts
/// w longer than what it is taken of.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Average {
    window_s: f64,
    /// s(t), and s(t - w).
    head: End,
    tail: End,
    /// s(t) - s(t - w).
    gap: f64,
    /// The next knot.
    knot: usize,
}

/// An end of the window: the rest of the segment that it is on.
#[derive(Debug, Clone, Copy)]
struct End {
    /// The knot after the segment.
    next: usize,
    left_s: f64,
    speed: f64,
    acceleration: f64,
}

/// Rounds of a search for a root: each halves what is left, mostly much less is.
const ROUNDS: u32 = 64;

/// Relative change at which a root is found.
const CLOSE: f64 = 4.0 * f64::EPSILON;

impl End {
    /// At rest before the motion, or after it.
    fn at_rest(next: usize, left_s: f64) -> Self {
        Self {
            next,
            left_s,
            speed: 0.0,
            acceleration: 0.0,
        }
    }

    /// Goes on by a time within the segment, and enters the next where it ends.
    fn go_on(&mut self, time_s: f64, knots: &[Knot]) {
        self.speed += self.acceleration * time_s;
        self.left_s -= time_s;
        while self.left_s <= 0.0 {
            self.enter(knots);
        }
    }

    fn enter(&mut self, knots: &[Knot]) {
        let ends = (knots.get(self.next), knots.get(self.next.saturating_add(1)));
        let (Some(from), Some(to)) = ends else {
            *self = Self::at_rest(self.next, f64::INFINITY);
            return;
        };
        self.next = self.next.saturating_add(1);
        if to.s <= 0.0 {
            // The same point on the next leg.
            return;
        }
        self.left_s = segment_s(from, to);
        self.speed = from.speed;
        self.acceleration = (to.speed - from.speed) / self.left_s;
    }
}

impl Average {
    /// At rest at the first of the knots.
    pub(crate) fn new(window_s: f64, knots: &[Knot]) -> Self {
        let mut head = End::at_rest(0, 0.0);
        head.enter(knots);
        Self {
            window_s,
            head,
            tail: End::at_rest(0, window_s),
            gap: 0.0,
            knot: 0,
        }
    }

    /// The speed at the next knot, and the time to it from the one before.
    pub(crate) fn next(&mut self, knots: &[Knot]) -> [f64; 2] {
        let before = self
            .knot
            .checked_sub(1)
            .and_then(|before| knots.get(before));
        let ends = (before, knots.get(self.knot));
        self.knot = self.knot.saturating_add(1);
        let (Some(from), Some(to)) = ends else {
            return [0.0; 2];
        };
        let mut time_s = 0.0;
        if self.knot >= knots.len() {
            // To the end of the motion.
            while let Some(step_s) = self.step_s() {
                time_s += step_s;
                self.go_on(step_s, knots);
            }
            return [0.0, time_s];
        }
        if to.s > 0.0 {
            let mut missing = (to.s - from.s) * self.window_s;
            while let Some(step_s) = self.step_s() {
                let rise = self.rise(step_s);
                if rise >= missing {
                    let part_s = self.time_of(missing, step_s, rise);
                    time_s += part_s;
                    self.go_on(part_s, knots);
                    break;
                }
                missing -= rise;
                time_s += step_s;
                self.go_on(step_s, knots);
            }
        }
        [self.gap / self.window_s, time_s]
    }

    /// The time to the next knot of either end of the window; none after the motion.
    fn step_s(&self) -> Option<f64> {
        let step_s = self.head.left_s.min(self.tail.left_s);
        step_s.is_finite().then_some(step_s)
    }

    fn go_on(&mut self, time_s: f64, knots: &[Knot]) {
        let [speed, acceleration] = self.growth();
        self.gap += (speed + acceleration * time_s * 0.5) * time_s;
        self.head.go_on(time_s, knots);
        self.tail.go_on(time_s, knots);
    }

    /// First and second derivative of the gap.
    fn growth(&self) -> [f64; 2] {
        [
            self.head.speed - self.tail.speed,
            self.head.acceleration - self.tail.acceleration,
        ]
    }

    /// By how much w s̄ grows in a time.
    fn rise(&self, time_s: f64) -> f64 {
        let [speed, acceleration] = self.growth();
        (self.gap + (speed + acceleration * time_s / 3.0) * time_s * 0.5) * time_s
    }

    /// The time in which w s̄ grows by `wanted`, at most that of `rise`, which takes `most_s`.
    fn time_of(&self, wanted: f64, most_s: f64, rise: f64) -> f64 {
        let [speed, acceleration] = self.growth();
        let (mut low, mut high) = (0.0, most_s);
        let mut time_s = most_s * (wanted / rise);
        for _ in 0..ROUNDS {
            let off = self.rise(time_s) - wanted;
            if off > 0.0 {
                high = time_s;
            } else {
                low = time_s;
            }
            let slope = self.gap + (speed + acceleration * time_s * 0.5) * time_s;
            let newton = time_s - off / slope;
            let next = if newton > low && newton < high {
                newton
            } else {
                (low + high) * 0.5
            };
            let change = (next - time_s).abs();
            time_s = next;
            if change <= time_s * CLOSE {
                break;
            }
        }
        time_s
    }
}

#[cfg(test)]
mod tests {
    use super::{Average, Knot};

    const TIMES: [f64; 6] = [0.3, 0.1, 0.5, 0.2, 0.4, 0.25];
    const SPEEDS: [f64; 7] = [0.0, 0.9, 0.6, 0.75, 0.75, 0.2, 0.0];
    /// Of the sum that stands for an integral.
    const SLICES: u32 = 20_000;
    /// What the sum is off by.
    const TOLERANCE: f64 = 1e-8;

    /// Position and speed at a time, from the numbers above alone.
    fn motion(time: f64) -> [f64; 2] {
        let (mut s, mut left) = (0.0, time.max(0.0));
        for (duration, pair) in TIMES.iter().zip(SPEEDS.windows(2)) {
            let rate = (pair[1] - pair[0]) / duration;
            let within = left.min(*duration);
            s += (pair[0] + rate * within / 2.0) * within;
            if left <= *duration {
                return [s, pair[0] + rate * left];
            }
            left -= duration;
        }
        [s, 0.0]
    }

    /// The motion's knots, on two legs.
    fn knots() -> [Knot; 8] {
        let mut time = 0.0;
        let mut start = 0.0;
        let mut knots = [Knot::default(); 8];
        let mut rest = knots.iter_mut();
        for (number, (duration, speed)) in TIMES.iter().chain([&0.0]).zip(SPEEDS).enumerate() {
            let [s, _] = motion(time);
            let mut lay = |s| {
                let knot = rest.next().unwrap();
                (knot.s, knot.speed) = (s, speed);
            };
            lay(s - start);
            if number == 3 {
                start = s;
                lay(0.0);
            }
            time += duration;
        }
        knots
    }

    #[test]
    fn a_window_of_any_length_takes_the_mean() {
        let total: f64 = TIMES.iter().sum();
        for window in [0.01, 0.35, 1.1, 1.75, 9.0] {
            let knots = knots();
            let mut average = Average::new(window, &knots);
            let (mut time, mut start) = (0.0, 0.0);
            for (number, knot) in knots.iter().enumerate() {
                let [speed, segment_s] = average.next(&knots);
                time += segment_s;
                if number == 4 {
                    start = knots[3].s;
                }
                let slice = window / f64::from(SLICES);
                let sum: f64 = (0..SLICES)
                    .map(|slices| motion(time - (f64::from(slices) + 0.5) * slice)[0])
                    .sum();
                let mean = sum / f64::from(SLICES);
                let off = (start + knot.s - mean).abs();
                assert!(off < TOLERANCE, "{window} s at {time}: {off}");
                let gained = motion(time)[0] - motion(time - window)[0];
                assert!((speed - gained / window).abs() < TOLERANCE / window);
            }
            assert!((time - total - window).abs() < TOLERANCE);
        }
    }
}
