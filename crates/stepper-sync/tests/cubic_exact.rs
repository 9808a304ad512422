//! Random rows of a PVT table: every step against the exact cubic, in 256-bit integers.
//!
//! `CUBIC_ROWS=10000000 cargo test --release -p stepper-sync --test cubic_exact -- --nocapture`
//! for a long run.
#![cfg(test)]
#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "exact numbers are compared as integers, statistics as floats"
)]

extern crate alloc;

use alloc::{collections::VecDeque, rc::Rc};

use ethnum::I256;
use stepper_sync::{
    AxisSegments, Direction, JoinedSegments, MinIntervals, PvtKnot, RowError, Segment,
    SegmentPlayer,
};

const STEP: i128 = 1 << 56;

/// `SplitMix64`.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    /// 0 to 1.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Of all magnitudes.
    fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn sign(&mut self) -> f64 {
        if self.below(2) == 0 { 1.0 } else { -1.0 }
    }
}

/// The exact cubic of a row, times T³, in 2^-56 steps.
struct Exact {
    ticks: i128,
    q: [I256; 4],
    /// u of the documentation: what the axis moves in a tick at least where times can be said.
    standstill: i128,
}

impl Exact {
    fn new(from: PvtKnot, to: PvtKnot, ticks: u32) -> Self {
        let ticks = i128::from(ticks);
        let (p0, p1) = (
            i128::from(from.position) << 24,
            i128::from(to.position) << 24,
        );
        let (v0, v1) = (
            i128::from(from.velocity) * ticks,
            i128::from(to.velocity) * ticks,
        );
        let way = p1 - p0;
        let reach = way.abs().max(v0.abs()).max(v1.abs());
        Self {
            ticks,
            standstill: (STEP >> 40).max(reach >> 47),
            q: [p0, v0, 3 * way - 2 * v0 - v1, v0 + v1 - 2 * way].map(I256::from),
        }
    }

    fn cube(&self) -> I256 {
        let t = I256::from(self.ticks);
        t * t * t
    }

    /// u T³.
    fn standstill(&self) -> I256 {
        I256::from(self.standstill) * self.cube()
    }

    /// (q(n) - place) T³.
    fn past_place(&self, n: i128, place: i128) -> I256 {
        let (t, n) = (I256::from(self.ticks), I256::from(n));
        let [q0, q1, q2, q3] = self.q;
        (((q0 - I256::from(place)) * t + q1 * n) * t + q2 * n * n) * t + q3 * n * n * n
    }

    /// q'(n) T³ per tick.
    fn velocity(&self, n: i128) -> I256 {
        let (t, n) = (I256::from(self.ticks), I256::from(n));
        let [_, q1, q2, q3] = self.q;
        (q1 * t + I256::from(2) * q2 * n) * t + I256::from(3) * q3 * n * n
    }

    /// The greatest |q'| within a tick of n, times T³.
    fn speed_near(&self, n: i128) -> I256 {
        let ends = [n - 1, n, n + 1].map(|n| self.velocity(n).abs());
        // q' is a parabola: between them it is above by less than their spread.
        let [a, b, c] = ends;
        let most = a.max(b).max(c);
        most + (most - a.min(b).min(c))
    }
}

#[derive(Debug, Default)]
struct Statistics {
    rows: u64,
    too_fast: u64,
    too_quick: u64,
    steps: u64,
    segments: u64,
    /// Steps where only the place can be said.
    by_place: u64,
    due_or_late: u64,
    worst_ticks: f64,
    worst_place: f64,
    joined_segments: u64,
    joined_bytes: u64,
    joined_worst_ticks: f64,
}

/// A step that joined segments have to make.
struct Wanted {
    exact: Rc<Exact>,
    row_start: u64,
    place: i128,
    direction: Direction,
    ticks: u64,
    /// After the step before.
    wait: u64,
    /// How far its place may be passed, in 2^-56 steps.
    touch: i128,
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
        let moves = v > self.exact.standstill();
        if off(n - 1) <= 0 && off(n + 1) >= 0 {
            let change = self.exact.velocity(n + 1) - self.exact.velocity(n - 1);
            if moves && change.abs() * I256::from(64) < v {
                let error = (sign * self.exact.past_place(n, self.place)).as_f64() / v.as_f64();
                seen.joined_worst_ticks = seen.joined_worst_ticks.max(error.abs());
            }
        } else {
            let distance = self.exact.past_place(n, self.place).abs();
            let by_place = distance <= self.exact.speed_near(n) + self.exact.standstill();
            // What is made late: a place that was passed already, or a step that waits for the
            // driver, which counts from the one before; where that has no place in time, neither
            // has this one.
            let late = I256::from(self.touch) * self.exact.cube() + self.exact.standstill();
            let as_due = distance <= late + I256::from(2) * self.exact.speed_near(n)
                && (ticks.abs_diff(self.ticks) <= 1 || wait.abs_diff(self.wait) <= 2);
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

struct Axis {
    emitter: AxisSegments,
    joined: JoinedSegments,
    wanted: VecDeque<Wanted>,
    joined_last: Option<(u64, Direction)>,
    /// Steps of a row that are tried.
    max_steps: usize,
    /// A row of more than these: it is the last one.
    cut: bool,
    knot: PvtKnot,
    row_start: u64,
    steps: i64,
    last: Option<(u64, Direction)>,
    least: MinIntervals,
}

impl Axis {
    fn new(knot: PvtKnot, least: MinIntervals, max_steps: usize) -> Self {
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
            least,
        }
    }

    /// Pushes a row and checks all of its steps.
    fn row(&mut self, ticks: u32, to: PvtKnot, seen: &mut Statistics) -> Result<(), RowError> {
        let before = self.emitter.clone();
        if let Err(error) = self.emitter.push(ticks, to) {
            assert!(self.emitter == before, "a refused row changes nothing");
            match error {
                RowError::TooFast { .. } => {
                    self.check_too_fast(ticks, to);
                    seen.too_fast += 1;
                }
                RowError::ReversalTooQuick { .. } => seen.too_quick += 1,
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
        self.joined.push(ticks, to)?;
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
        self.wanted.push_back(Wanted {
            exact: Rc::clone(exact),
            row_start: self.row_start,
            place,
            direction,
            ticks,
            wait: ticks - self.last.map_or(0, |(last, _)| last),
            touch: self.touch(),
        });
        let n = i128::from(ticks - self.row_start);
        assert!(n <= exact.ticks, "step at {n} of {}", exact.ticks);
        let least = match self.last {
            Some((_, last)) if last == direction => self.least.step_ticks,
            Some(_) => self.least.reversal_ticks,
            None => 0,
        };
        let earliest = self.last.map_or(0, |(last, _)| last + least);
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
        let late = !in_time && first && (n == 0 || ticks == earliest);
        let due = distance > 0 && !(in_time && by_place) && turned();
        if late || due {
            let late = distance <= I256::from(self.touch()) * exact.cube() + exact.standstill();
            assert!(late, "late by {distance} of {} at {n}", exact.cube());
            seen.due_or_late += 1;
            return;
        }
        let v = sign * exact.velocity(n);
        let moves = sign * exact.velocity(n - 1) > 0 && sign * exact.velocity(n + 1) > 0 && v > 0;
        if moves && v > exact.standstill() {
            assert!(
                in_time,
                "step at {n} of {}: off {distance}, v {v}",
                exact.ticks
            );
            let error = (distance.as_f64() / v.as_f64()).abs();
            let steady = (exact.velocity(n + 1) - exact.velocity(n - 1)).abs() * I256::from(64) < v;
            if steady {
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

    fn finish(mut self, seen: &mut Statistics) {
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
        let mut random = Random(seen.rows);
        let mut check = |n: i128| {
            let at = made.partition_point(|&(tick, _)| tick <= n) - 1;
            let off = exact.past_place(n, i128::from(made[at].1) * STEP).abs();
            let slack = I256::from(STEP / 2 + self.touch()) * exact.cube() + exact.standstill();
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

/// Ticks near which q' is zero.
fn turns(exact: &Exact) -> Vec<i128> {
    let [_, a, b, c] = exact.q.map(|q| q.as_f64());
    let (b, c) = (2.0 * b, 3.0 * c);
    let root = (b * b - 4.0 * a * c).sqrt();
    [(-b + root) / (2.0 * c), (-b - root) / (2.0 * c), -a / b]
        .into_iter()
        .filter(|s| (0.0..=1.0).contains(s))
        .map(|s| (s * exact.ticks as f64) as i128)
        .collect()
}

fn knot(position: f64, velocity: f64) -> PvtKnot {
    PvtKnot {
        position: (position * 32_f64.exp2()) as i64,
        velocity: (velocity * 56_f64.exp2()) as i64,
    }
}

/// A next knot: rows of all kinds.
fn next_row(random: &mut Random, from: PvtKnot, least: MinIntervals) -> (u32, PvtKnot) {
    let max = 1.0 / (least.step_ticks + 2) as f64;
    let q0 = from.position as f64 / 32_f64.exp2();
    let v0 = from.velocity as f64 / 56_f64.exp2();
    let ticks = match random.below(8) {
        0 => random.magnitude(1.0, 40.0),
        1 => random.magnitude(1.0, 4e9),
        _ => random.magnitude(100.0, 1e7),
    };
    // Most rows of some hundred steps at most: a step costs the test more than the emitter.
    let t = ticks.min(300.0 / v0.abs()).floor().max(1.0);
    let fast = match random.below(256) {
        0 => 1e4 / t,
        1..=16 => random.magnitude(1e-15, 1e3 / t),
        17..=20 => 3e3 / t,
        21..=60 => random.magnitude(1.0, 1e3) / t,
        _ => random.magnitude(0.1, 100.0) / t,
    }
    .min(max);
    let v1 = match random.below(6) {
        0 => 0.0,
        1 => random.sign() * fast,
        2 => (v0 * random.between(0.5, 1.5)).clamp(-fast, fast),
        3 => v0.clamp(-fast, fast),
        _ => random.sign() * fast * random.unit(),
    };
    let way = match random.below(8) {
        // As with constant acceleration.
        0..=3 => (v0 + v1) / 2.0 * t,
        // Whatever.
        4 => random.between(-1.0, 1.0) * (max * t).min(100.0),
        5 => random.between(-1.0, 1.0) * fast * t,
        // Some acceleration more at one end than at the other.
        6 => ((v0 + v1) / 2.0 + random.between(-0.2, 0.2) * (v0.abs() + v1.abs())) * t,
        _ => random.between(-3.0, 3.0),
    };
    let mut q1 = q0 + way;
    match random.below(16) {
        0..=3 => q1 = q1.round(),
        // On the place of a step, or next to it.
        4 => q1 = q1.floor() + 0.5,
        5 => q1 = q1.floor() + 0.5 + random.sign() * random.magnitude(1e-9, 1e-2),
        6 => q1 = q0,
        _ => {}
    }
    if q1.abs() > 2e9 {
        q1 = 0.0;
    }
    (t as u32, knot(q1, v1))
}

/// Numbers of every size, most of them at an end of one.
fn any_u64(random: &mut Random) -> u64 {
    let power = 1_u64 << random.below(64);
    match random.below(8) {
        0 => 0,
        1 => u64::MAX - random.below(3),
        2 | 3 => (power - 1).wrapping_add(random.below(3)),
        _ => random.next() >> random.below(64),
    }
}

fn any_i64(random: &mut Random) -> i64 {
    let number = any_u64(random).cast_signed();
    if random.below(2) == 0 {
        number
    } else {
        number.wrapping_neg()
    }
}

/// A row of anything, most of them not too fast.
fn any_row(random: &mut Random, from: PvtKnot, least: MinIntervals) -> (u32, PvtKnot) {
    let ticks = any_u64(random) as u32;
    let mut to = PvtKnot {
        position: any_i64(random),
        velocity: any_i64(random),
    };
    let limit = (1_u64 << 56) / least.step_ticks.saturating_add(2);
    if random.below(8) > 0 {
        to.velocity %= limit.cast_signed() + 1;
    }
    if random.below(8) > 0 {
        // 2^-56 to 2^-32; two thirds of it leave room for the velocities at the ends.
        let most = (i128::from(limit) * i128::from(ticks)) >> 24;
        let way = i128::from(to.position) % (most * 2 / 3 + 1);
        to.position = i64::try_from(i128::from(from.position) + way).unwrap_or(to.position);
    }
    match random.below(8) {
        0 => to.position = from.position,
        1 => to.position = (to.position >> 31 | 1) << 31,
        2 => to.velocity = from.velocity.wrapping_neg(),
        _ => {}
    }
    (ticks, to)
}

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |value| value.parse().unwrap())
}

impl Statistics {
    fn print(&self) {
        println!("{self:#?}");
        let a_segment = |segments| self.steps as f64 / segments as f64;
        println!("steps a segment: {}", a_segment(self.segments));
        println!(
            "joined: {} steps a segment, {} bytes a step",
            a_segment(self.joined_segments),
            self.joined_bytes as f64 / self.steps as f64
        );
    }
}

#[test]
fn every_step_of_random_rows_is_in_its_place() {
    let rows = setting("CUBIC_ROWS", 10_000);
    let mut random = Random(setting("CUBIC_SEED", 1));
    let mut seen = Statistics::default();
    while seen.rows < rows {
        let least = MinIntervals {
            step_ticks: [1, 2, 10, 100, 1000][random.below(5) as usize],
            reversal_ticks: [1, 4, 30, 200, 2000][random.below(5) as usize],
        };
        let start = knot(random.between(-1e3, 1e3), 0.0);
        let mut axis = Axis::new(start, least, usize::MAX);
        for _ in 0..50 {
            let (ticks, to) = next_row(&mut random, axis.knot, least);
            // Refused: another one.
            let _ = axis.row(ticks, to, &mut seen);
        }
        axis.finish(&mut seen);
    }
    seen.print();
    assert!(seen.worst_ticks < 1.0 && seen.joined_worst_ticks < 1.0);
}

#[test]
fn every_step_of_any_rows_is_in_its_place() {
    let rows = setting("CUBIC_ROWS", 10_000);
    let mut random = Random(setting("CUBIC_SEED", 1));
    let mut seen = Statistics::default();
    while seen.rows < rows {
        let least = MinIntervals {
            step_ticks: any_u64(&mut random),
            reversal_ticks: any_u64(&mut random),
        };
        let start = PvtKnot {
            position: any_i64(&mut random),
            velocity: any_i64(&mut random),
        };
        let mut axis = Axis::new(start, least, 2000);
        for _ in 0..50 {
            let (ticks, to) = any_row(&mut random, axis.knot, least);
            let _ = axis.row(ticks, to, &mut seen);
            if axis.cut {
                break;
            }
        }
        axis.finish(&mut seen);
    }
    seen.print();
    assert!(seen.worst_ticks < 1.0 && seen.joined_worst_ticks < 1.0);
}
