//! From knots in seconds and units to rows: what is documented of the departure, and refusals.
#![expect(clippy::cast_precision_loss, reason = "compared within a stated bound")]

use proptest::prelude::*;
use pvt_steps::{KnotError, PvtKnot, PvtQuantiser, PvtRow, Rate, StepScale};

/// What `f64` loses, in steps (2^-30 is documented), steps a tick and steps a tick²: some units of
/// 2^-53 of ten steps a tick and of what they change by in a row of 500 ticks.
const F64: [f64; 3] = [9.3e-10, 1e-14, 1e-16];

/// A cubic: position at the fraction s of T ticks, from positions and velocities a tick at its
/// ends.
#[derive(Clone, Copy, Debug)]
struct Cubic {
    ticks: f64,
    q: [f64; 4],
}

impl Cubic {
    fn new(from: (f64, f64), to: (f64, f64), ticks: f64) -> Self {
        let (travel, v0, v1) = (to.0 - from.0, from.1 * ticks, to.1 * ticks);
        let q = [
            from.0,
            v0,
            3.0 * travel - 2.0 * v0 - v1,
            v0 + v1 - 2.0 * travel,
        ];
        Self { ticks, q }
    }

    /// Position, velocity and acceleration.
    fn at(&self, tick: f64) -> [f64; 3] {
        let s = tick / self.ticks;
        let [a, b, c, d] = self.q;
        [
            a + s * (b + s * (c + s * d)),
            (b + s * (2.0 * c + s * 3.0 * d)) / self.ticks,
            (2.0 * c + s * 6.0 * d) / self.ticks.powi(2),
        ]
    }
}

fn in_steps(knot: PvtKnot) -> (f64, f64) {
    (
        knot.position as f64 / 32_f64.exp2(),
        knot.velocity as f64 / 56_f64.exp2(),
    )
}

/// Knots of one axis: milliseconds after the one before, steps, and steps a second.
fn motions() -> impl Strategy<Value = Vec<(f64, f64, f64)>> {
    prop::collection::vec(
        (0.5..20.0_f64, -300.0..300.0_f64, -30_000.0..30_000.0_f64),
        1..8,
    )
}

proptest! {
    #[test]
    fn rows_depart_from_the_motion_by_what_is_documented(
        motion in motions(),
        tick_hz in 1_000_000..200_000_000_u32,
    ) {
        let hz = f64::from(tick_hz);
        let rate = Rate::from_hz(tick_hz).unwrap();
        let mut pvt = PvtQuantiser::new(rate, [StepScale::new(1.0).unwrap()], [0.0]).unwrap();
        let [mut knot] = pvt.knots();
        let (mut time, mut start_tick) = (0.0, 0.0);
        // The motion in ticks: where each cubic begins.
        let mut last = (0.0, 0.0);
        let mut pieces: Vec<(f64, Cubic)> = Vec::new();
        for (ms, position, velocity) in motion {
            let began = time * hz;
            time += ms / 1000.0;
            let to = (position, velocity / hz);
            pieces.push((began, Cubic::new(last, to, time * hz - began)));
            last = to;
            let row = pvt.row(time, [position], [velocity]).unwrap();
            let [end] = row.knots;
            let cubic = Cubic::new(in_steps(knot), in_steps(end), f64::from(row.ticks));
            let ticks = cubic.ticks;
            // The most by which accelerations differ where two cubics of the motion meet.
            let [one, other] = match pieces[..] {
                [.., (_, a), (_, b)] => {
                    [0.0, 1.0].map(|n| (a.at(a.ticks - n)[2] - b.at(-n)[2]).abs())
                }
                _ => [0.0; 2],
            };
            let a = one.max(other);
            let bounds = [
                a * (4.0 / 27.0 * ticks + 0.5) + (-33_f64).exp2() + 0.3 * (-57_f64).exp2() * ticks,
                a * (1.0 + 0.75 / ticks) + (-57_f64).exp2() + 1.5 * (-32_f64).exp2() / ticks,
                a * (4.0 / ticks + 3.0 / ticks.powi(2))
                    + 6.0 * (-57_f64).exp2() / ticks
                    + 6.0 * (-32_f64).exp2() / ticks.powi(2),
            ];
            for n in 0..=50 {
                let tick = ticks * f64::from(n) / 50.0;
                let now = start_tick + tick;
                let &(began, piece) = pieces.iter().rev().find(|piece| piece.0 <= now).unwrap();
                let wanted = piece.at(now - began);
                let made = cubic.at(tick);
                for k in 0..3 {
                    // Within a tick of a knot the acceleration is that of one cubic or the other.
                    let near = (now - began).min(began + piece.ticks - now) < 1.0;
                    if k == 2 && near {
                        continue;
                    }
                    let off = (made[k] - wanted[k]).abs();
                    prop_assert!(
                        off <= bounds[k] + F64[k],
                        "{k}: {off}, not {}, at {tick} of {ticks}",
                        bounds[k]
                    );
                }
            }
            start_tick += ticks;
            knot = end;
        }
    }

    #[test]
    fn any_numbers_make_a_row_or_a_reason(
        time in any::<f64>(),
        position in any::<f64>(),
        velocity in any::<f64>(),
        hz in 1..=u32::MAX,
    ) {
        let one = StepScale::new(1.0).unwrap();
        let mut pvt = PvtQuantiser::new(Rate::from_hz(hz).unwrap(), [one], [0.0]).unwrap();
        let before = pvt.clone();
        match pvt.row(time, [position], [velocity]) {
            Ok(row) => {
                let off = f64::from(row.ticks) / f64::from(hz) - time;
                prop_assert!(off.abs() <= 1.0 / f64::from(hz));
            }
            Err(error) => {
                prop_assert_eq!(pvt.knots(), before.knots());
                match error {
                    KnotError::Time { .. } => {
                        let ticks = time * f64::from(hz);
                        prop_assert!(!(0.0..4_294_967_296.0).contains(&ticks));
                    }
                    KnotError::Moved { .. } | KnotError::Jump { .. } => {
                        prop_assert!((0.0..1.0).contains(&(time * f64::from(hz))));
                    }
                    KnotError::Position { .. } | KnotError::Velocity { .. } => {}
                    other => prop_assert!(false, "{other}"),
                }
            }
        }
        match pvt.jump([velocity]) {
            Ok(row) => prop_assert_eq!((row.ticks, row.knots), (0, pvt.knots())),
            Err(error) => {
                let in_range = (velocity / f64::from(hz)).abs() < 127.9;
                let named = matches!(error, KnotError::Velocity { axis: 0, .. });
                prop_assert!(named && !in_range);
            }
        }
    }
}

#[test]
fn rows_by_hand() {
    // 80 steps/mm, 1 MHz: from rest to 10 mm/s in 0.1 s over 0.5 mm.
    let rate = Rate::from_hz(1_000_000).unwrap();
    let scale = StepScale::new(80.0).unwrap();
    let mut pvt = PvtQuantiser::new(rate, [scale], [1.0]).unwrap();
    assert_eq!(pvt.knots(), [PvtKnot::at_rest(80)]);
    let moving = PvtKnot {
        position: 120 << 32,
        // 800 steps/s are 0.0008 a tick; to the nearest.
        velocity: ((1_i64 << 56) * 8 + 5000) / 10_000,
    };
    let row = PvtRow {
        ticks: 100_000,
        knots: [moving],
    };
    assert_eq!(pvt.row(0.1, [1.5], [10.0]), Ok(row));
    // At once to rest.
    let rest = PvtRow {
        ticks: 0,
        knots: [PvtKnot::at_rest(120)],
    };
    assert_eq!(pvt.jump([0.0]), Ok(rest));
    assert_eq!(pvt.knots(), rest.knots);
}

/// At a corner between ticks the velocities jump within what the motors start and stop with, and
/// the row after it departs by what is documented: at constant speeds by less than the jump a tick.
#[test]
fn a_knot_of_the_same_time_is_a_jump() {
    let hz = 1_000_000.0;
    let scale = StepScale::new(1.0).unwrap();
    let new = || {
        let rate = Rate::from_hz(1_000_000).unwrap();
        PvtQuantiser::new(rate, [scale; 2], [0.0; 2])
            .unwrap()
            .with_start_stop_speeds([300.0; 2])
    };
    for early in [0.0, 0.3, 0.7, 0.999] {
        let mut pvt = new();
        let corner_s = (1000.0 + early) / hz;
        pvt.jump([1000.0, 250.0]).unwrap();
        let at = |time_s: f64, [x, y]: [f64; 2]| {
            let since = time_s - corner_s;
            [1000.0 * corner_s + x * since, 250.0 * corner_s + y * since]
        };
        pvt.row(corner_s, at(corner_s, [0.0; 2]), [1000.0, 250.0])
            .unwrap();
        let [after_x, after_y] = [1250.0, -50.0];
        let row = pvt
            .row(corner_s, at(corner_s, [0.0; 2]), [after_x, after_y])
            .unwrap();
        assert_eq!(row.ticks, 0);
        let start = row.knots.map(in_steps);
        let end_s = (4000.0 + early) / hz;
        let row = pvt
            .row(end_s, at(end_s, [after_x, after_y]), [after_x, after_y])
            .unwrap();
        assert_eq!(row.ticks, 3000);
        let end = row.knots.map(in_steps);
        let jump = 300.0 / hz;
        for (axis, velocity) in [after_x, after_y].into_iter().enumerate() {
            let cubic = Cubic::new(start[axis], end[axis], 3000.0);
            for n in 0..=30 {
                let tick = 100.0 * f64::from(n);
                let [position, speed, acceleration] = cubic.at(tick);
                let wanted = at((1000.0 + tick) / hz, [after_x, after_y])[axis];
                // Rounding to 2^-33 steps and 2^-57 steps a tick, and of f64.
                let rounding = 3e-10;
                assert!((position - wanted).abs() <= jump * early + rounding);
                assert!((speed - velocity / hz).abs() <= 1.5 * jump * early / 3000.0 + 1e-12);
                assert!(acceleration.abs() <= 6.0 * jump * early / 3000.0_f64.powi(2) + 1e-15);
            }
        }
    }
    let mut pvt = new();
    pvt.row(0.001, [1.0, 0.0], [0.0; 2]).unwrap();
    let before = pvt.clone();
    let refused = |positions, velocities| {
        let mut pvt = before.clone();
        let error = pvt.row(0.001, positions, velocities).unwrap_err();
        assert_eq!(pvt, before);
        error
    };
    use KnotError as E;
    let error = refused([1.0, 0.0], [300.0, -301.0]);
    let sentence = "axis 1: velocity jumps by 0.000301 steps a tick, more than 0.0003";
    assert_eq!(error.to_string(), sentence);
    let error = refused([1.1, 0.0], [0.0; 2]);
    assert!(matches!(error, E::Moved { axis: 0, .. }), "{error}");
    let error = refused([1.0, f64::NAN], [0.0; 2]);
    assert!(matches!(error, E::Position { axis: 1, .. }), "{error}");
    let error = refused([1.0, 0.0], [f64::NAN, 0.0]);
    assert!(matches!(error, E::Velocity { axis: 0, .. }), "{error}");
    // A start-stop speed that is no number allows no jump.
    let mut pvt = new().with_start_stop_speeds([300.0, f64::NAN]);
    let error = pvt.row(0.0, [0.0; 2], [300.0, 0.0]).unwrap_err();
    assert!(matches!(error, KnotError::Jump { axis: 1, .. }), "{error}");
}

#[test]
fn refusals_name_the_axis_and_the_value() {
    let rate = Rate::from_hz(1_000_000).unwrap();
    let scales = [StepScale::new(1.0).unwrap(); 2];
    let mut pvt = PvtQuantiser::new(rate, scales, [0.0; 2]).unwrap();
    let error = pvt.row(1.0, [0.0, 3e9], [0.0; 2]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "axis 1: position 3e9 steps, not within 2^31"
    );
    let error = pvt.row(1.0, [0.0; 2], [f64::NAN, 0.0]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "axis 0: velocity NaN steps a tick, not within 128"
    );
    pvt.row(1.0, [0.0; 2], [0.0; 2]).unwrap();
    for time_s in [0.5, 0.999_999_9, f64::NAN, 1e300, 5000.0] {
        let refused = pvt.row(time_s, [0.0; 2], [0.0; 2]);
        assert!(matches!(refused, Err(KnotError::Time { .. })), "{time_s}");
    }
    assert_eq!(
        pvt.row(0.5, [0.0; 2], [0.0; 2]).unwrap_err().to_string(),
        "time 0.5 s is not 0 to 2^32 - 1 whole ticks after 1 s"
    );
    // No message has the 300 digits of a number.
    for (time_s, position, velocity) in [(1e300, 0.0, 0.0), (2.0, -1e300, 0.0), (2.0, 0.0, 1e300)] {
        let error = pvt
            .row(time_s, [position, 0.0], [velocity, 0.0])
            .unwrap_err();
        assert!(error.to_string().len() < 80, "{error}");
    }
    let outside = PvtQuantiser::new(rate, scales, [f64::INFINITY, 0.0]);
    assert!(matches!(outside, Err(KnotError::Position { axis: 0, .. })));
}

/// Rows of 0.17 us, as short lines between rounded corners have, and any others shorter than a tick
/// do not end a motion, and leave it where it is.
#[test]
fn knots_in_one_tick_are_merged() {
    // 100 steps/mm at 1 MHz: a circle of 40 mm at 300 mm/s.
    let (hz, radius, rate) = (1e6, 4000.0, 7.5);
    let at = |time_s: f64| {
        let (sin, cos) = (rate * time_s).sin_cos();
        (
            [radius * cos, radius * sin],
            [-radius * rate * sin, radius * rate * cos],
        )
    };
    let scale = StepScale::new(1.0).unwrap();
    let mut pvt =
        PvtQuantiser::new(Rate::from_hz(1_000_000).unwrap(), [scale; 2], at(0.0).0).unwrap();
    pvt.jump(at(0.0).1).unwrap();
    let (mut time_s, mut ticks, mut merged) = (0.0, 0_u64, 0);
    let mut knots = pvt.knots();
    for k in 0..20_000_u32 {
        // 10 ps to 1 ms.
        let short = 10_f64.powf(-11.0 + 8.0 * (f64::from(k) * 0.618_034).fract());
        time_s += short;
        let (position, velocity) = at(time_s);
        let row = pvt.row(time_s, position, velocity).unwrap();
        if row.ticks == 0 {
            assert_eq!(row.knots, knots);
            merged += 1;
            continue;
        }
        let [before, after] = [knots, row.knots].map(|knots| knots.map(in_steps));
        for axis in 0..2 {
            let cubic = Cubic::new(before[axis], after[axis], f64::from(row.ticks));
            for n in 0..=8 {
                let tick = cubic.ticks * f64::from(n) / 8.0;
                let wanted = at((ticks as f64 + tick) / hz).0[axis];
                // The motion's own cubics are off by a T^4/384 and what is rounded by 2^-32.
                let chord = radius * (rate * cubic.ticks / hz).powi(4) / 384.0;
                let off = (cubic.at(tick)[0] - wanted).abs();
                assert!(off <= 1e-6 + chord, "{off:e} {chord:e} {}", row.ticks);
            }
        }
        ticks += u64::from(row.ticks);
        knots = row.knots;
    }
    assert!(merged > 5000, "{merged}");
    assert!((ticks as f64 / hz - time_s).abs() <= 1.0 / hz);
}

/// A speed that is reached within a tick: the row after it departs by what is stated, and not at all
/// after a jump.
#[test]
fn a_speed_reached_within_a_tick_is_a_departure_or_a_jump() {
    let (speed, ticks) = (0.02, 50_000.0);
    let scale = StepScale::new(1.0).unwrap();
    for within_s in [1e-9, 3e-7, 9e-7] {
        let started = |jumps: bool| {
            let hz = Rate::from_hz(1_000_000).unwrap();
            let mut pvt = PvtQuantiser::new(hz, [scale], [0.0]).unwrap();
            if jumps {
                pvt.jump([speed * 1e6]).unwrap();
            } else {
                let position = speed * 1e6 * within_s / 2.0;
                assert_eq!(
                    pvt.row(within_s, [position], [speed * 1e6]).unwrap().ticks,
                    0
                );
            }
            let before = pvt.knots().map(in_steps)[0];
            let row = pvt
                .row(ticks / 1e6, [speed * ticks], [speed * 1e6])
                .unwrap();
            Cubic::new(before, row.knots.map(in_steps)[0], f64::from(row.ticks))
        };
        let (merged, jumped) = (started(false), started(true));
        let mut most = 0.0_f64;
        for n in 0..=1000 {
            let tick = ticks * f64::from(n) / 1000.0;
            let off = (merged.at(tick)[0] - speed * tick).abs();
            most = most.max(off);
            assert!((jumped.at(tick)[0] - speed * tick).abs() < 1e-6);
        }
        let stated = speed * (4.0 / 27.0 * ticks + 1.0);
        assert!(most <= stated && most > 0.99 * stated, "{most} {stated}");
    }
}

/// What is elsewhere within a tick is no motion, and the axes can still be brought to rest.
#[test]
fn a_knot_elsewhere_in_the_same_tick_is_refused() {
    let scale = StepScale::new(1.0).unwrap();
    let mut pvt = PvtQuantiser::new(Rate::from_hz(1_000_000).unwrap(), [scale], [0.0]).unwrap();
    pvt.row(0.01, [50.0], [10_000.0]).unwrap();
    let before = pvt.clone();
    let error = pvt.row(0.010_000_3, [50.5], [10_000.0]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "axis 0: 0.5 steps between two knots of a tick, not the 0.003 of their velocities"
    );
    assert_eq!(pvt, before);
    // The same knot again, and one that only rounding sets apart.
    assert_eq!(pvt.row(0.01, [50.0], [10_000.0]).unwrap().ticks, 0);
    assert_eq!(pvt.row(0.010_000_3, [50.003], [10_000.0]).unwrap().ticks, 0);
    let error = pvt.row(0.010_000_3, [50.003], [9_000.0]).unwrap_err();
    assert!(matches!(error, KnotError::Jump { max: 0.0, .. }), "{error}");
    let rest = pvt.row(0.02, [100.0], [0.0]).unwrap();
    assert_eq!((rest.ticks, rest.knots), (10_000, [PvtKnot::at_rest(100)]));
}
