//! Turns under the law that loses its overshoot: speeds are found by looking where they end.

mod exhaustive;

use crate::easing::Easing;
use crate::motor::{Motor, ticks_to};

/// Frames at the end of a turn whose speeds are searched together.
const ENDING: u16 = 3;

/// By how many half steps the frames before may run ahead of the easing or lag, so that the last
/// ones find their end: the widest gap between the half steps that one frame makes at a
/// threshold of 600, 33 to 40, and one more.
const MAX_AHEAD: i64 = 8;

/// The magnitudes of the plan that ends nearest to `half_steps`, not 0, in `frames`, not 0.
pub(super) fn magnitudes(motor: Motor, half_steps: i32, frames: u16, easing: Easing) -> Vec<u8> {
    let direction = if half_steps < 0 { -1 } else { 1 };
    let mut plan = Plan {
        start: motor,
        direction,
        half_steps: half_steps.unsigned_abs().into(),
        accumulated: motor.accumulated(direction.into()),
        frames,
        easing,
        ahead: 0,
        ending: [0; ENDING as usize],
    };
    let mut off = plan.find_ending();
    for ahead in (1..=MAX_AHEAD).flat_map(|ahead| [ahead, -ahead]) {
        if off == 0 {
            break;
        }
        let mut other = Plan { ahead, ..plan };
        let other_off = other.find_ending();
        if other_off < off {
            (plan, off) = (other, other_off);
        }
    }
    let exhaustive = match off {
        0 | 1 => None,
        _ => exhaustive::magnitudes(&Plan { ahead: 0, ..plan }),
    };
    exhaustive.unwrap_or_else(|| plan.magnitudes(frames))
}

/// An eased distance, and the speeds of its last frames.
#[derive(Debug, Clone, Copy)]
struct Plan {
    start: Motor,
    /// 1 or -1.
    direction: i8,
    /// At least 1.
    half_steps: i64,
    /// What the accumulator holds at the start.
    accumulated: i64,
    /// At least 1.
    frames: u16,
    easing: Easing,
    /// Half steps by which the frames before the last run ahead.
    ahead: i64,
    /// Magnitudes of the last frames; of fewer frames the last of them.
    ending: [u8; ENDING as usize],
}

/// Speeds of the last frames, compared in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Ending {
    /// How far off the end they are, in half steps.
    off_end: u64,
    /// How far off the easing together, in parts of a half step.
    off_easing: u64,
    magnitudes: [u8; ENDING as usize],
}

impl Plan {
    /// The magnitudes of the first frames.
    fn magnitudes(&self, frames: u16) -> Vec<u8> {
        let mut motor = self.start;
        let magnitudes = (0..frames).map(|made| {
            let magnitude = self.magnitude(&motor, made);
            motor = self.after(&motor, magnitude);
            magnitude
        });
        magnitudes.collect()
    }

    /// The magnitude of the next frame.
    fn magnitude(&self, motor: &Motor, made: u16) -> u8 {
        match self.ending.get(self.index_in_ending(made)) {
            Some(magnitude) => *magnitude,
            None => self.tracked(motor, made),
        }
    }

    /// Index of a frame among the last ones; past them for a frame before.
    fn index_in_ending(&self, frame: u16) -> usize {
        usize::from(ENDING.wrapping_sub(self.frames - frame))
    }

    /// The motor before a frame, from the start.
    fn before(&self, frame: u16) -> Motor {
        let tracked = |motor, made| self.after(&motor, self.tracked(&motor, made));
        (0..frame).fold(self.start, tracked)
    }

    /// Sets the speeds of the last frames; by how many half steps they miss the end.
    fn find_ending(&mut self) -> u64 {
        let first = self.frames.saturating_sub(ENDING);
        let mut motor = self.before(first);
        self.ending = self.search(&motor, first, u32::MAX.into()).magnitudes;
        for made in first..self.frames {
            motor = self.after(&motor, self.magnitude(&motor, made));
        }
        self.distance(&motor).abs_diff(self.half_steps)
    }

    /// Half steps made so far, in the direction of the turn.
    fn distance(&self, motor: &Motor) -> i64 {
        (motor.position() - self.start.position()) * i64::from(self.direction)
    }

    /// The same in parts of a half step, of which the threshold is one, with those that the
    /// accumulator holds: a frame may be shorter than a step.
    fn parts(&self, motor: &Motor) -> i64 {
        self.distance(motor) * motor.threshold() + motor.accumulated(self.direction.into())
    }

    /// The parts that are wanted after a number of frames.
    fn wanted(&self, frame: u16) -> i64 {
        let threshold = self.start.threshold();
        let end = self.half_steps * threshold;
        if frame == self.frames {
            return end;
        }
        let whole = (end - self.accumulated).max(0).cast_unsigned();
        let eased = self
            .easing
            .position(whole, frame, self.frames)
            .cast_signed();
        let run_ahead = i64::from(frame) * self.ahead * threshold / i64::from(self.frames);
        self.accumulated + eased + run_ahead
    }

    /// The motor after one more frame.
    fn after(&self, motor: &Motor, magnitude: u8) -> Motor {
        let mut motor = *motor;
        // At most 127.
        motor.run(magnitude.cast_signed() * self.direction);
        motor
    }

    /// The distinct speed that ends the next frame nearest to the easing, and not beyond its end.
    fn tracked(&self, motor: &Motor, made: u16) -> u8 {
        let wanted = self.wanted(made + 1);
        // More speed makes no fewer half steps, and as many with no less in the accumulator.
        let slow_and_fast = either_side(motor.max_speed(), |magnitude| {
            let motor = self.after(motor, slowest(motor, magnitude));
            self.distance(&motor) > self.half_steps || self.parts(&motor) >= wanted
        });
        let within = slow_and_fast
            .into_iter()
            .map(|magnitude| slowest(motor, magnitude))
            .map(|magnitude| (magnitude, self.after(motor, magnitude)))
            .filter(|(_, motor)| self.distance(motor) <= self.half_steps);
        let nearest = within.min_by_key(|(_, motor)| self.parts(motor).abs_diff(wanted));
        // Rest, where any speed goes beyond the end.
        nearest.map_or(0, |(magnitude, _)| magnitude)
    }

    /// The best speeds of the frames from `frame` on, at most the last ones. Speeds more than
    /// `max_off` half steps from the end are not looked at.
    fn search(&self, motor: &Motor, frame: u16, max_off: u64) -> Ending {
        let mut best = Ending {
            off_end: max_off,
            off_easing: u64::MAX,
            magnitudes: [0; ENDING as usize],
        };
        let next = frame + 1;
        let index = self.index_in_ending(frame);
        let wanted = self.wanted(next);
        let mut look_at = |magnitude, after: &Motor, mut ending: Ending| {
            let off = self.parts(after).abs_diff(wanted);
            ending.off_easing = ending.off_easing.saturating_add(off);
            if let Some(own) = ending.magnitudes.get_mut(index) {
                *own = magnitude;
            }
            best = best.min(ending);
            best.off_end
        };
        if next == self.frames {
            // What has been accumulated makes also equal speeds differ in their first step.
            let reaches =
                |magnitude| self.distance(&self.after(motor, magnitude)) >= self.half_steps;
            for magnitude in either_side(motor.max_speed(), reaches) {
                let after = self.after(motor, magnitude);
                let ending = Ending {
                    off_end: self.distance(&after).abs_diff(self.half_steps),
                    off_easing: 0,
                    magnitudes: [0; ENDING as usize],
                };
                look_at(magnitude, &after, ending);
            }
            return best;
        }
        let (reach, mut off_end) = (self.reach(next), max_off);
        let speeds = 0..=motor.max_speed();
        for magnitude in speeds.filter(|magnitude| slowest(motor, *magnitude) == *magnitude) {
            let after = self.after(motor, magnitude);
            let (distance, off) = (self.distance(&after), off_end.cast_signed());
            // No speed leads back, and the next ones go further.
            if distance > self.half_steps + off {
                break;
            }
            // The highest speed to the end is not enough.
            if distance + reach < self.half_steps - off {
                continue;
            }
            off_end = look_at(magnitude, &after, self.search(&after, next, off_end));
        }
        best
    }

    /// Upper bound of the half steps from a frame to the end.
    fn reach(&self, frame: u16) -> i64 {
        let max_speed = i64::from(self.start.max_speed());
        if max_speed == 0 {
            return 0;
        }
        let frames = i64::from(self.frames - frame);
        let ticks = frames * self.start.frame_ticks();
        // What has been accumulated may add one step.
        ticks / ticks_to(self.start.threshold(), max_speed) + frames
    }
}

/// Of the speeds with as many ticks between half steps as this one the slowest, which loses least.
fn slowest(motor: &Motor, magnitude: u8) -> u8 {
    if magnitude == 0 {
        return 0;
    }
    let period = ticks_to(motor.threshold(), magnitude.into());
    // Not above the speed itself.
    let [slowest, ..] = ticks_to(motor.threshold(), period).to_le_bytes();
    slowest
}

/// The fastest speed that does not fulfil a condition, and the slowest that does; the same one
/// twice where only one of them is there. With a speed all faster ones up to the highest fulfil it.
fn either_side(highest: u8, fulfils: impl Fn(u8) -> bool) -> [u8; 2] {
    if fulfils(0) {
        return [0; 2];
    }
    if !fulfils(highest) {
        return [highest; 2];
    }
    let (mut slow, mut fast) = (0, highest);
    while fast - slow > 1 {
        let middle = slow.midpoint(fast);
        if fulfils(middle) {
            fast = middle;
        } else {
            slow = middle;
        }
    }
    [slow, fast]
}
