//! Time of a plan, of its rows and of a run, for three axes and for nine.
#![expect(clippy::expect_used, reason = "a bench stops at once")]

use core::convert::Infallible;
use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use path_timing::{
    AxisLimits, Curve, FeedCeiling, Knot, LookAhead, PathFn, PathPoint, Table, TorqueCurve,
    TorqueLimits,
};
use scara_kin::{Arm, ArmMasses, Elbow, JointDrive, LinkMass};

/// Segments of the path.
const SEGMENTS: u32 = 1000;

/// Axes that swing along the path, each by its own frequency: the path costs little itself.
fn swing<const N: usize>(s: f64) -> Result<PathPoint<[f64; N]>, Infallible> {
    let (sin, cos) = (s * 1.5).sin_cos();
    let mut point = PathPoint {
        position: [0.0; N],
        slope: [0.0; N],
    };
    let axes = point.position.iter_mut().zip(&mut point.slope);
    for (number, (position, slope)) in (1..).zip(axes) {
        let amplitude = f64::from(number) / 10.0;
        *position = amplitude * sin + s;
        *slope = amplitude * cos * 1.5 + 1.0;
    }
    Ok(point)
}

fn measure<const N: usize>(criterion: &mut Criterion) {
    let limits = |jerk| {
        [AxisLimits {
            speed: 1.0,
            acceleration: 3.0,
            jerk,
        }; N]
    };
    let path = PathFn::new(4.0, swing::<N>);
    let mut group = criterion.benchmark_group(format!("{N} axes, {SEGMENTS} segments"));
    for (name, jerk) in [("plan", None), ("plan with jerk", Some(20.0))] {
        let mut knots = vec![Knot::default(); 1001];
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let table = Table::plan([&path], limits(jerk), |_| SEGMENTS, black_box(&mut knots));
                table.expect("plan is good").duration_s()
            });
        });
    }
    let mut knots = vec![Knot::default(); 1001];
    let table = Table::plan([&path], limits(None), |_| SEGMENTS, &mut knots);
    let table = table.expect("plan is good");
    group.bench_function("rows", |bencher| {
        bencher.iter(|| table.rows().map(black_box).count());
    });
    let mut ahead = vec![FeedCeiling::default(); 1001];
    group.bench_function("run", |bencher| {
        bencher.iter(|| {
            let run = table.playback(1.0, black_box(&mut ahead));
            let run = run.expect("memory is enough");
            run.map(black_box).count()
        });
    });
}

/// The same path over and over, back and forth, as a stream.
fn measure_stream<const N: usize>(criterion: &mut Criterion) {
    let back = |s: f64| {
        let mut point = swing::<N>(4.0 - s)?;
        for slope in &mut point.slope {
            *slope = -*slope;
        }
        Ok(point)
    };
    let mut group = criterion.benchmark_group(format!("{N} axes, {SEGMENTS} segments"));
    for (name, jerk, slots) in [
        ("look ahead, 64 slots", None, 64),
        ("look ahead with jerk, 200 slots", Some(20.0), 200),
    ] {
        let limits = [AxisLimits {
            speed: 1.0,
            acceleration: 3.0,
            jerk,
        }; N];
        let mut window = vec![Knot::default(); slots];
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let paths = [swing::<N> as fn(f64) -> _, back].map(|point| PathFn::new(4.0, point));
                let segments = |_: &_| Ok(SEGMENTS / 2);
                let motion = LookAhead::new(&paths, limits, segments, black_box(&mut window));
                let motion = motion.expect("window is long enough");
                motion.filter(|row| black_box(row).is_ok()).count()
            });
        });
    }
}

/// A line of a two-link arm, with limits of its joints and with the torques of its motors.
fn measure_torque(criterion: &mut Criterion) {
    let arm = Arm::new(300.0, 300.0).expect("links are good");
    let link = LinkMass {
        mass_kg: 2.5,
        centre_m: 0.14,
        inertia_kg_m2: 0.03,
    };
    let drive = JointDrive {
        rotor_kg_m2: 0.08,
        viscous_nm_s: 0.3,
        coulomb_nm: 0.8,
    };
    let masses = ArmMasses {
        upper: link,
        fore: link,
        payload_kg: 1.0,
        shoulder: drive,
        elbow: drive,
        gravity_m_s2: 0.0,
    };
    let motors = [30.0, 12.0].map(|torque| TorqueCurve::constant(torque, 30.0));
    let torque = TorqueLimits {
        dynamics: arm.dynamics(1e-3, masses).expect("masses are good"),
        motors: motors.map(|motor| motor.expect("motor is good")),
    };
    let curve = Curve::line([-200.0, 300.0], [250.0, 300.0]).expect("line is good");
    let line = arm.path(curve, Elbow::Right).expect("line is reached");
    let joint = [AxisLimits {
        speed: 30.0,
        acceleration: 100.0,
        jerk: None,
    }; 2];
    let mut knots = vec![Knot::default(); 1001];
    let mut group = criterion.benchmark_group(format!("arm, {SEGMENTS} segments"));
    group.bench_function("plan", |bencher| {
        bencher.iter(|| {
            let table = Table::plan([line], joint, |_| SEGMENTS, black_box(&mut knots));
            table.expect("plan is good").duration_s()
        });
    });
    group.bench_function("plan with torque", |bencher| {
        bencher.iter(|| {
            let table = torque.plan([line], joint, |_| SEGMENTS, black_box(&mut knots));
            table.expect("plan is good").duration_s()
        });
    });
    let mut window = vec![Knot::default(); 64];
    group.bench_function("look ahead with torque, 64 slots", |bencher| {
        bencher.iter(|| {
            let rows = torque.look_ahead([line], joint, |_| Ok(SEGMENTS), black_box(&mut window));
            rows.expect("window is long enough").count()
        });
    });
}

fn benches(criterion: &mut Criterion) {
    measure::<3>(criterion);
    measure::<9>(criterion);
    measure_stream::<3>(criterion);
    measure_stream::<9>(criterion);
    measure_torque(criterion);
}

criterion_group!(all, benches);
criterion_main!(all);
