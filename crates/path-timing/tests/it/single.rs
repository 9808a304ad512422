//! Plans in single precision: the same limits kept, and the time beside that of double precision.

use core::fmt::Debug;

use path_timing::{AxisLimits, Cubic, Curve, Knot, Path, Row, Table};
use scara_kin::{Arm, Elbow};
use test_support::{Random, setting};

use crate::support::machine::limits;
use crate::support::polyline::smoothed;

/// Rounding of positions, as a part of them by the square of a row's time.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What a limit may be used to, but for that.
const WITHIN: f64 = 1.0 + 1e-9;

/// The largest part of a limit that a cubic uses.
fn used(rows: &[Row<[f64; 2]>], limits: [AxisLimits; 2]) -> f64 {
    let pairs = rows.windows(2).filter(|pair| pair[1].duration_s > 0.0);
    pairs
        .flat_map(|pair| Cubic::between(&pair[0], &pair[1]).zip(limits))
        .map(|(cubic, limits)| {
            let size = cubic.q0.abs().max(cubic.q1.abs());
            let noise = ROUNDING * size / (cubic.duration_s * cubic.duration_s);
            let [a0, a1] = cubic
                .accelerations()
                .map(|a| (a.abs() - noise) / limits.acceleration);
            a0.max(a1).max(cubic.peak_speed() / limits.speed)
        })
        .fold(0.0, f64::max)
}

/// How much longer the plan in single precision takes; none where either is refused.
fn ratio<P>(paths: &[P], limits: [AxisLimits; 2], segments: u32) -> Option<f64>
where
    P: Path<Axes = [f64; 2], Error: Debug>,
{
    let mut knots = vec![Knot::default(); 10_000];
    let exact = Table::plan(paths, limits, |_| segments, &mut knots).ok()?;
    let exact_s = exact.duration_s();
    let single = Table::plan_in_f32(paths, limits, |_| segments, &mut knots).ok()?;
    let rows: Vec<_> = single.rows().collect();
    let used = used(&rows, limits);
    assert!(used <= WITHIN, "{used} of a limit {limits:?}");
    Some(single.duration_s() / exact_s)
}

fn random_ratio(random: &mut Random) -> Option<f64> {
    let number = usize::try_from(random.below(6)).unwrap();
    let segments = [1, 2, 4, 8, 30, 100][number];
    let own = [(); 2].map(|()| {
        let speed = random.size(0.7, 2.7);
        limits(speed, speed * random.size(-0.3, 2.3), None)
    });
    let points: Vec<_> = (0..2 + random.below(12))
        .map(|_| [(); 2].map(|()| random.within(-100.0, 100.0)))
        .collect();
    let curves: Vec<Curve<2>> = smoothed(&points, random.size(-4.0, 0.7));
    if random.below(3) > 0 {
        return ratio(&curves, own, segments);
    }
    let arm = Arm::new(150.0, 150.0).unwrap();
    let paths = curves.iter().map(|curve| arm.path(*curve, Elbow::Right));
    let paths: Result<Vec<_>, _> = paths.collect();
    let joints = own.map(|own| limits(own.speed / 50.0, own.acceleration / 50.0, None));
    ratio(&paths.ok()?, joints, segments)
}

/// `MOTIONS` of two axes and of an arm, in 1 to 100 segments a curve.
#[test]
fn limits_are_kept_and_little_time_is_lost() {
    let mut random = Random::new(setting("SEED", 1));
    let mut ratios: Vec<_> = (0..setting("MOTIONS", 300))
        .filter_map(|_| random_ratio(&mut random))
        .collect();
    ratios.sort_by(f64::total_cmp);
    let count = ratios.len();
    let [median, most, worst] = [count / 2, count - 1 - count / 50, count - 1].map(|n| ratios[n]);
    println!("{count} motions: {median:.5}, 98 % {most:.4}, at worst {worst:.3}");
    assert!(
        median < MEDIAN && most < MOST && worst < WORST,
        "{median} {most} {worst}"
    );
}

/// The time beside that of double precision: of half, of 98 %, and of all motions; what is more is
/// lost on bent paths, whose segments are not stretched.
const MEDIAN: f64 = 1.001;
const MOST: f64 = 1.02;
const WORST: f64 = 1.5;
