//! Ramps against their closed form.
#![cfg(test)]
#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "ticks below 2^53 and counts below 2^31, compared within a tolerance"
)]

use stepper_sync::{Ramp, RampError, RampLimits, Rate, TrainError};

/// The goal: total time within 0.01 % of the closed form.
const TOTAL_RELATIVE: f64 = 1e-4;
/// The end is rounded to whole ticks.
const END_TICKS: f64 = 0.5 + F64_TICKS;
/// Error of this test's own f64 arithmetic, in ticks: 2^40 ticks have 12 bits behind the point.
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

    /// The documented bound of one edge: half a tick and two subticks.
    fn edge_ticks(&self) -> f64 {
        let from_rest = self.tick_hz * self.v() / self.a();
        let subticks = (f64::from(1_u32 << 31) / from_rest)
            .log2()
            .floor()
            .min(16.0)
            .exp2();
        0.5 + 2.0 / subticks + F64_TICKS
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

#[test]
fn every_edge_is_at_its_place_and_the_sum_is_the_end() {
    for s in SETTINGS {
        for n in [1, 2, 3, 4, 5, 10, 33, 100, 1000, 5000, 40_000] {
            let ramp = s.ramp([n]);
            let [axis] = ramp.axes();
            let mut ticks = 0_u64;
            for (k, interval) in (1_u32..).zip(axis) {
                assert!(interval > 0);
                ticks += interval;
                let exact = s.time(f64::from(k) / 2.0, f64::from(n));
                let error = (ticks as f64 - exact).abs();
                assert!(
                    error <= s.edge_ticks(),
                    "edge {k} of {n}, {s:?}: {ticks}, not {exact}"
                );
            }
            assert_eq!(ticks, ramp.end_ticks());
        }
    }
}

/// An acceleration of so many ticks that a subtick is a tick, from a start rate between subticks.
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
        let (mut ticks, ramp) = (0, setting.ramp([n]));
        let [axis] = ramp.axes();
        for (k, interval) in (1_u32..).zip(axis) {
            ticks += interval;
            let exact = setting.time(f64::from(k) / 2.0, f64::from(n));
            let error = (ticks as f64 - exact).abs();
            assert!(
                error <= setting.edge_ticks(),
                "edge {k} of {n}: {ticks}, not {exact}"
            );
        }
        assert_eq!(ticks, ramp.end_ticks());
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
        assert_eq!(leader.sum::<u64>(), ramp.end_ticks());
        assert_eq!(follower.sum::<u64>(), ramp.end_ticks());
    }
}

#[test]
fn followers_keep_the_proportion() {
    for s in SETTINGS {
        let ramp = s.ramp([5000, -1234, 1, 0, 4999]);
        for (axis, m) in ramp.axes().into_iter().zip([5000, 1234, 1, 0, 4999_u32]) {
            assert_eq!(axis.remaining(), 2 * u64::from(m));
            let mut ticks = 0_u64;
            for (k, interval) in (1_u32..).zip(axis) {
                ticks += interval;
                let way = f64::from(k) * 5000.0 / (2.0 * f64::from(m));
                let exact = s.time(way, 5000.0);
                let error = (ticks as f64 - exact).abs();
                assert!(
                    error <= s.edge_ticks(),
                    "edge {k} of {m}, {s:?}: {ticks}, not {exact}"
                );
            }
            assert!(m == 0 || ticks == ramp.end_ticks());
        }
    }
}

#[test]
fn nothing_to_do_takes_no_time() {
    let ramp = SETTINGS[0].ramp([0, 0]);
    assert_eq!(ramp.end_ticks(), 0);
    assert_eq!(ramp.edges().remaining(), 0);
    assert!(ramp.edges().next().is_none());
}

#[test]
fn errors_name_value_and_limit() {
    let rate = Rate::from_hz(1_000_000).unwrap();
    let limits = RampLimits {
        start_millihertz: 100,
        max_millihertz: 1_000_000,
        accel_steps_per_s2: 1000,
    };
    let error = |limits: RampLimits, steps, rate| Ramp::new([0, steps], &limits, rate).unwrap_err();
    assert_eq!(
        error(
            RampLimits {
                max_millihertz: 0,
                start_millihertz: 0,
                ..limits
            },
            1,
            rate
        ),
        RampError::ZeroMaxRate
    );
    assert_eq!(
        error(
            RampLimits {
                accel_steps_per_s2: 0,
                ..limits
            },
            1,
            rate
        ),
        RampError::ZeroAcceleration
    );
    assert_eq!(
        error(
            RampLimits {
                max_millihertz: 99,
                ..limits
            },
            1,
            rate
        ),
        RampError::StartAboveMax {
            start_millihertz: 100,
            max_millihertz: 99
        }
    );
    assert_eq!(
        error(
            RampLimits {
                max_millihertz: 250_000_001,
                ..limits
            },
            1,
            rate
        ),
        RampError::RateTooHigh {
            max_millihertz: 250_000_001,
            limit_millihertz: 250_000_000
        }
    );
    // 168 MHz * 100 kHz / 2^31 = 7823 steps/s².
    let fast = Rate::from_hz(168_000_000).unwrap();
    let slow = RampLimits {
        max_millihertz: 100_000_000,
        accel_steps_per_s2: 7823,
        ..limits
    };
    assert_eq!(
        error(slow, 1, fast),
        RampError::AccelerationTooLow {
            accel_steps_per_s2: 7823,
            limit_steps_per_s2: 7824,
            max_millihertz: 100_000_000
        }
    );
    assert!(
        Ramp::new(
            [1],
            &RampLimits {
                accel_steps_per_s2: 7824,
                ..slow
            },
            fast
        )
        .is_ok()
    );
    assert_eq!(
        error(limits, i32::MIN, rate),
        RampError::Steps(TrainError::TooManySteps {
            axis: 1,
            steps: i32::MIN,
            limit: i32::MAX
        })
    );
    let odd = Rate::new(u32::MAX, 1 << 21).unwrap();
    assert_eq!(
        error(limits, 1, odd),
        RampError::TickRate {
            rate: odd,
            limit: 1 << 20
        }
    );
    let crawl = RampLimits {
        start_millihertz: 1,
        max_millihertz: 1,
        ..limits
    };
    let fastest = Rate::from_hz(u32::MAX).unwrap();
    assert_eq!(
        error(crawl, i32::MAX, fastest),
        RampError::TooLong {
            steps: 0x7FFF_FFFF,
            bits: 61
        }
    );
}
