//! Time of what a planner asks of a segment: the arms' own proofs beside those that follow from their
//! inverses alone. Ratios within one run count.
#![expect(clippy::expect_used, reason = "a bench stops at once")]

#[path = "../tests/it/common/arms.rs"]
mod arms;

use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use delta_kin::{Delta, DeltaPath, Dimensions};
use machine_kin::path_timing::{Accuracy, AxisLimits, Curve, Knot, Path, Span, Table};
use machine_kin::{Elbow, Machine, MachinePath};
use scara_kin::{Arm, ArmPath};

use arms::{RotaryDelta, TwoLinks};

/// The segments of a path that keep a hundredth of a millimetre.
fn spans<P: Path<Axes = [f64; N]>, const N: usize>(
    path: &P,
    departure: impl Fn(&&P, &Span<[f64; N]>) -> f64,
) -> Vec<Span<[f64; N]>>
where
    P::Error: core::fmt::Debug,
{
    let joint = AxisLimits {
        speed: 6.0,
        acceleration: 100.0,
        jerk: None,
    };
    let accuracy = Accuracy {
        min_segments: 8,
        max_departure: 0.01,
        max_time_ratio: f64::INFINITY,
    };
    let mut knots = vec![Knot::default(); 1000];
    let table = Table::plan_within([path], [joint; N], accuracy, departure, &mut knots);
    table.expect("it can be planned").spans().collect()
}

fn both<P, Q, const N: usize>(
    c: &mut Criterion,
    name: &str,
    (by_hand, own): (&P, &Q),
    departures: (
        impl Fn(&P, &Span<[f64; N]>) -> f64,
        impl Fn(&Q, &Span<[f64; N]>) -> f64,
    ),
) where
    P: Path<Axes = [f64; N]>,
    Q: Path<Axes = [f64; N]>,
    P::Error: core::fmt::Debug,
{
    let spans = spans(by_hand, |path, span| departures.0(path, span));
    let mut group = c.benchmark_group(format!("{name}, {} segments", spans.len()));
    group.bench_function("by hand, check", |b| {
        b.iter(|| {
            spans
                .iter()
                .filter(|span| by_hand.check(black_box(span)).is_ok())
                .count()
        });
    });
    group.bench_function("by hand, bound", |b| {
        b.iter(|| {
            spans
                .iter()
                .map(|span| departures.0(by_hand, black_box(span)))
                .sum::<f64>()
        });
    });
    group.bench_function("mechanism, check", |b| {
        b.iter(|| {
            spans
                .iter()
                .filter(|span| own.check(black_box(span)).is_ok())
                .count()
        });
    });
    group.bench_function("mechanism, bound", |b| {
        b.iter(|| {
            spans
                .iter()
                .map(|span| departures.1(own, black_box(span)))
                .sum::<f64>()
        });
    });
    group.finish();
}

fn arm(c: &mut Criterion) {
    let curves = [
        Curve::line([-80.0, 100.0], [80.0, 100.0]),
        Curve::arc([180.0, 0.0], [130.0, 0.0], [0.0, 1.0], 3.0),
        Curve::bezier([
            [-100.0, 100.0],
            [-50.0, 220.0],
            [60.0, 60.0],
            [120.0, 150.0],
        ]),
    ];
    for (name, curve) in ["line", "arc", "curve"].into_iter().zip(curves) {
        let curve = curve.expect("a curve");
        let arm = Arm::new(132.0, 132.0).expect("lengths");
        let by_hand = arm.path(curve, scara_kin::Elbow::Right).expect("a path");
        let machine = TwoLinks {
            upper: 132.0,
            fore: 132.0,
            base: [0.0; 3],
        };
        let own = machine.path(curve, Elbow::Right).expect("a path");
        let departures = (ArmPath::departure, MachinePath::departure);
        both(c, &format!("arm, {name}"), (&by_hand, &own), departures);
    }
}

fn delta(c: &mut Criterion) {
    let curves = [
        Curve::line([50.0, 50.0, -300.0], [-50.0, 50.0, -280.0]),
        Curve::arc(
            [60.0, 0.0, -260.0],
            [0.0, 0.0, -260.0],
            [0.0, 1.0, 0.0],
            3.0,
        ),
    ];
    for (name, curve) in ["line", "arc"].into_iter().zip(curves) {
        let curve = curve.expect("a curve");
        let delta = Delta::new(Dimensions {
            base: 42.0,
            platform: 18.0,
            upper: 120.0,
            lower: 243.0,
        })
        .expect("lengths");
        let by_hand = delta.path(curve).expect("a path");
        let machine = RotaryDelta {
            radius: 24.0,
            upper: 120.0,
            lower: 243.0,
            zero: 0.0,
        };
        let own = machine.path(curve, ()).expect("a path");
        let departures = (DeltaPath::departure, MachinePath::departure);
        both(c, &format!("Delta, {name}"), (&by_hand, &own), departures);
    }
}

criterion_group!(benches, arm, delta);
criterion_main!(benches);
