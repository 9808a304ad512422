//! Time per function value: one by one and in lanes, beside `libm` and the standard library.
//!
//! Ratios within one run count, not the figures: a machine's speed drifts. For the lanes of a newer
//! processor: `RUSTFLAGS='-C target-cpu=haswell'`.

use core::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use trig_kernels::{Trig, atan2, atan2_lanes, sin_cos, sin_cos_lanes};

const COUNT: usize = 1024;

/// Evenly from -1 to 1, the same every time.
fn numbers(seed: u32) -> Vec<f64> {
    let mut state = seed;
    let next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state.cast_signed()) / 2f64.powi(31)
    };
    core::iter::repeat_with(next).take(COUNT).collect()
}

fn each<T: Copy, R>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    input: &[T],
    function: impl Fn(T) -> R,
) {
    group.bench_function(name, |b| {
        b.iter(|| {
            for &value in input {
                black_box(function(black_box(value)));
            }
        });
    });
}

/// What a function is called, and the function.
type Named<T, R> = (&'static str, fn(T) -> R);

/// One function of one precision: each of `singles`, and eight at once.
fn compare<T: Copy, R, R8>(
    c: &mut Criterion,
    title: &str,
    input: &[T],
    singles: &[Named<T, R>],
    lanes: impl Fn([T; 8]) -> R8,
) {
    let mut group = c.benchmark_group(title);
    group.throughput(Throughput::Elements(COUNT as u64));
    for (name, function) in singles {
        each(&mut group, name, input, function);
    }
    let (chunks, _) = input.as_chunks();
    each(&mut group, "eight lanes", chunks, lanes);
    group.finish();
}

/// Both functions of one precision, each beside `libm`'s and the standard library's.
fn kernels<T: Trig>(
    c: &mut Criterion,
    precision: &str,
    number: fn(f64) -> T,
    sines: [fn(T) -> (T, T); 2],
    angles: [fn([T; 2]) -> T; 2],
) {
    let turn: Vec<T> = numbers(1).iter().map(|v| number(4.0 * v)).collect();
    let [libm, std] = sines;
    compare(
        c,
        &format!("sin_cos, {precision}"),
        &turn,
        &[("this", sin_cos), ("libm", libm), ("std", std)],
        sin_cos_lanes,
    );
    let vectors: Vec<[T; 2]> = numbers(2)
        .iter()
        .zip(numbers(3))
        .map(|(&y, x)| [number(300.0 * y), number(300.0 * x)])
        .collect();
    let [libm, std] = angles;
    compare(
        c,
        &format!("atan2, {precision}"),
        &vectors,
        &[("this", |[y, x]| atan2(y, x)), ("libm", libm), ("std", std)],
        |vectors| atan2_lanes(vectors.map(|[y, _]| y), vectors.map(|[_, x]| x)),
    );
}

#[expect(clippy::cast_possible_truncation, reason = "to the nearest")]
fn single(x: f64) -> f32 {
    x as f32
}

fn both(c: &mut Criterion) {
    kernels::<f32>(
        c,
        "f32",
        single,
        [libm::sincosf, f32::sin_cos],
        [|[y, x]| libm::atan2f(y, x), |[y, x]| y.atan2(x)],
    );
    kernels::<f64>(
        c,
        "f64",
        |v| v,
        [libm::sincos, f64::sin_cos],
        [|[y, x]| libm::atan2(y, x), |[y, x]| y.atan2(x)],
    );
}

criterion_group!(benches, both);
criterion_main!(benches);
