//! What `Accuracy` asks for is kept.

use core::cell::Cell;

use path_timing::{Accuracy, Corner, Curve, Knot, Path, PlanError, Table, ToolLimits};
use test_support::{Random, setting};

use crate::support::machine::{Line, limits};
use crate::support::waves::Waves;

/// So many segments that nothing is lost.
const FINE: u32 = 2000;

/// Ratios that are asked for, and by what part of it times may miss them: the fine plan is not the
/// best.
const RATIOS: [f64; 7] = [1.005, 1.01, 1.02, 1.05, 1.1, 1.3, 2.0];

const FEWEST: [u32; 3] = [2, 5, 16];

/// On random paths of two kinds and limits of all sizes, `PATHS` of each.
#[test]
fn times_are_within_their_ratio() {
    let mut random = Random::new(setting("SEED", 1));
    let mut rows = [0; RATIOS.len()];
    let paths = setting("PATHS", 6);
    for _ in 0..paths {
        let mut end = || [random.within(-200.0, 200.0), random.within(10.0, 200.0)];
        let line = Line {
            from: end(),
            to: end(),
        };
        check(&mut random, line, [2.0, 300.0], &mut rows);
        let waves = Waves::random(&mut random).path();
        check(&mut random, waves, [1.0, 1.0], &mut rows);
    }
    let plans = u64::try_from(2 * FEWEST.len()).unwrap() * paths;
    println!("{RATIOS:?}: {:?} rows", rows.map(|rows| rows / plans));
    assert!(rows[0] > rows[6] && rows[6] > 2 * plans, "{rows:?}");
}

/// Lines in a row that begin with one segment each, on which the speed cannot rise and fall again,
/// are as fast as is asked for too.
#[test]
fn times_of_lines_of_one_segment_are_within_their_ratio() {
    let mut random = Random::new(setting("SEED", 4));
    let mut knots = vec![Knot::default(); 40_000];
    for _ in 0..setting("PATHS", 60) {
        let speed = 30.0 * random.size(-0.5, 0.5);
        let own = [speed; 2].map(|speed| limits(speed, speed * random.size(0.1, 2.5), None));
        let lines = row_of_lines(&mut random, speed);
        let fine = Table::plan(lines.clone(), own, |_| FINE, &mut knots);
        let fine_s = fine.unwrap().duration_s();
        for max_time_ratio in RATIOS {
            let accuracy = Accuracy {
                min_segments: 1,
                max_departure: 1.0,
                max_time_ratio,
            };
            let paths = lines.clone();
            let table = Table::plan_within(paths, own, accuracy, |_, _| 0.0, &mut knots).unwrap();
            let ratio = table.duration_s() / fine_s;
            assert!(
                ratio <= max_time_ratio,
                "{ratio} for {accuracy:?}, {lines:?}"
            );
        }
    }
}

/// Lines that go on smoothly, each with a feed of its own.
fn row_of_lines(random: &mut Random, speed: f64) -> Vec<Curve<2>> {
    let lines = 2 + random.below(5);
    let mut gone = 0.0;
    let mut line = || {
        let from = [0.8 * gone, 0.6 * gone];
        gone += 5.0 * random.size(-0.7, 0.7);
        let tool = ToolLimits {
            feed: speed * random.size(-1.0, 0.3),
            acceleration: None,
        };
        let line = Curve::line(from, [0.8 * gone, 0.6 * gone]).unwrap();
        line.with_tool(tool).with_corner(Corner::Smooth)
    };
    (0..lines).map(|_| line()).collect()
}

/// With a limit of jerk a plan may be faster than all finer ones, by more than is asked for: where
/// memory ends, it is taken, and not the finest.
#[test]
fn more_segments_are_not_taken_where_they_are_slower() {
    let own = [limits(190.0, 400.0, Some(7000.0)); 2];
    let (from, corner) = ([0.0, 0.0], [0.56, 0.0]);
    let arc = Curve::arc(corner, [0.56, 0.65], [1.0, 0.0], 0.2).unwrap();
    let line = Curve::line(arc.end(), [1.2, -0.9]).unwrap();
    let paths = [Curve::line(from, corner).unwrap(), arc, line];
    let paths = paths.map(|path| path.with_corner(Corner::Jump([25.0; 2])));
    let accuracy = Accuracy {
        min_segments: 2,
        max_departure: 1.0,
        max_time_ratio: 1.001,
    };
    let mut knots = vec![Knot::default(); 4000];
    let table = Table::plan(paths, own, |_| 100, &mut knots);
    let fine_s = table.unwrap().duration_s();
    let table = Table::plan_within(paths, own, accuracy, |_, _| 0.0, &mut knots).unwrap();
    let (rows, time_s) = (table.len(), table.duration_s());
    println!("{rows} rows, {time_s} s of {fine_s}");
    assert!(rows < 100 && time_s < fine_s);
}

/// What slopes change by where the machine stops asks for no more segments.
#[test]
fn slopes_may_change_where_the_machine_stops() {
    let limits = [limits(2.0, 10.0, None), limits(300.0, 2000.0, None)];
    let corner = [0.0, 100.0];
    let lines = [([100.0, 0.0], corner), (corner, [-50.0, 20.0])];
    let lines = lines.map(|(from, to)| Line { from, to });
    let looks = |max_time_ratio| {
        let looks = Cell::new(0_u32);
        let departure = |_: &Line, _: &_| {
            looks.set(looks.get() + 1);
            0.0
        };
        let accuracy = Accuracy {
            min_segments: 16,
            max_departure: 1.0,
            max_time_ratio,
        };
        let mut knots = vec![Knot::default(); 5_000];
        let table = Table::plan_within(lines, limits, accuracy, departure, &mut knots);
        println!("{} rows", table.unwrap().len());
        looks.get()
    };
    let (timed, plain) = (looks(1.02), looks(f64::INFINITY));
    assert!(timed <= 3 * plain, "{timed} {plain}");
}

/// With less memory than for the segments with which a time is sure, fewer are taken that are
/// likely enough.
#[test]
fn fewer_segments_are_taken_where_there_is_no_room_to_be_sure() {
    let line = Line {
        from: [100.0, -80.0],
        to: [20.0, 60.0],
    };
    let limits = [limits(2.0, 10.0, None), limits(300.0, 2000.0, None)];
    let accuracy = Accuracy {
        min_segments: 2,
        max_departure: 1.0,
        max_time_ratio: 1.005,
    };
    let rows = |room: usize| {
        let mut knots = vec![Knot::default(); room];
        let table = Table::plan_within([line], limits, accuracy, |_, _| 0.0, &mut knots);
        table.map(|table| (table.len(), table.duration_s()))
    };
    let (sure, best_s) = rows(1000).unwrap();
    // A plan of half of them is made beside.
    let (fewer, time_s) = rows(sure + sure / 2).unwrap();
    assert!(
        fewer < sure && time_s <= best_s * accuracy.max_time_ratio,
        "{fewer} {sure}"
    );
    assert_eq!(rows(sure + sure / 2 + 1).unwrap().0, sure);
    assert!(matches!(rows(4), Err(PlanError::Memory { .. })));
}

/// A coarse plan that is not slower than half of it, by chance, is not taken where finer ones are
/// faster, however little room there is.
#[test]
fn a_plan_that_finer_ones_have_shown_to_be_slow_is_not_taken() {
    let mut random = Random::new(setting("SEED", 3));
    let mut planned = 0;
    for _ in 0..setting("PATHS", 40) {
        let mut end = || [random.within(-200.0, 200.0), random.within(10.0, 200.0)];
        let line = Line {
            from: end(),
            to: end(),
        };
        let own = [2.0, 300.0].map(|speed| limits(speed, speed * random.size(0.1, 1.5), None));
        let mut knots = vec![Knot::default(); FINE as usize + 1];
        let fine_s = Table::plan([line], own, |_| FINE, &mut knots)
            .unwrap()
            .duration_s();
        for max_time_ratio in [1.000_1, 1.001, 1.002, 1.005] {
            let accuracy = Accuracy {
                min_segments: 8,
                max_departure: 1.0,
                max_time_ratio,
            };
            for room in [50, 100, 200, 2000] {
                let table =
                    Table::plan_within([line], own, accuracy, |_, _| 0.0, &mut knots[..room]);
                let Ok(table) = table else { continue };
                let ratio = table.duration_s() / fine_s;
                let what = format!("{line:?}, {own:?}: {ratio} for {max_time_ratio} in {room}");
                assert!(ratio <= 1.0 + (max_time_ratio - 1.0) * NEARLY, "{what}");
                planned += 1;
            }
        }
    }
    assert!(planned > 100, "{planned}");
}

/// What is lost may be so many times what is allowed where there is no room to be sure.
const NEARLY: f64 = 3.0;

fn check<P: Path<Axes = [f64; 2]> + Clone>(
    random: &mut Random,
    path: P,
    speeds: [f64; 2],
    rows: &mut [u64],
) where
    P::Error: core::fmt::Debug,
{
    let own = speeds.map(|speed| {
        let speed = speed * random.size(-0.5, 0.5);
        limits(speed, speed * random.size(0.1, 1.5), None)
    });
    let mut knots = vec![Knot::default(); 20_000];
    let fine = Table::plan([path.clone()], own, |_| FINE, &mut knots);
    let fine_s = fine.unwrap().duration_s();
    for (max_time_ratio, rows) in RATIOS.into_iter().zip(rows) {
        for min_segments in FEWEST {
            let accuracy = Accuracy {
                min_segments,
                max_departure: 1.0,
                max_time_ratio,
            };
            let paths = [path.clone()];
            let table = Table::plan_within(paths, own, accuracy, |_, _| 0.0, &mut knots).unwrap();
            let ratio = table.duration_s() / fine_s;
            assert!(ratio <= max_time_ratio, "{ratio} for {accuracy:?}, {own:?}");
            *rows += u64::try_from(table.len()).unwrap();
        }
    }
}
