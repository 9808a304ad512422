//! Every angle of f32, and many of what cannot be counted. Minutes, so by name only:
//!
//! ```sh
//! cargo test --release -p trig-kernels --test it exhaustive:: -- --ignored --nocapture --test-threads 1
//! ```
//!
//! `ONE_PART_IN=8` takes each eighth part of all that. What they print stands in
//! `docs/book/src/accuracy.md`.

use core::sync::atomic::{AtomicU32, Ordering};
use std::{env, thread};

use trig_kernels::{atan2, atan2_lanes, sin_cos, sin_cos_lanes};

use crate::common::double_double::{Reference, last_place, wide};
use crate::common::worst::{Random, Worst, single};

/// Where angles of f32 and f64 stop being reduced by multiplications: 2^13 and 2^26 quarter turns.
const COMMON_F32: f32 = 12_867.963;
const COMMON_F64: f64 = 105_414_357.0;
/// In units of the last place.
const LIMIT: f64 = 1.0;

/// What two threads found.
fn merge(worst: &mut Worst, found: Worst) {
    let count = worst.count + found.count;
    if found.error > worst.error {
        *worst = found;
    }
    worst.count = count;
}

/// Does the parts 0 to `parts`, or one in so many of them, and gives the worst of each kind.
fn in_threads<const N: usize>(
    parts: u32,
    work: impl Fn(u32, &mut [Worst; N]) + Sync,
) -> [Worst; N] {
    let one_in = env::var("ONE_PART_IN").map_or(1, |parts| parts.parse().unwrap());
    let next = AtomicU32::new(0);
    let done = || {
        let mut worst = [(); N].map(|()| Worst::default());
        loop {
            let part = next.fetch_add(one_in, Ordering::Relaxed);
            if part >= parts {
                return worst;
            }
            work(part, &mut worst);
        }
    };
    thread::scope(|scope| {
        let count = thread::available_parallelism().map_or(1, usize::from);
        let threads: Vec<_> = (0..count).map(|_| scope.spawn(done)).collect();
        let mut worst = [(); N].map(|()| Worst::default());
        for thread in threads {
            let found = thread.join().expect("no thread panics");
            for (worst, found) in worst.iter_mut().zip(found) {
                merge(worst, found);
            }
        }
        worst
    })
}

#[test]
#[ignore = "minutes: `.ci/nightly` runs it"]
fn every_angle_of_f32() {
    const STEP: u32 = 1 << 20;
    // The sign is tested by symmetry, bit by bit.
    let end = f32::INFINITY.to_bits();
    let worst = in_threads(end / STEP + 1, |part, worst: &mut [Worst; 4]| {
        for bits in part * STEP..(part * STEP + STEP).min(end) {
            let x = f32::from_bits(bits);
            let (sin, cos) = sin_cos(x);
            let (sin_minus, cos_minus) = sin_cos(-x);
            assert_eq!(sin_minus.to_bits(), (-sin).to_bits(), "{x:e}");
            assert_eq!(cos_minus.to_bits(), cos.to_bits(), "{x:e}");
            let (sin_exact, cos_exact) = f64::from(x).sin_cos();
            let [a, b, c, d] = worst;
            let (near_sin, near_cos) = if x <= COMMON_F32 { (a, b) } else { (c, d) };
            near_sin.see_f32(sin, sin_exact, x);
            near_cos.see_f32(cos, cos_exact, x);
        }
    });
    for (worst, name) in worst.iter().zip(["sin", "cos", "sin, large", "cos, large"]) {
        println!("f32 {name}: {worst}");
        assert!(worst.error <= LIMIT);
    }
}

#[test]
#[ignore = "minutes: `.ci/nightly` runs it"]
fn ten_thousand_million_vectors_of_f32() {
    const PARTS: u32 = 1 << 13;
    // By eights.
    const EACH: u32 = 1_250_000_000_u32.div_ceil(PARTS);
    let [worst] = in_threads(PARTS, |part, [worst]: &mut [Worst; 1]| {
        let mut random = Random::new(part);
        for _ in 0..EACH {
            let vectors: [[f32; 2]; 8] = core::array::from_fn(|_| random.vector(part).map(single));
            let angles = atan2_lanes(vectors.map(|[_, y]| y), vectors.map(|[x, _]| x));
            for (angle, [x, y]) in angles.into_iter().zip(vectors) {
                worst.see_f32(angle, f64::from(y).atan2(f64::from(x)), (y, x));
            }
        }
    });
    println!("f32 atan2: {worst}");
    assert!(worst.error <= LIMIT);
}

#[test]
#[ignore = "minutes: `.ci/nightly` runs it"]
fn a_hundred_million_angles_of_f64() {
    const PARTS: u32 = 1 << 10;
    const EACH: u32 = 100_000_000_u32.div_ceil(PARTS);
    let reference = Reference::new();
    let worst = in_threads(PARTS, |part, [sin_worst, cos_worst]: &mut [Worst; 2]| {
        let mut random = Random::new(part);
        for _ in 0..EACH {
            let x = random.angle(part, COMMON_F64);
            let (sin, cos) = sin_cos(x);
            let (sin_exact, cos_exact) = reference.sin_cos(x);
            sin_worst.see_f64(sin, sin_exact, x);
            cos_worst.see_f64(cos, cos_exact, x);
            let lanes = sin_cos_lanes([x, -x]);
            assert_eq!(lanes, ([sin, -sin], [cos, cos]), "{x:e}");
        }
    });
    for (worst, name) in worst.iter().zip(["sin", "cos"]) {
        println!("f64 {name}: {worst}");
        assert!(worst.error <= LIMIT);
    }
}

#[test]
#[ignore = "minutes: `.ci/nightly` runs it"]
fn a_hundred_million_vectors_of_f64() {
    const PARTS: u32 = 1 << 10;
    const EACH: u32 = 100_000_000_u32.div_ceil(PARTS);
    let reference = Reference::new();
    let [worst] = in_threads(PARTS, |part, [worst]: &mut [Worst; 1]| {
        let mut random = Random::new(part);
        for _ in 0..EACH {
            let [x, y] = random.vector(part);
            let angle = atan2(y, x);
            // The exact angle of the vector once it is turned back by the one that was found.
            let (sin, cos) = reference.sin_cos(angle);
            let across = wide(y).times(cos).minus(wide(x).times(sin));
            let error = (across.high / x.hypot(y)).abs() / last_place(angle);
            worst.see(error, (y, x));
        }
    });
    println!("f64 atan2: {worst}");
    assert!(worst.error <= LIMIT);
}

/// Where sine and arc tangent rise and the cosine falls, no neighbour goes the other way.
#[test]
#[ignore = "minutes: `.ci/nightly` runs it"]
fn slopes_of_f32() {
    const STEP: u32 = 1 << 20;
    let places = |bits: u32| {
        let x = f32::from_bits(bits);
        let (sin, cos) = sin_cos(x.min(core::f32::consts::FRAC_PI_2));
        [sin, -cos, atan2(x, 1.0)]
    };
    let _: [Worst; 0] = in_threads(f32::INFINITY.to_bits() / STEP, |part, _| {
        let mut before = places(part * STEP);
        for bits in part * STEP + 1..=part * STEP + STEP {
            let now = places(bits);
            let rises = now.iter().zip(before).all(|(now, before)| *now >= before);
            assert!(rises, "{before:?}, then {now:?} at {bits:x}");
            before = now;
        }
    });
}
