//! Shaped rows against the sum of the motion at several times.

use path_timing::{
    Axes, AxisLimits, Corner, Cubic, Curve, FeedCeiling, Knot, LookAhead, Mode, Row, Shaped,
    ShapedError, Shaper, Table, TryRow,
};
use proptest::prelude::*;
use twofloat::TwoFloat;

use super::closed_form::SHAPERS;
use crate::support::machine::limits;

type Rows = Vec<Row<[f64; 2]>>;

/// Start-stop speeds in mm/s.
const JUMP: [f64; 2] = [15.0, 10.0];

/// Of sums of positions of some hundred, and of times.
const ROUNDING: f64 = 1e-11;

/// Positions within a delay, in mm.
const LARGEST: f64 = 100.0;

/// Relative, of limits kept by the planner and by the mean of it.
const EXACTLY: f64 = 1e-11;

pub(super) fn shaped<A: Axes, T: TryRow<Axes = A>>(
    rows: impl Iterator<Item = T>,
    shapers: A::Of<Shaper>,
) -> Vec<Row<A>> {
    let mut memory = vec![Row::default(); 5000];
    let rows = Shaped::new(rows, shapers, &mut memory);
    rows.map(|row| row.unwrap_or_else(|_| panic!("a row")))
        .collect()
}

/// Lines through points in mm, with jumps at the corners.
fn lines(points: &[[f64; 2]]) -> Vec<Curve<2>> {
    let lines = points
        .windows(2)
        .map(|ends| Curve::line(ends[0], ends[1]).unwrap());
    lines
        .map(|line| line.with_corner(Corner::Jump(JUMP)))
        .collect()
}

fn planned(points: &[[f64; 2]], limits: [AxisLimits; 2], segments: u32) -> Rows {
    let mut knots = vec![Knot::default(); 4000];
    let table = Table::plan(&lines(points), limits, |_| segments, &mut knots).unwrap();
    table.rows().collect()
}

/// An axis at a time, by the cubics of the rows: at rest before and after.
pub(super) fn at<A: Axes>(rows: &[Row<A>], time_s: f64, axis: usize) -> f64 {
    let index = rows.partition_point(|row| row.time_s <= time_s);
    let (Some(from), Some(to)) = (index.checked_sub(1).map(|i| &rows[i]), rows.get(index)) else {
        return rows[index.min(rows.len() - 1)].position.as_slice()[axis];
    };
    let cubic = Cubic::between(from, to).nth(axis).unwrap();
    cubic.position((time_s - from.time_s) / to.duration_s)
}

/// The delays of an axis' impulses when its shaper is aligned with the other.
fn delays(shapers: &[Shaper; 2], axis: usize) -> impl Iterator<Item = (f64, f64)> {
    let behind_s = shapers.iter().map(Shaper::delay_s).fold(0.0, f64::max);
    let later_s = behind_s - shapers[axis].delay_s();
    let impulses = shapers[axis].impulses().iter();
    impulses.map(move |impulse| (impulse.time_s + later_s, impulse.amplitude))
}

/// The shaped rows are the sum of the motion at several times, and keep its limits.
fn check(
    rows: &[Row<[f64; 2]>],
    shaped: &[Row<[f64; 2]>],
    shapers: &[Shaper; 2],
    limits: &[AxisLimits; 2],
) {
    let (first, last, end) = (&shaped[0], &shaped[shaped.len() - 1], &rows[rows.len() - 1]);
    let bits = |position: [f64; 2]| position.map(f64::to_bits);
    assert_eq!(bits(first.position), bits(rows[0].position));
    assert_eq!(bits(last.position), bits(end.position));
    assert!(first.is_at_rest() && last.is_at_rest());
    for pair in shaped.windows(2) {
        let [from, to] = pair else { unreachable!() };
        assert!(to.duration_s >= 0.0 && to.time_s >= from.time_s);
        assert!((to.time_s - from.time_s - to.duration_s).abs() < ROUNDING);
        for axis in 0..2 {
            if to.duration_s == 0.0 {
                // A jump of a part of those that the motion has, for each impulse.
                let most = delays(shapers, axis).map(|(_, a)| a).fold(0.0, f64::max);
                let jump = (to.velocity[axis] - from.velocity[axis]).abs();
                assert!(jump <= JUMP[axis] * (most + ROUNDING), "{jump}");
                assert!((from.position[axis] - to.position[axis]).abs() < ROUNDING);
            } else {
                check_cubic(from, to, axis, &limits[axis]);
            }
            let middle_s = (from.time_s + to.time_s) * 0.5;
            for (time_s, fraction) in [(to.time_s, 1.0), (middle_s, 0.5)] {
                let sum: f64 = delays(shapers, axis)
                    .map(|(delay_s, amplitude)| amplitude * at(rows, time_s - delay_s, axis))
                    .sum();
                let is = Cubic::between(from, to)
                    .nth(axis)
                    .unwrap()
                    .position(fraction);
                assert!((is - sum).abs() < ROUNDING, "{time_s} s: {is}, not {sum}");
            }
        }
    }
}

/// The extremes of a cubic in 32 digits, from the row's numbers as they are. They are rounded: by
/// an epsilon, and what follows of it is allowed.
fn check_cubic(from: &Row<[f64; 2]>, to: &Row<[f64; 2]>, axis: usize, limits: &AxisLimits) {
    let exact = TwoFloat::from;
    let t = exact(to.duration_s);
    let (v0, v1) = (exact(from.velocity[axis]), exact(to.velocity[axis]));
    let m = (exact(to.position[axis]) - exact(from.position[axis])) / t;
    let a0 = (m * 6.0 - v0 * 4.0 - v1 * 2.0) / t;
    let a1 = (v0 * 2.0 + v1 * 4.0 - m * 6.0) / t;
    let speed = from.velocity[axis].abs().max(to.velocity[axis].abs());
    let rounding = 4.0 * f64::EPSILON * (LARGEST / to.duration_s + speed);
    let most = |x: TwoFloat, y: TwoFloat| f64::from(x.abs()).max(f64::from(y.abs()));
    let acceleration = most(a0, a1);
    let allowed = limits.acceleration * (1.0 + EXACTLY) + 6.0 * rounding / to.duration_s;
    assert!(
        acceleration <= allowed,
        "{acceleration} of {}, in {} s",
        limits.acceleration,
        to.duration_s
    );
    let mut fastest = most(v0, v1);
    if (a0 > 0.0) != (a1 > 0.0) {
        let vertex = v0 + a0 * a0 * t / (a0 - a1) * 0.5;
        fastest = fastest.max(f64::from(vertex.abs()));
    }
    let allowed = limits.speed * (1.0 + EXACTLY) + 3.0 * rounding;
    assert!(fastest <= allowed, "{fastest} of {}", limits.speed);
}

fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let point = prop::array::uniform2(-100.0..100.0_f64);
    prop::collection::vec(point, 2..5).prop_filter("sides", |points| {
        points.windows(2).all(|ends| {
            let [from, to] = ends else { unreachable!() };
            (to[0] - from[0]).hypot(to[1] - from[1]) > 1.0
        })
    })
}

fn shaper() -> impl Strategy<Value = Shaper> {
    let mode = (5.0..120.0_f64, 0.0..0.3_f64).prop_map(|(hz, damping)| Mode { hz, damping });
    (0..7_usize, mode).prop_map(|(kind, mode)| match SHAPERS.get(kind) {
        Some((_, make, ..)) => make(mode).unwrap(),
        None => Shaper::none(),
    })
}

const LIMITS: [AxisLimits; 2] = [limits(200.0, 2000.0, None), limits(300.0, 5000.0, None)];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn rows_are_the_mean_of_the_motion_at_several_times(
        points in points(),
        shapers in prop::array::uniform2(shaper()),
        segments in 2..40_u32,
    ) {
        let rows = planned(&points, LIMITS, segments);
        let shaped = shaped(rows.iter().copied(), shapers);
        check(&rows, &shaped, &shapers, &LIMITS);
    }

    #[test]
    fn feeds_and_holds_are_shaped(
        points in points(),
        shapers in prop::array::uniform2(shaper()),
        feeds in prop::collection::vec((0.0..1.0_f64, 1..60_usize), 1..8),
    ) {
        let lines = lines(&points);
        let mut window = [Knot::default(); 48];
        let motion = LookAhead::new(&lines, LIMITS, |_| Ok(20), &mut window).unwrap();
        let mut memory = [Row::default(); 500];
        let mut rows = Shaped::new(motion, shapers, &mut memory);
        let mut all = Vec::new();
        let full = (1.0, usize::MAX);
        for (feed, count) in feeds.into_iter().chain([full]) {
            rows.rows_mut().set_feed(if feed < 0.4 { 0.0 } else { feed }).unwrap();
            all.extend(rows.by_ref().take(count).map(Result::unwrap));
        }
        let (last, end) = (&all[all.len() - 1], points[points.len() - 1]);
        prop_assert_eq!(last.position.map(f64::to_bits), end.map(f64::to_bits));
        prop_assert!(last.is_at_rest());
        for pair in all.windows(2) {
            let [from, to] = pair else { unreachable!() };
            for (axis, limits) in LIMITS.iter().enumerate() {
                if to.duration_s > 0.0 {
                    check_cubic(from, to, axis, limits);
                }
            }
        }
    }
}

#[test]
fn a_hold_rests_one_delay_later_and_goes_on_in_it() {
    let line = Curve::line([0.0, 0.0], [100.0, 0.0]).unwrap();
    let mode = Mode {
        hz: 10.0,
        damping: 0.02,
    };
    let shapers = [Shaper::zv(mode).unwrap(), Shaper::zvd(mode).unwrap()];
    let mut knots = [Knot::default(); 101];
    let table = Table::plan([line], LIMITS, |_| 100, &mut knots).unwrap();
    let mut ceilings = [FeedCeiling::default(); 101];
    let playback = table.playback(1.0, &mut ceilings).unwrap();
    let mut memory = [Row::default(); 200];
    let mut rows = Shaped::new(playback, shapers, &mut memory);
    let before = rows.by_ref().take(60).last().unwrap().unwrap();
    rows.rows_mut().stop();
    let held: Vec<_> = rows.by_ref().map(Result::unwrap).collect();
    let rest = held[held.len() - 1];
    assert!(rest.is_at_rest() && rest.position[0] > before.position[0] && rest.position[0] < 100.0);
    assert!(rows.next().is_none());
    // All impulses have come to rest; the machine goes on from there.
    rows.rows_mut().set_feed(1.0).unwrap();
    let on: Vec<_> = rows.by_ref().take(3).map(Result::unwrap).collect();
    assert!(on[0].time_s > rest.time_s && on[0].position[0] >= rest.position[0]);
    // Stopped again, it goes on before the last impulse has come to rest.
    rows.rows_mut().stop();
    let moving = rows.by_ref().take(8).last().unwrap().unwrap();
    assert!(!moving.is_at_rest());
    rows.rows_mut().set_feed(1.0).unwrap();
    let last = rows.last().unwrap().unwrap();
    assert_eq!((last.position, last.velocity), ([100.0, 0.0], [0.0; 2]));
}

#[test]
fn memory_is_as_much_as_is_said() {
    let points = [[0.0, 0.0], [70.0, 10.0], [20.0, 90.0]];
    let rows = planned(&points, LIMITS, 60);
    for (_, make, ..) in SHAPERS {
        let mode = |hz| Mode { hz, damping: 0.1 };
        let shapers = [make(mode(9.0)).unwrap(), Shaper::zv(mode(30.0)).unwrap()];
        let motion = rows.iter().copied();
        let needed = Shaped::memory_for(motion.clone(), &shapers);
        let mut memory = vec![Row::default(); needed];
        let enough = Shaped::new(motion.clone(), shapers, &mut memory);
        assert!(enough.map(Result::unwrap).count() > rows.len());
        // A few rows fewer, and it ends with the reason.
        let mut memory = vec![Row::default(); needed - 4];
        let few = Shaped::new(motion, shapers, &mut memory);
        let last = few.last().unwrap();
        let available = needed - 4;
        assert!(matches!(last, Err(ShapedError::Memory { available: is }) if is == available));
    }
    let mut none = [];
    let mut rows = Shaped::new(rows.iter().copied(), [Shaper::none(); 2], &mut none);
    assert!(rows.next().unwrap().is_err() && rows.next().is_none());
}

#[test]
fn without_shapers_rows_are_what_they_were() {
    let rows = planned(&[[3.0, 7.0], [70.0, 10.0], [20.0, 90.0]], LIMITS, 60);
    let shaped = shaped(rows.iter().copied(), [Shaper::none(); 2]);
    assert_eq!(shaped.len(), rows.len());
    for (is, was) in shaped.iter().zip(&rows) {
        assert!((is.time_s - was.time_s).abs() < ROUNDING);
        assert_eq!((is.position, is.velocity), (was.position, was.velocity));
    }
}
