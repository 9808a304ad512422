//! An axis whose steps are checked, each by itself and as joined segments.

use alloc::{collections::VecDeque, rc::Rc};

use ethnum::I256;
use pvt_steps::{
    AxisSegments, Direction, JoinedSegments, MinIntervals, PvtKnot, RowError, Segment,
    SegmentPlayer,
};
use test_support::Random;

use crate::cubic_exact::exact::{Exact, turns};
use crate::cubic_exact::{STEP, Statistics};

/// A step that joined segments have to make.
struct Wanted {
    exact: Rc<Exact>,
    row_start: u64,
    place: i128,
    direction: Direction,
    ticks: u64,
    /// After the step before.
    wait: u64,
    /// How far its place may be passed, times T³.
    late: I256,
    /// Whether it waits for the driver.
    waits: bool,
}

impl Wanted {
    /// Less than a tick from the exact place, or where the place alone can be said, next to the
    /// tick that the row's own segment has.
    fn check(&self, ticks: u64, wait: u64, seen: &mut Statistics) {
        let sign = I256::from(if self.direction == Direction::Positive {
            1
        } else {
            -1
        });
        let n = i128::from(ticks) - i128::from(self.row_start);
        let off = |n: i128| {
            sign * self
                .exact
                .past_place(n.clamp(0, self.exact.ticks), self.place)
        };
        let v = sign * self.exact.velocity(n);
        let moves = v > self.exact.standstill() && !self.exact.turns_near(n);
        if off(n - 1) <= 0 && off(n + 1) >= 0 {
            if moves && self.exact.is_steady(n) && !self.waits {
                let error = (sign * self.exact.past_place(n, self.place)).as_f64() / v.as_f64();
                seen.joined_worst_ticks = seen.joined_worst_ticks.max(error.abs());
            }
        } else {
            let distance = self.exact.past_place(n, self.place).abs();
            let by_place = distance <= self.exact.speed_near(n) + self.exact.standstill();
            // What is made late: a place that was passed already, or a step that waits for the
            // driver, which counts from the one before; where that has no place in time, neither
            // has this one.
            let apart = ticks.abs_diff(self.ticks);
            let on = I256::from(apart.max(2)) * self.exact.speed_near(n);
            let as_due =
                distance <= self.late + on && (apart <= 1 || wait.abs_diff(self.wait) <= 2);
            assert!(
                (by_place && !moves) || as_due,
                "{ticks}, not {}; {n} of {}: off {distance}, velocity {v}, turns {:?}",
                self.ticks,
                self.exact.ticks,
                turns(&self.exact)
            );
        }
    }
}

pub(crate) struct Axis {
    emitter: AxisSegments,
    joined: JoinedSegments,
    wanted: VecDeque<Wanted>,
    joined_last: Option<(u64, Direction)>,
    /// Steps of a row that are tried.
    max_steps: usize,
    /// A row of more than these, or one that joined segments refuse: it is the last one.
    pub(crate) cut: bool,
    pub(crate) knot: PvtKnot,
    row_start: u64,
    steps: i64,
    last: Option<(u64, Direction)>,
    /// The tick of the row at which a step back has waited for the driver, and how far its place was
    /// passed, times T³.
    waited: Option<(i128, I256)>,
    least: MinIntervals,
}

impl Axis {
    pub(crate) fn new(knot: PvtKnot, least: MinIntervals, max_steps: usize) -> Self {
        let joined = JoinedSegments::new(knot, least);
        // As joined segments ask of their rows.
        let least = MinIntervals {
            step_ticks: least.step_ticks.saturating_add(1),
            reversal_ticks: least.reversal_ticks.saturating_add(2),
        };
        let emitter = AxisSegments::new(knot, least);
        Self {
            steps: emitter.steps(),
            emitter,
            joined,
            wanted: VecDeque::new(),
            joined_last: None,
            max_steps,
            cut: false,
            knot,
            row_start: 0,
            last: None,
            waited: None,
            least,
        }
    }

    /// Pushes a row and checks all of its steps.
    pub(crate) fn row(
        &mut self,
        ticks: u32,
        to: PvtKnot,
        seen: &mut Statistics,
    ) -> Result<(), RowError> {
        let before = self.emitter.clone();
        if let Err(error) = self.emitter.push(ticks, to) {
            assert!(self.emitter == before, "a refused row changes nothing");
            match error {
                RowError::TooFast { .. } => {
                    self.check_too_fast(ticks, to);
                    seen.too_fast += 1;
                }
                RowError::ReversalTooQuick { .. } => {
                    self.check_too_quick(ticks, to);
                    seen.too_quick += 1;
                }
                RowError::NoTime { .. } => assert!(ticks == 0 && to.position != self.knot.position),
                other => panic!("{other}"),
            }
            return Err(error);
        }
        if ticks == 0 {
            assert_eq!(self.emitter.next(), None);
            self.joined.push(ticks, to)?;
            self.knot = to;
            return Ok(());
        }
        let exact = Rc::new(Exact::new(self.knot, to, ticks));
        let mut made: Vec<(i128, i64)> = vec![(-1, self.steps)];
        let mut last_ticks = self.last.map_or(0, |(ticks, _)| ticks);
        let mut first = true;
        self.waited = None;
        while let Some(segment) = self.emitter.next() {
            seen.segments += 1;
            let mut player = SegmentPlayer::new();
            let mut interval = Some(player.load(&segment));
            let mut count = 0;
            while let Some(wait) = interval {
                last_ticks += wait;
                count += 1;
                self.step(&exact, last_ticks, segment.direction(), first, seen);
                first = false;
                made.push((i128::from(last_ticks - self.row_start), self.steps));
                interval = player.next().map(u64::from);
            }
            assert_eq!(count, segment.count());
            if made.len() > self.max_steps {
                self.cut = true;
                break;
            }
        }
        assert_eq!(self.emitter.steps(), self.steps);
        self.check_between(&exact, &made, seen);
        // With finer times a step back may be too quick that is not with the others.
        if let Err(error) = self.joined.push(ticks, to) {
            assert!(
                matches!(error, RowError::ReversalTooQuick { .. }),
                "{error}"
            );
            seen.joined_too_quick += 1;
            self.cut = true;
            return Err(error);
        }
        self.check_joined(seen);
        seen.rows += 1;
        self.row_start += u64::from(ticks);
        self.knot = to;
        Ok(())
    }

    fn step(
        &mut self,
        exact: &Rc<Exact>,
        ticks: u64,
        direction: Direction,
        first: bool,
        seen: &mut Statistics,
    ) {
        let sign = if direction == Direction::Positive {
            1
        } else {
            -1
        };
        let place = i128::from(2 * self.steps + sign) * STEP / 2;
        self.steps += sign;
        let n = i128::from(ticks - self.row_start);
        assert!(n <= exact.ticks, "step at {n} of {}", exact.ticks);
        let waits = first && ticks == self.earliest(direction) && self.turned_at_last(direction);
        let touch = I256::from(self.touch()) * exact.cube() + exact.standstill();
        let late = if waits {
            let distance = I256::from(sign) * exact.past_place(n, place);
            self.waited = Some((n, distance));
            // Before the next place, which has its time: the step after this is no sooner than it
            // may.
            assert!(distance < I256::from(STEP) * exact.cube(), "{distance}");
            touch.max(distance)
        } else {
            touch
        };
        self.wanted.push_back(Wanted {
            exact: Rc::clone(exact),
            row_start: self.row_start,
            place,
            direction,
            ticks,
            wait: ticks - self.last.map_or(0, |(last, _)| last),
            late,
            waits,
        });
        let earliest = self.earliest(direction);
        assert!(
            ticks >= earliest,
            "step at {ticks}, before {earliest}: {:?} then {direction:?}",
            self.last
        );
        self.last = Some((ticks, direction));
        seen.steps += 1;

        let sign = I256::from(sign);
        let off = |n| sign * exact.past_place(n, place);
        // The row's own stretch of the last tick before and the next one after.
        let in_time = off((n - 1).max(0)) <= 0 && off((n + 1).min(exact.ticks)) >= 0;
        let distance = off(n);
        let speed = exact.speed_near(n);
        let by_place = distance.abs() <= speed + exact.standstill();
        // Passed without a step before the axis turned round, or waited for the driver.
        let turned = || {
            turns(exact).into_iter().any(|turn| {
                let since = exact.past_place(turn, place) - exact.past_place(n, place);
                (turn - n).abs() <= 1 || since.abs() <= exact.standstill()
            })
        };
        let is_late = !in_time && first && (n == 0 || ticks == earliest);
        let due = distance > 0 && !(in_time && by_place) && turned();
        if is_late || due {
            let is_within = distance <= late;
            assert!(is_within, "late by {distance} of {} at {n}", exact.cube());
            seen.due_or_late += 1;
            return;
        }
        let v = sign * exact.velocity(n);
        let moves = sign * exact.velocity(n - 1) > 0
            && sign * exact.velocity(n + 1) > 0
            && v > 0
            && !exact.turns_near(n);
        if moves && v > exact.standstill() {
            assert!(
                in_time,
                "step at {n} of {}: off {distance}, v {v}",
                exact.ticks
            );
            let error = (distance.as_f64() / v.as_f64()).abs();
            if exact.is_steady(n) && !waits {
                seen.worst_ticks = seen.worst_ticks.max(error);
            }
        } else {
            assert!(
                by_place,
                "step at {n} of {}: off {distance}, velocities {:?}, turns {:?}",
                exact.ticks,
                [n - 1, n, n + 1].map(|n| exact.velocity(n)),
                turns(exact)
            );
            seen.by_place += 1;
            let rest = (distance.abs() - speed).as_f64() / exact.cube().as_f64();
            seen.worst_place = seen.worst_place.max(rest / STEP as f64);
        }
    }

    /// The first tick at which the driver takes a step.
    fn earliest(&self, direction: Direction) -> u64 {
        let least = if self.turned_at_last(direction) {
            self.least.reversal_ticks
        } else {
            self.least.step_ticks
        };
        self.last.map_or(0, |(last, _)| last.saturating_add(least))
    }

    fn turned_at_last(&self, direction: Direction) -> bool {
        self.last.is_some_and(|(_, last)| last != direction)
    }

    /// In a row that does not turn round, a step back that has to wait is refused where the next place
    /// or the end of the row comes before the driver has had its time.
    fn check_too_quick(&self, ticks: u32, to: PvtKnot) {
        let exact = Exact::new(self.knot, to, ticks);
        let Some((_, last)) = self.last else {
            return;
        };
        let sign = if last == Direction::Positive { -1 } else { 1 };
        let goes_back = |knot: PvtKnot| i128::from(knot.velocity) * i128::from(sign) > 0;
        let turns_round = !turns(&exact).is_empty();
        if turns_round || !goes_back(self.knot) || !goes_back(to) {
            return;
        }
        let next = i128::from(2 * self.steps + 3 * sign) * STEP / 2;
        let MinIntervals {
            step_ticks,
            reversal_ticks,
        } = self.least;
        let earliest = self.earliest(last.reversed()).max(self.row_start) - self.row_start;
        let n = i128::from(earliest) + i128::from(step_ticks.max(reversal_ticks)) + 3;
        assert!(
            n >= exact.ticks || I256::from(sign) * exact.past_place(n, next) > -exact.standstill(),
            "a step back at {earliest} of {ticks} is refused"
        );
    }

    /// What may be passed and come back from without a step, or before a step back may come.
    fn touch(&self) -> i128 {
        (STEP >> 8).min(STEP / (i128::from(self.least.step_ticks) + 2) + 1)
    }

    /// What is refused as too fast is.
    fn check_too_fast(&self, ticks: u32, to: PvtKnot) {
        let v = |knot: PvtKnot| knot.velocity as f64 / 56_f64.exp2();
        let mut fastest = v(self.knot).abs().max(v(to).abs());
        if ticks > 0 {
            let exact = Exact::new(self.knot, to, ticks);
            let [_, a, b, c] = exact.q.map(|q| q.as_f64() / STEP as f64);
            let vertex = (-b / (3.0 * c)).clamp(0.0, 1.0);
            let peak = a + (2.0 * b + 3.0 * c * vertex) * vertex;
            fastest = fastest.max(peak.abs() / f64::from(ticks));
            // What rounding a cubic's coefficients may add.
            let rounding = exact.standstill as f64 / STEP as f64 / 64.0;
            fastest += rounding / f64::from(ticks);
        }
        let limit = 1.0 / (self.least.step_ticks as f64 + 2.0);
        // The limit is rounded down to 2^-56 where a step has many ticks.
        let unit = (-56_f64).exp2();
        assert!(
            fastest > (limit - unit) * (1.0 - 1e-9),
            "{fastest} is not above {limit}"
        );
    }

    /// What joined segments have so far, over a wire.
    fn check_joined(&mut self, seen: &mut Statistics) {
        let mut buffer = [0; Segment::MAX_ENCODED_LEN];
        for segment in self.joined.by_ref() {
            let bytes = segment.encode(&mut buffer);
            assert_eq!(Segment::decode(bytes), Ok((segment, [].as_slice())));
            seen.joined_segments += 1;
            seen.joined_bytes += bytes.len() as u64;
            let mut player = SegmentPlayer::new();
            let mut interval = Some(player.load(&segment));
            while let Some(wait) = interval {
                let Some(wanted) = self.wanted.pop_front() else {
                    assert!(self.cut);
                    return;
                };
                let direction = segment.direction();
                assert_eq!(direction, wanted.direction);
                let ticks = self.joined_last.map_or(0, |(last, _)| last) + wait;
                // Those of the rows have one tick and two more.
                let least = match self.joined_last {
                    Some((_, last)) if last == direction => self.least.step_ticks - 1,
                    Some(_) => self.least.reversal_ticks - 2,
                    None => 0,
                };
                assert!(
                    wait >= least,
                    "{wait} ticks to the step at {ticks}, not {least}"
                );
                self.joined_last = Some((ticks, direction));
                wanted.check(ticks, wait, seen);
                interval = player.next().map(u64::from);
            }
        }
    }

    pub(crate) fn finish(mut self, seen: &mut Statistics) {
        if self.cut {
            return;
        }
        self.joined.finish();
        self.check_joined(seen);
        assert!(self.wanted.is_empty());
    }

    /// At any time the steps made are those that the position asks for.
    fn check_between(&self, exact: &Exact, made: &[(i128, i64)], seen: &Statistics) {
        let ticks = exact.ticks;
        let mut random = Random::new(seen.rows);
        let mut check = |n: i128| {
            let at = made.partition_point(|&(tick, _)| tick <= n) - 1;
            let off = exact.past_place(n, i128::from(made[at].1) * STEP).abs();
            let slack = I256::from(STEP / 2 + self.touch()) * exact.cube() + exact.standstill();
            let waits = self.waited.filter(|(tick, _)| n < *tick);
            let slack = slack + waits.map_or(I256::ZERO, |(_, distance)| distance);
            assert!(
                off <= slack + exact.speed_near(n),
                "at {n} of {ticks}: {off} off {} steps, {slack}",
                made[at].1
            );
        };
        if self.cut {
            let &(last, _) = made.last().unwrap();
            (0..8).for_each(|_| check(i128::from(random.below(last as u64 + 1))));
            return;
        }
        if ticks <= 40 {
            (0..=ticks).for_each(&mut check);
            return;
        }
        for _ in 0..8 {
            check(i128::from(random.below(ticks as u64)));
        }
        for turn in turns(exact) {
            check(turn.clamp(0, ticks));
            check((turn + 1).clamp(0, ticks));
        }
        check(ticks);
    }
}
