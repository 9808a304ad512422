//! Ramps against their closed form.
#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "ticks below 2^53 and counts below 2^31, compared within a tolerance"
)]

use pvt_steps::{AxisRamp, Level, MinIntervals, PvtSteps, Ramp, RampEnds, RampLimits, Rate};
use test_support::{Pulses, pulses};

/// The goal: total time within 0.01 % of the closed form.
const TOTAL_RELATIVE: f64 = 1e-4;
/// The end is rounded to whole ticks.
const END_TICKS: f64 = 0.5 + F64_TICKS;
/// The documented bound of a step: ticks, and steps.
const STEP_TICKS: f64 = 2.0;
const STEP_PLACE: f64 = 1.0 / (1_u32 << 28) as f64;
/// Error of this test's own f64 arithmetic, in ticks: 2^40 ticks have 12 bits after the point.
const F64_TICKS: f64 = 1e-3;

/// One motor on one timer.
#[derive(Clone, Copy, Debug)]
struct Setting {
    tick_hz: f64,
    rate: (u32, u32),
    limits: RampLimits,
}

const fn setting(rate: (u32, u32), start_hz: u32, max_hz: u32, accel_steps_per_s2: u32) -> Setting {
    Setting {
        tick_hz: rate.0 as f64 / rate.1 as f64,
        rate,
        limits: RampLimits {
            start_millihertz: start_hz * 1000,
            max_millihertz: max_hz * 1000,
            accel_steps_per_s2,
        },
    }
}

const MCS51: (u32, u32) = (11_059_200, 12);
const MHZ_72: (u32, u32) = (72_000_000, 1);
const MHZ_72_BY_7: (u32, u32) = (72_000_000, 7);

const SETTINGS: [Setting; 10] = [
    setting(MCS51, 0, 113, 200),
    setting(MCS51, 100, 600, 1500),
    setting(MCS51, 0, 1000, 1000),
    setting((1_000_000, 1), 0, 2000, 10_000),
    setting((1_000_000, 1), 500, 500, 1),
    setting((2_000_000, 1), 300, 20_000, 50_000),
    setting(MHZ_72, 0, 1000, 100),
    setting(MHZ_72, 200, 200_000, 1_000_000),
    setting(MHZ_72_BY_7, 50, 40_000, 123_457),
    setting(MHZ_72, 0, 1_000_000, 20_000_000),
];

impl Setting {
    fn ramp<const N: usize>(&self, steps: [i32; N]) -> Ramp<N> {
        let rate = Rate::new(self.rate.0, self.rate.1).unwrap();
        Ramp::new(steps, &self.limits, rate).unwrap()
    }

    fn v0(&self) -> f64 {
        f64::from(self.limits.start_millihertz) / 1000.0
    }

    fn v(&self) -> f64 {
        f64::from(self.limits.max_millihertz) / 1000.0
    }

    fn a(&self) -> f64 {
        f64::from(self.limits.accel_steps_per_s2)
    }

    /// Steps of one ramp to the highest rate.
    fn ramp_steps(&self) -> f64 {
        (self.v().powi(2) - self.v0().powi(2)) / (2.0 * self.a())
    }

    /// Closed form of the whole move, in ticks.
    fn total(&self, n: f64) -> f64 {
        let (v0, v, a) = (self.v0(), self.v(), self.a());
        let seconds = if n >= 2.0 * self.ramp_steps() {
            n / v + (v - v0).powi(2) / (v * a)
        } else {
            2.0 * ((v0 * v0 + a * n).sqrt() - v0) / a
        };
        self.tick_hz * seconds
    }

    /// Closed form of the time at which `s` of `n` steps are made, in ticks.
    fn time(&self, s: f64, n: f64) -> f64 {
        let (v0, v, a) = (self.v0(), self.v(), self.a());
        if s > n / 2.0 {
            return self.total(n) - self.time(n - s, n);
        }
        let seconds = if s <= self.ramp_steps() {
            ((v0 * v0 + 2.0 * a * s).sqrt() - v0) / a
        } else {
            s / v + (v - v0).powi(2) / (2.0 * v * a)
        };
        self.tick_hz * seconds
    }
}

fn counts() -> impl Iterator<Item = i32> {
    let log_spaced = (0..=60).map(|i| (10_f64.powf(3.0 + f64::from(i) / 20.0)) as i32);
    (1..=1000).chain(log_spaced)
}

#[test]
fn total_time_is_within_a_hundredth_of_a_percent_for_1_to_a_million_steps() {
    let mut worst = (0.0_f64, 0.0_f64);
    for s in SETTINGS {
        for n in counts() {
            let total = s.ramp([n]).end_ticks() as f64;
            let exact = s.total(f64::from(n));
            let error = (total - exact).abs();
            assert!(
                error <= TOTAL_RELATIVE * exact,
                "{n} steps, {s:?}: {total}, not {exact}"
            );
            assert!(error <= END_TICKS, "{n} steps, {s:?}: {total}, not {exact}");
            worst = (worst.0.max(error), worst.1.max(error / exact));
        }
    }
    println!("worst: {} ticks, {} of the time", worst.0, worst.1);
}

/// Checks the edges of an axis with m of n steps, and returns the greatest error of a step.
fn check(s: &Setting, axis: AxisRamp, m: u32, n: f64, end: u64) -> f64 {
    assert_eq!(axis.remaining(), u64::from(2 * m));
    let mut ticks = 0_u64;
    let mut pulses = Vec::new();
    let mut worst = 0.0_f64;
    for (k, interval) in (0_u32..).zip(axis) {
        assert!(interval > 0);
        ticks += interval;
        if k % 2 == 1 {
            pulses.push(interval);
            continue;
        }
        let travel = (f64::from(k) + 1.0) * n / (2.0 * f64::from(m));
        let exact = s.time(travel, n);
        let error = (ticks as f64 - exact).abs();
        // Ticks of a step of this axis at the highest rate.
        let step = s.tick_hz / s.v() * n / f64::from(m);
        assert!(
            error <= STEP_TICKS + step * STEP_PLACE,
            "step {k} of {m} of {n}, {s:?}: {ticks}, not {exact}"
        );
        worst = worst.max(error);
    }
    assert!(pulses.windows(2).all(|pair| pair[0] == pair[1]));
    assert_eq!(pulses.len(), usize::try_from(m).unwrap());
    assert!(ticks <= end, "{m} of {n}, {s:?}");
    worst
}

#[test]
fn every_step_is_at_its_place() {
    let mut worst = 0.0_f64;
    for s in SETTINGS {
        for n in [1, 2, 3, 4, 5, 10, 33, 100, 1000, 5000, 40_000_u32] {
            let ramp = s.ramp([i32::try_from(n).unwrap()]);
            let [axis] = ramp.axes();
            worst = worst.max(check(&s, axis, n, f64::from(n), ramp.end_ticks()));
        }
    }
    println!("worst: {worst} ticks");
}

/// An acceleration of 2^30 ticks, from a rate that is no whole number of steps a second.
#[test]
fn the_slowest_acceleration_ends_within_half_a_tick() {
    let rate = (268_435_519, 1);
    let setting = Setting {
        tick_hz: f64::from(rate.0),
        rate,
        limits: RampLimits {
            start_millihertz: 3302,
            max_millihertz: 525_861_857,
            accel_steps_per_s2: 71_151,
        },
    };
    for n in 1..300 {
        let ramp = setting.ramp([n]);
        let [axis] = ramp.axes();
        let ticks = ramp.end_ticks();
        check(&setting, axis, n.unsigned_abs(), f64::from(n), ticks);
        let error = (ticks as f64 - setting.total(f64::from(n))).abs();
        assert!(error <= END_TICKS, "{n} steps: {error} ticks");
    }
}

#[test]
fn a_million_steps_lose_nothing() {
    for s in [SETTINGS[0], SETTINGS[7]] {
        let ramp = s.ramp([1_000_000, 1]);
        let [leader, follower] = ramp.axes();
        assert_eq!(leader.remaining(), 2_000_000);
        check(&s, leader, 1_000_000, 1e6, ramp.end_ticks());
        check(&s, follower, 1, 1e6, ramp.end_ticks());
    }
}

#[test]
fn followers_keep_the_proportion() {
    for s in SETTINGS {
        let ramp = s.ramp([5000, -1234, 1, 0, 4999]);
        for (axis, m) in ramp.axes().into_iter().zip([5000, 1234, 1, 0, 4999_u32]) {
            check(&s, axis, m, 5000.0, ramp.end_ticks());
        }
    }
}

/// Ticks of the steps of one axis.
fn steps(axis: AxisRamp) -> Vec<u64> {
    let edges = axis.scan(0, |ticks, interval| {
        *ticks += interval;
        Some(*ticks)
    });
    edges.step_by(2).collect()
}

/// Three moves that join at speed are as long as one, and step where it does.
#[test]
fn ramps_join() {
    let limits = RampLimits {
        start_millihertz: 200_000,
        max_millihertz: 4_000_000,
        accel_steps_per_s2: 10_000,
    };
    let rate = Rate::from_hz(72_000_000).unwrap();
    let whole = Ramp::new([2400, 600], &limits, rate).unwrap();
    // 798 steps up, 804 on, 798 down: cut where it has 2000 and where it has 4000 steps/s.
    let parts = [
        (198, 200_000, 2_000_000),
        (1402, 2_000_000, 4_000_000),
        (800, 4_000_000, 200_000),
    ];
    let mut joined = Vec::new();
    let mut start = 0;
    for (n, entry_millihertz, exit_millihertz) in parts {
        let ends = RampEnds {
            entry_millihertz,
            exit_millihertz,
        };
        let ramp = Ramp::between([n], &limits, ends, rate).unwrap();
        let [axis] = ramp.axes();
        joined.extend(steps(axis).into_iter().map(|ticks| start + ticks));
        start += ramp.end_ticks();
    }
    // Three ends rounded instead of one.
    assert!(start.abs_diff(whole.end_ticks()) <= 2);
    let [axis, _] = whole.axes();
    let whole = steps(axis);
    assert_eq!(whole.len(), joined.len());
    for (a, b) in whole.into_iter().zip(joined) {
        // Each within 2 ticks of the exact trapezoid, and 1 for the rounded joints.
        assert!(a.abs_diff(b) <= 5, "{a} and {b}");
    }
}

/// The rows of a table are the same move.
#[test]
fn rows_step_as_the_axes_do() {
    for s in SETTINGS {
        let ramp = s.ramp([500, -123, 0]);
        let least = MinIntervals {
            step_ticks: 1,
            reversal_ticks: 1,
        };
        let mut merged = PvtSteps::new(ramp.start(), least);
        let mut made = [Vec::new(), Vec::new(), Vec::new()];
        for row in ramp.rows() {
            merged.push(&row).unwrap();
            for step in merged.by_ref() {
                made[step.axis].push(step.ticks);
                assert_eq!(Some(step.direction), ramp.directions()[step.axis]);
            }
        }
        assert_eq!(merged.steps(), [500, -123, 0]);
        assert_eq!(merged.end_ticks(), ramp.end_ticks());
        assert_eq!(ramp.axes().map(steps), made);
    }
}

#[test]
fn nothing_to_do_takes_no_time() {
    let ramp = SETTINGS[0].ramp([0, 0]);
    assert_eq!(ramp.end_ticks(), 0);
    assert_eq!(ramp.axes().map(|axis| axis.remaining()), [0, 0]);
    assert!(ramp.edges().next().is_none());
}

/// 1000 steps/s are reached in less than a tick: a ramp of one tick, and the rate is kept.
#[test]
fn a_ramp_takes_a_tick_at_least() {
    for accel_steps_per_s2 in [900_000_000, 2_000_000_000, u32::MAX] {
        let limits = RampLimits {
            start_millihertz: 0,
            max_millihertz: 1_000_000,
            accel_steps_per_s2,
        };
        let ramp = Ramp::new([1000, 0], &limits, Rate::from_hz(1_000_000).unwrap()).unwrap();
        assert_eq!(ramp.end_ticks(), 1_000_001);
        let rises: Vec<_> = ramp.edges().step_by(2).map(|edge| edge.ticks).collect();
        assert_eq!(rises[0], 501);
        assert!(rises.windows(2).all(|pair| pair[1] - pair[0] == 1000));
        // What begins at the rate of another move needs no ramp there.
        let ends = RampEnds {
            entry_millihertz: 1_000_000,
            exit_millihertz: 999_000,
        };
        let ramp = Ramp::between([1000], &limits, ends, Rate::from_hz(1_000_000).unwrap()).unwrap();
        assert_eq!(ramp.end_ticks(), 1_000_000);
        let first = ramp.edges().next().map(|edge| edge.ticks);
        assert_eq!(first, Some(500));
    }
}

#[test]
fn a_ramp_starts_slowly_and_ends_slowly() {
    let limits = RampLimits {
        start_millihertz: 100_000,
        max_millihertz: 500_000,
        accel_steps_per_s2: 40_000,
    };
    let ramp = Ramp::new([8], &limits, Rate::from_hz(2000).unwrap()).unwrap();
    // The first step after (√(100² + 40,000) - 100) / 40,000 s, 6.2 ticks; four ticks a step at
    // top.
    let up_and_down = pulses!["x ______|-|______|-|____|-|___|-|___|-|___|-|____|-|______|-|"];
    let edges = ramp.edges();
    let edges = edges.map(|edge| (edge.ticks, edge.axis, edge.level == Level::High));
    assert_eq!(Pulses::of("x", edges), up_and_down);
}
