//! Random knots and rows: such as machines have, and anything.

use pvt_steps::{MinIntervals, PvtKnot};
use test_support::Random;

/// Of all magnitudes.
fn magnitude(random: &mut Random, low: f64, high: f64) -> f64 {
    random.within(low.ln(), high.ln()).exp()
}

fn sign(random: &mut Random) -> f64 {
    if random.below(2) == 0 { 1.0 } else { -1.0 }
}

pub(crate) fn knot(position: f64, velocity: f64) -> PvtKnot {
    PvtKnot {
        position: (position * 32_f64.exp2()) as i64,
        velocity: (velocity * 56_f64.exp2()) as i64,
    }
}

/// A next knot: rows of all kinds.
pub(crate) fn next_row(random: &mut Random, from: PvtKnot, least: MinIntervals) -> (u32, PvtKnot) {
    let max = 1.0 / (least.step_ticks + 2) as f64;
    let q0 = from.position as f64 / 32_f64.exp2();
    let v0 = from.velocity as f64 / 56_f64.exp2();
    let ticks = match random.below(8) {
        0 => magnitude(random, 1.0, 40.0),
        1 => magnitude(random, 1.0, 4e9),
        _ => magnitude(random, 100.0, 1e7),
    };
    // Most rows of some hundred steps at most: a step costs the test more than the emitter.
    let t = ticks.min(300.0 / v0.abs()).floor().max(1.0);
    let fast = match random.below(256) {
        0 => 1e4 / t,
        1..=16 => magnitude(random, 1e-15, 1e3 / t),
        17..=20 => 3e3 / t,
        21..=60 => magnitude(random, 1.0, 1e3) / t,
        _ => magnitude(random, 0.1, 100.0) / t,
    }
    .min(max);
    let v1 = match random.below(6) {
        0 => 0.0,
        1 => sign(random) * fast,
        2 => (v0 * random.within(0.5, 1.5)).clamp(-fast, fast),
        3 => v0.clamp(-fast, fast),
        _ => sign(random) * fast * random.share(),
    };
    let travel = match random.below(8) {
        // As with constant acceleration.
        0..=3 => (v0 + v1) / 2.0 * t,
        // Whatever.
        4 => random.within(-1.0, 1.0) * (max * t).min(100.0),
        5 => random.within(-1.0, 1.0) * fast * t,
        // Some acceleration more at one end than at the other.
        6 => ((v0 + v1) / 2.0 + random.within(-0.2, 0.2) * (v0.abs() + v1.abs())) * t,
        _ => random.within(-3.0, 3.0),
    };
    let mut q1 = q0 + travel;
    match random.below(16) {
        0..=3 => q1 = q1.round(),
        // On the place of a step, or next to it.
        4 => q1 = q1.floor() + 0.5,
        5 => q1 = q1.floor() + 0.5 + sign(random) * magnitude(random, 1e-9, 1e-2),
        6 => q1 = q0,
        _ => {}
    }
    if q1.abs() > 2e9 {
        q1 = 0.0;
    }
    (t as u32, knot(q1, v1))
}

/// Numbers of every size, most of them at an end of one.
pub(crate) fn any_u64(random: &mut Random) -> u64 {
    let power = 1_u64 << random.below(64);
    match random.below(8) {
        0 => 0,
        1 => u64::MAX - random.below(3),
        2 | 3 => (power - 1).wrapping_add(random.below(3)),
        _ => random.bits() >> random.below(64),
    }
}

pub(crate) fn any_i64(random: &mut Random) -> i64 {
    let number = any_u64(random).cast_signed();
    if random.below(2) == 0 {
        number
    } else {
        number.wrapping_neg()
    }
}

/// A row of anything, most of them not too fast.
pub(crate) fn any_row(random: &mut Random, from: PvtKnot, least: MinIntervals) -> (u32, PvtKnot) {
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
        let travel = i128::from(to.position) % (most * 2 / 3 + 1);
        to.position = i64::try_from(i128::from(from.position) + travel).unwrap_or(to.position);
    }
    match random.below(8) {
        0 => to.position = from.position,
        1 => to.position = (to.position >> 31 | 1) << 31,
        2 => to.velocity = from.velocity.wrapping_neg(),
        _ => {}
    }
    (ticks, to)
}
