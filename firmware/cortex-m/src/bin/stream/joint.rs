//! A joint: its steps from the batches, one after the other, two of them ahead of the timer.

use core::sync::atomic::Ordering;

use cortex_m_firmware::board::{StepTimer, Trace};
use pvt_steps::SegmentPlayer;
use stepper_sync::Direction;

use super::{Slots, next};

/// A timer this near to its end is left alone: what is set then may come too late.
const NEAR_TICKS: u32 = 200;

/// A step: ticks after the one before, and direction.
type Step = (u32, Direction);

pub struct Joint {
    /// The batch that steps are taken from.
    pub batch: u16,
    /// Steps since the start, made.
    pub made: i32,
    in_tail: bool,
    is_over: bool,
    segment: usize,
    player: SegmentPlayer,
    direction: Direction,
    /// Plan tick of the last step taken.
    taken: u64,
    /// The step whose ticks are counted now, and the one after it.
    now: Option<Step>,
    next: Option<Step>,
    pub trace: Trace,
}

enum Taken {
    Step(u64, Direction),
    Waits,
    Over,
}

impl Joint {
    pub const NEW: Self = Self {
        batch: 0,
        made: 0,
        in_tail: false,
        is_over: true,
        segment: 0,
        player: SegmentPlayer::new(),
        direction: Direction::Positive,
        taken: 0,
        now: None,
        next: None,
        trace: Trace::EMPTY,
    };

    /// At rest: goes on with a batch.
    pub fn begin(&mut self, batch: u16) {
        (self.batch, self.segment) = (batch, 0);
        (self.in_tail, self.is_over) = (false, false);
    }

    pub fn rests(&self) -> bool {
        self.is_over && self.now.is_none()
    }

    /// An edge at the pin, and the ticks of the step after the next.
    #[inline]
    pub fn step(&mut self, number: usize, timer: &StepTimer, slots: &Slots) {
        timer.clear_interrupt();
        let Some((_, direction)) = self.now else {
            return;
        };
        // A firmware with pins would change one here.
        self.trace.push(direction);
        self.made += match direction {
            Direction::Positive => 1,
            Direction::Negative => -1,
        };
        self.now = self.next.take();
        if self.now.is_none() {
            timer.stop();
            return;
        }
        if let Taken::Step(ticks, direction) = self.take(number, slots) {
            self.set_next(timer, ticks, direction);
        }
    }

    /// The main loop's part: steps for a joint that had none. `ticks_to` says how far a plan tick
    /// is.
    pub fn fill(
        &mut self,
        number: usize,
        timer: &StepTimer,
        slots: &Slots,
        ticks_to: impl FnOnce(u64) -> u64,
    ) {
        let is_near = self.now.is_some() && (timer.is_due() || timer.ticks_left() < NEAR_TICKS);
        if self.next.is_some() || self.is_over || is_near {
            return;
        }
        let Taken::Step(ticks, direction) = self.take(number, slots) else {
            return;
        };
        if self.now.is_some() {
            self.set_next(timer, ticks, direction);
            return;
        }
        let first = ticks_to(self.taken) as u32;
        self.now = Some((first, direction));
        // Without a second step the timer is stopped or set before it gets there.
        let mut second = first;
        if let Taken::Step(ticks, direction) = self.take(number, slots) {
            second = ticks as u32;
            self.next = Some((second, direction));
        }
        timer.start(first, second);
    }

    #[inline]
    fn set_next(&mut self, timer: &StepTimer, ticks: u64, direction: Direction) {
        timer.set_next(ticks as u32);
        self.next = Some((ticks as u32, direction));
    }

    #[inline]
    fn take(&mut self, number: usize, slots: &Slots) -> Taken {
        if let Some(ticks) = self.player.next() {
            self.taken += u64::from(ticks);
            return Taken::Step(ticks.into(), self.direction);
        }
        self.take_segment(number, slots)
    }

    fn take_segment(&mut self, number: usize, slots: &Slots) -> Taken {
        loop {
            let slot = slots.of(self.batch);
            let Some(batch) = slot.batch() else {
                return Taken::Waits;
            };
            let part = if self.in_tail {
                &batch.tail
            } else {
                &batch.steps
            };
            if let Some(segment) = part[number].get(self.segment) {
                self.segment += 1;
                self.direction = segment.direction();
                let ticks = self.player.load(segment);
                self.taken += ticks;
                return Taken::Step(ticks, self.direction);
            }
            if self.in_tail || batch.head.is_last {
                self.is_over = true;
                return Taken::Over;
            }
            match slot.next.load(Ordering::Relaxed) {
                next::TAIL => self.in_tail = true,
                next::OPEN if slots.after(self.batch).is_none() => return Taken::Waits,
                _ => {
                    slot.next.store(next::BATCH, Ordering::Relaxed);
                    self.batch += 1;
                }
            }
            self.segment = 0;
        }
    }
}
