//! Turns under the law that loses its overshoot: speeds are found by looking where they end.

use super::super::motor::ticks;
use super::super::{Easing, Motor};

/// Frames at the end of a turn whose speeds are searched together.
const ENDING: u16 = 3;

/// By how many half steps the frames before may run ahead of the way or stay behind it, so that the
/// last ones find their end: the widest gap between the half steps that one frame makes at a
/// threshold of 600, 33 to 40, and one more.
const MOST_AHEAD: i64 = 8;

/// A way, and the speeds of its last frames.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plan {
    start: i64,
    /// 1 or -1.
    direction: i8,
    /// At least 1.
    half_steps: i64,
    /// What the accumulator holds at the start.
    gathered: i64,
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
    /// How far off the way together, in parts of a half step.
    off_way: u64,
    magnitudes: [u8; ENDING as usize],
}

impl Plan {
    /// The plan that ends nearest to so many half steps, not 0, and how many it makes.
    pub(super) fn nearest(
        motor: Motor,
        half_steps: i32,
        frames: u16,
        easing: Easing,
    ) -> (Self, i64) {
        let direction = if half_steps < 0 { -1 } else { 1 };
        let mut plan = Self {
            start: motor.position,
            direction,
            half_steps: half_steps.unsigned_abs().into(),
            gathered: motor.gathered(direction.into()),
            frames,
            easing,
            ahead: 0,
            ending: [0; ENDING as usize],
        };
        let mut way = plan.find_ending(motor);
        for ahead in (1..=MOST_AHEAD).flat_map(|ahead| [ahead, ahead.saturating_neg()]) {
            let off = |way: i64| way.abs_diff(plan.half_steps);
            if off(way) == 0 {
                break;
            }
            let mut other = Self { ahead, ..plan };
            let other_way = other.find_ending(motor);
            if off(other_way) < off(way) {
                (plan, way) = (other, other_way);
            }
        }
        (plan, way)
    }

    /// The magnitude of the next frame.
    pub(super) fn magnitude(&self, motor: &Motor, made: u16) -> u8 {
        let left = self.frames.saturating_sub(made);
        match self.ending.get(usize::from(ENDING.wrapping_sub(left))) {
            Some(magnitude) => *magnitude,
            None => self.tracked(motor, made),
        }
    }

    /// Sets the speeds of the last frames, from the start; the half steps that come of it.
    fn find_ending(&mut self, mut motor: Motor) -> i64 {
        let before = self.frames.saturating_sub(ENDING);
        for made in 0..before {
            motor = self.after(&motor, self.tracked(&motor, made));
        }
        self.ending = self.search(&motor, before, u32::MAX.into()).magnitudes;
        for made in before..self.frames {
            motor = self.after(&motor, self.magnitude(&motor, made));
        }
        self.way(&motor)
    }

    /// Half steps made so far, in the direction of the turn.
    fn way(&self, motor: &Motor) -> i64 {
        let way = motor.position.saturating_sub(self.start);
        way.saturating_mul(self.direction.into())
    }

    /// The same in parts of a half step, of which the threshold is one, with those that the
    /// accumulator holds: a frame may be shorter than a step.
    fn parts(&self, motor: &Motor) -> i64 {
        let steps = self.way(motor).saturating_mul(motor.threshold());
        steps.saturating_add(motor.gathered(self.direction.into()))
    }

    /// The parts that are wanted after a number of frames.
    fn wanted(&self, motor: &Motor, frame: u16) -> i64 {
        let threshold = motor.threshold();
        let end = self.half_steps.saturating_mul(threshold);
        if frame == self.frames {
            return end;
        }
        let whole = end.saturating_sub(self.gathered).max(0).cast_unsigned();
        let way = self.easing.way(whole, frame, self.frames).cast_signed();
        let run_ahead = i64::from(frame)
            .saturating_mul(self.ahead)
            .saturating_mul(threshold)
            .checked_div(self.frames.into());
        self.gathered
            .saturating_add(way)
            .saturating_add(run_ahead.unwrap_or(0))
    }

    /// The motor after one more frame.
    fn after(&self, motor: &Motor, magnitude: u8) -> Motor {
        let mut motor = *motor;
        motor.run(magnitude.cast_signed().saturating_mul(self.direction));
        motor
    }

    /// The distinct speed that ends the next frame nearest to the way, and not beyond its end.
    fn tracked(&self, motor: &Motor, made: u16) -> u8 {
        let wanted = self.wanted(motor, made.saturating_add(1));
        // More speed makes no fewer half steps, and as many with no less in the accumulator.
        let slow_and_fast = either_side(motor.max_speed(), |magnitude| {
            let motor = self.after(motor, slowest(motor, magnitude));
            self.way(&motor) > self.half_steps || self.parts(&motor) >= wanted
        });
        let within = slow_and_fast
            .into_iter()
            .map(|magnitude| slowest(motor, magnitude))
            .map(|magnitude| (magnitude, self.after(motor, magnitude)))
            .filter(|(_, motor)| self.way(motor) <= self.half_steps);
        let nearest = within.min_by_key(|(_, motor)| self.parts(motor).abs_diff(wanted));
        nearest.map_or(0, |(magnitude, _)| magnitude)
    }

    /// The best speeds of the frames from `frame` on, at most the last ones. Speeds more than
    /// `most_off` half steps from the end are not looked at.
    fn search(&self, motor: &Motor, frame: u16, most_off: u64) -> Ending {
        let mut best = Ending {
            off_end: most_off,
            off_way: u64::MAX,
            magnitudes: [0; ENDING as usize],
        };
        let next = frame.saturating_add(1);
        let place = usize::from(ENDING.wrapping_sub(self.frames.saturating_sub(frame)));
        let wanted = self.wanted(motor, next);
        let mut look_at = |magnitude, after: &Motor, mut ending: Ending| {
            let off = self.parts(after).abs_diff(wanted);
            ending.off_way = ending.off_way.saturating_add(off);
            if let Some(own) = ending.magnitudes.get_mut(place) {
                *own = magnitude;
            }
            best = best.min(ending);
            best.off_end
        };
        if next >= self.frames {
            // What has been gathered makes also equal speeds differ in their first step.
            let reaches = |magnitude| self.way(&self.after(motor, magnitude)) >= self.half_steps;
            for magnitude in either_side(motor.max_speed(), reaches) {
                let after = self.after(motor, magnitude);
                let ending = Ending {
                    off_end: self.way(&after).abs_diff(self.half_steps),
                    off_way: 0,
                    magnitudes: [0; ENDING as usize],
                };
                look_at(magnitude, &after, ending);
            }
            return best;
        }
        let (reach, mut off_end) = (self.reach(motor, next), most_off);
        for magnitude in distinct(motor) {
            let after = self.after(motor, magnitude);
            let (way, off) = (self.way(&after), off_end.cast_signed());
            // No speed leads back, and the next ones go further.
            if way > self.half_steps.saturating_add(off) {
                break;
            }
            // The highest speed to the end is not enough.
            if way.saturating_add(reach) < self.half_steps.saturating_sub(off) {
                continue;
            }
            off_end = look_at(magnitude, &after, self.search(&after, next, off_end));
        }
        best
    }

    /// The most half steps from a frame to the end.
    fn reach(&self, motor: &Motor, frame: u16) -> i64 {
        let period = ticks(motor.threshold(), motor.max_speed().into());
        let frames = i64::from(self.frames.saturating_sub(frame));
        // What has been gathered may add one step.
        let all = frames.saturating_mul(motor.frame_ticks());
        let steps = period.and_then(|period| all.checked_div(period));
        steps.unwrap_or(0).saturating_add(frames)
    }
}

/// Of the speeds with as many ticks between half steps as this one the slowest, which loses least.
fn slowest(motor: &Motor, magnitude: u8) -> u8 {
    let period = ticks(motor.threshold(), magnitude.into());
    let slowest = period.and_then(|period| ticks(motor.threshold(), period));
    // Not above the speed itself.
    slowest
        .and_then(|slowest| u8::try_from(slowest).ok())
        .unwrap_or(0)
}

/// The speeds that differ under the law.
fn distinct(motor: &Motor) -> impl Iterator<Item = u8> + use<> {
    let motor = *motor;
    let all = 0..=motor.max_speed();
    all.filter(move |magnitude| slowest(&motor, *magnitude) == *magnitude)
}

/// The fastest speed that does not fulfil a condition, and the slowest that does; the same one twice
/// where only one of them is there. With a speed all faster ones up to the highest fulfil it.
fn either_side(highest: u8, fulfils: impl Fn(u8) -> bool) -> [u8; 2] {
    if fulfils(0) {
        return [0; 2];
    }
    if !fulfils(highest) {
        return [highest; 2];
    }
    let (mut slow, mut fast) = (0, highest);
    while fast.abs_diff(slow) > 1 {
        let middle = slow.midpoint(fast);
        if fulfils(middle) {
            fast = middle;
        } else {
            slow = middle;
        }
    }
    [slow, fast]
}
