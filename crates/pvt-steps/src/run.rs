//! The steps of one axis in one row, batch by batch.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_wrap,
    clippy::integer_division_remainder_used,
    reason = "positions as in `Cubic`, fractions at most 2^62, counts below 2^10; constant divisors"
)]

use crate::Direction;
use crate::fixed::{Inverse, ONE, fraction};
use crate::polynomial::{Cubic, Turns};
use crate::row::PvtKnot;
use crate::series::{Centre, End, Series, Times, time_of};

/// What an axis may pass a step's place by and turn round without making the step: 2^-8 steps, if
/// it does not take more than a tick at its greatest velocity.
const TOUCH_BITS: u32 = 8;
/// Centres tried by the series before the rest is halved.
const SERIES_ROUNDS: u32 = 12;
/// Half a tick, in 2^-32 ticks.
const HALF_TICK: u64 = 1 << 31;

/// Steps whose times are a cubic of their number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Batch {
    pub(crate) direction: Direction,
    pub(crate) count: u16,
    pub(crate) times: Times,
}

impl Batch {
    /// The time of the first step, in 2^-32 ticks, so that the whole ticks are rounded and, of
    /// several steps, the 8 bits after the point.
    pub(crate) const fn start(&self) -> u64 {
        let half = if self.count > 1 {
            HALF_TICK + (1 << 23)
        } else {
            HALF_TICK
        };
        self.times.first.wrapping_add(half)
    }
}

/// How well steps are met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fit {
    /// What a series may leave out, in 2^-32 ticks.
    pub(crate) tolerance: u64,
    /// Greatest velocity, in 2^-56 steps a tick.
    pub(crate) max_velocity: i64,
    /// A hint: the half width that fitted last, in half steps.
    pub(crate) halves: u64,
}

/// The step before a row, for the first one that goes back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Back {
    pub(crate) last: Direction,
    /// Ticks of the row until a step back may come.
    pub(crate) wait_ticks: u64,
    /// Ticks from a step back that has waited to the time at which the axis may be at the next place
    /// or turn round.
    pub(crate) apart_ticks: u64,
}

/// An axis within a row. Positions are measured in the direction of the present piece, so
/// that they rise, and count from the whole step at which the row began.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    cubic: Cubic,
    ticks: u32,
    /// Position at the end of the row, in 2^-32 steps.
    end: i64,
    direction: Direction,
    /// Where this piece and those after it end.
    ends: [u64; 3],
    /// Steps left in this piece.
    left: u64,
    /// Place of the next one.
    place: i64,
    /// A fraction before the next one, in this piece.
    low: u64,
    /// Where the next centre may be.
    guess: u64,
    /// The half width that fitted last, in half steps.
    halves: u64,
    /// What a series may leave out, in 2^-32 ticks.
    tolerance: u64,
    /// What may be passed and come back from without a step.
    touch: i64,
    /// The next step's place is passed already.
    due: bool,
}

impl Run {
    /// A row with these turns that ends at `end`, in 2^-32 steps.
    pub(crate) fn new(cubic: Cubic, ticks: u32, end: i64, turns: Turns, fit: Fit) -> Self {
        let [first, second] = turns.at;
        let (cubic, end) = match turns.direction {
            Direction::Positive => (cubic, end),
            Direction::Negative => (cubic.reversed(), end.saturating_neg()),
        };
        // Where it is late by a tick, a step is still as far from the next as it must be.
        let tick = fit.max_velocity >> (PvtKnot::VELOCITY_BITS - cubic.bits);
        let mut run = Self {
            touch: (cubic.step() >> TOUCH_BITS).min(tick),
            place: cubic.step() / 2,
            cubic,
            ticks,
            end,
            direction: turns.direction,
            ends: [first, second, ONE],
            left: 0,
            low: 0,
            guess: 0,
            halves: fit.halves,
            tolerance: fit.tolerance,
            due: false,
        };
        run.begin();
        run
    }

    /// The half width that fitted last, in half steps.
    pub(crate) const fn halves(&self) -> u64 {
        self.halves
    }

    /// Where the axis turns round within the row, before its first step.
    pub(crate) const fn first_turn(&self) -> Option<u64> {
        let [turn, ..] = self.ends;
        if turn < ONE { Some(turn) } else { None }
    }

    /// Whether the axis may pass a step's place by more than the touch, turn round and be back in
    /// less than `ticks` ticks.
    ///
    /// With |q''| <= 2 A per fraction² the distance takes at least the fraction sqrt(touch / A),
    /// and as much on return.
    pub(crate) fn turns_within(&self, ticks: u64) -> bool {
        let acceleration = self.cubic.max_acceleration();
        // Half of the ticks, or all of the row.
        let half = self.fraction_of(ticks / 2 + 1).unwrap_or(ONE);
        fraction(fraction(acceleration, half), half) + 2 > self.touch
    }

    /// Counts the steps of the piece that begins at `low`, and looks for its first centre.
    fn begin(&mut self) {
        let [end, ..] = self.ends;
        self.left = self.steps_to(end);
        if self.left > 0 {
            let centre = Centre::new(&self.cubic, self.ticks, self.low);
            self.due = self.place <= centre.d0;
            self.guess = self.ahead(end, centre.reach(self.place - centre.d0 + self.wanted()));
        }
    }

    /// Steps to the end of the piece: those whose places are passed, by more than the touch where
    /// the axis turns round.
    fn steps_to(&self, end: u64) -> u64 {
        let (beyond, bits) = if end < ONE {
            (
                self.cubic.at(end).position - self.touch - self.place,
                self.cubic.bits,
            )
        } else {
            // Exactly: the next place is half a step after the steps made.
            let made = self.place >> self.cubic.bits;
            let place = (2 * made + 1) << (PvtKnot::POSITION_BITS - 1);
            (self.end.saturating_sub(place), PvtKnot::POSITION_BITS)
        };
        if beyond > 0 {
            ((beyond - 1) >> bits).unsigned_abs() + 1
        } else {
            0
        }
    }

    /// The next piece, if there is one.
    fn turn(&mut self) -> bool {
        let [end, second, third] = self.ends;
        if end == ONE {
            return false;
        }
        self.ends = [second, third, ONE];
        self.low = end;
        self.cubic = self.cubic.reversed();
        self.end = self.end.saturating_neg();
        self.direction = self.direction.reversed();
        // The step back has its place where the last one forth had its own.
        self.place = self.cubic.step() - self.place;
        self.begin();
        true
    }

    /// How far after the next step's place the centre should be.
    fn wanted(&self) -> i64 {
        let halves = self.left.saturating_sub(1).min(self.halves);
        let half = self.cubic.step() / 2;
        let half_width = halves as i64 * half;
        // A little more, for what the guess is off.
        half_width + half_width / 64 + half / 128
    }

    /// A guess between `low` and `high`, or their middle.
    fn ahead(&self, high: u64, guess: Option<u64>) -> u64 {
        guess
            .filter(|&fraction| self.low < fraction && fraction < high)
            .unwrap_or(self.low + (high - self.low) / 2)
    }

    /// The next steps.
    pub(crate) fn next(&mut self) -> Option<Batch> {
        self.find_piece()?;
        if self.due {
            self.due = false;
            return Some(self.made(1, Times::single(time_of(self.low, self.ticks))));
        }
        Some(self.search())
    }

    /// The first steps of the row: a step back waits until the driver can take it, if the axis is
    /// then past its place by no more than the touch, or the next step has its time.
    ///
    /// # Errors
    /// The tick of the row at which it waits no longer.
    pub(crate) fn first(&mut self, back: Option<Back>) -> Result<Option<Batch>, u32> {
        if self.find_piece().is_none() {
            return Ok(None);
        }
        let Some(back) = back.filter(|back| back.last != self.direction) else {
            return Ok(self.next());
        };
        let [end, ..] = self.ends;
        let wait = u32::try_from(back.wait_ticks).unwrap_or(u32::MAX);
        let fraction = self
            .fraction_of(back.wait_ticks)
            .filter(|&fraction| fraction <= end);
        let Some(fraction) = fraction else {
            return Err(wait.min(self.ticks));
        };
        let past = self.cubic.at(fraction).position - self.place;
        if fraction <= self.low || past < 0 {
            return Ok(self.next());
        }
        let next = back.wait_ticks.saturating_add(back.apart_ticks);
        if past > self.touch && !self.is_before_the_next_place(next) {
            return Err(wait);
        }
        self.due = false;
        Ok(Some(self.made(1, Times::single(u64::from(wait) << 32))))
    }

    /// Whether the axis is still in this piece after so many ticks of the row, and not at the place
    /// after the next step's.
    fn is_before_the_next_place(&self, ticks: u64) -> bool {
        let [end, ..] = self.ends;
        self.fraction_of(ticks).is_some_and(|fraction| {
            let past = self.cubic.at(fraction).position - self.place;
            fraction <= end && past < self.cubic.step()
        })
    }

    /// Ticks as a fraction of the row; `None` after its end.
    fn fraction_of(&self, ticks: u64) -> Option<u64> {
        Inverse::of(u64::from(self.ticks))?.fraction(ticks)
    }

    /// A piece with steps left.
    fn find_piece(&mut self) -> Option<()> {
        while self.left == 0 {
            if !self.turn() {
                return None;
            }
        }
        Some(())
    }

    /// Counts steps as made.
    fn made(&mut self, count: u16, times: Times) -> Batch {
        self.left -= u64::from(count);
        self.place += i64::from(count) << self.cubic.bits;
        Batch {
            direction: self.direction,
            count,
            times,
        }
    }

    /// Centres until one has a series that is exact enough; at last the middle of half a tick.
    fn search(&mut self) -> Batch {
        let [mut high, ..] = self.ends;
        let mut fraction = self.guess;
        let mut round = 0;
        loop {
            let centre = Centre::new(&self.cubic, self.ticks, fraction);
            let distance = self.place - centre.d0;
            if distance < 0 {
                high = fraction;
            } else {
                self.low = fraction;
            }
            match centre.series(distance.abs()) {
                Some(series) if series.error <= self.tolerance => {
                    return self.accept(&centre, &series, distance);
                }
                Some(series) => self.halves = series.fitting(self.tolerance),
                None => self.halves /= 4,
            }
            if time_of(high - self.low, self.ticks) <= HALF_TICK {
                break;
            }
            round += 1;
            let guess = if round < SERIES_ROUNDS {
                centre.reach(distance + self.wanted())
            } else {
                None
            };
            fraction = self.ahead(high, guess);
        }
        self.guess = high;
        let middle = self.low + (high - self.low) / 2;
        self.made(1, Times::single(time_of(middle, self.ticks)))
    }

    /// The steps of a series that is exact enough, and the guess for those after them.
    fn accept(&mut self, centre: &Centre, series: &Series, distance: i64) -> Batch {
        let count =
            u16::try_from(self.left).map_or(series.count(), |left| left.min(series.count()));
        let several = if count > 1 && distance < 0 {
            let steps = series.per_half_width();
            steps.and_then(|steps| Some((steps, series.times(steps, count)?)))
        } else {
            None
        };
        let batch = match several {
            Some((_, times)) => self.made(count, times),
            None => {
                let end = if distance < 0 { End::First } else { End::Last };
                self.made(1, Times::single(series.time_at(end)))
            }
        };
        if centre.d0 <= self.place {
            self.low = centre.fraction;
        }
        if self.left == 0 {
            return batch;
        }
        let guess = if let Some((steps, _)) = several {
            self.halves = series.fitting(self.tolerance);
            series.extrapolated(self.place - centre.d0 + self.wanted(), steps)
        } else {
            let wider = centre.series(self.cubic.step());
            self.halves = wider.map_or(0, |series| series.fitting(self.tolerance));
            centre.reach(self.place - centre.d0 + self.wanted())
        };
        self.guess = self.ahead(self.ends[0], guess);
        batch
    }
}
