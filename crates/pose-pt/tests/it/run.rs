//! Feed override, stops on the path, and the controller's buffer.

use crate::support::table::{Cut, plan, points_of};
use path_timing::{FeedCeiling, FeedError, Knot, PlanError, Playback};
use pose_pt::nalgebra::Isometry3;
use pose_pt::{Interpolation, LocatorAxis, PosePath};
use proptest::prelude::*;

use crate::support::limits::{LIMIT, check_limits};
use crate::support::platform::{ACCELERATION, SPEED, panel, panel_with, pose, skewed};

/// Positions of some metres rounded off.
const ROUNDING: f64 = 1e-11;

fn poses() -> [Isometry3<f64>; 2] {
    [
        pose([0.0; 3], [0.0; 3]),
        pose([30.0, -12.0, 7.0], [0.01, -0.02, 0.08]),
    ]
}

#[test]
fn at_full_feed_it_is_the_table() {
    for platform in [panel(), skewed()] {
        let poses = poses();
        let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
        let mut knots = [Knot::default(); 101];
        let table = plan(&platform, &path, Cut::Into(100), &mut knots).unwrap();
        let mut ceilings = [FeedCeiling::default(); 101];
        let run = table.playback(1.5, &mut ceilings).unwrap();
        assert_eq!(run.size_hint(), (0, Some(101)));
        for (got, wanted) in points_of(run).into_iter().zip(points_of(table.rows())) {
            assert_eq!(got.axes, wanted.axes);
            assert!(
                (got.time_s - wanted.time_s).abs() < 1e-9 * (1.0 + wanted.time_s),
                "{} {}",
                got.time_s,
                wanted.time_s
            );
            for (got, wanted) in got.velocities.iter().zip(&wanted.velocities) {
                assert!((got - wanted).amax() < 1e-9);
            }
        }
    }
}

#[test]
fn a_table_at_its_limits_cannot_go_faster_and_one_below_can() {
    let platform = panel();
    let poses = poses();
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let mut knots = [Knot::default(); 201];
    let table = plan(&platform, &path, Cut::Into(200), &mut knots).unwrap();
    let slow = table.at_speed(0.5).unwrap();
    for (table, feed, expected) in [(table, 1.5, 1.0), (slow, 1.5, 2.0 / 1.5), (slow, 0.5, 4.0)] {
        let mut ceilings = [FeedCeiling::default(); 201];
        let mut run = table.playback(1.5, &mut ceilings).unwrap();
        run.set_feed(feed).unwrap();
        let points = points_of(run);
        check_limits(&platform, &points);
        let share = points.last().unwrap().time_s / slow.duration_s() * 2.0;
        println!("{feed}: {share}, {expected}");
        assert!((share / expected - 1.0).abs() < 0.01, "{share} {expected}");
    }
}

#[test]
fn a_stop_is_on_the_path_and_can_go_on() {
    let platform = panel();
    let poses = [pose([0.0; 3], [0.0; 3]), pose([100.0, 0.0, 0.0], [0.0; 3])];
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let mut knots = [Knot::default(); 401];
    let table = plan(&platform, &path, Cut::Into(400), &mut knots).unwrap();
    let mut ceilings = [FeedCeiling::default(); 401];
    let mut run = table.playback(1.5, &mut ceilings).unwrap();
    let mut points = points_of(run.by_ref().take(200));
    let from = *points.last().unwrap();
    run.stop();
    points.extend(points_of(run.by_ref()));
    assert!(!run.is_finished() && run.next_row().is_none());
    let rest = points.last().unwrap();
    assert!(rest.velocities.iter().all(|v| v.amax() == 0.0));
    // 10 mm/s at 25 mm/s² stop within 2 mm, and a segment.
    let way = rest.axes[0].x - from.axes[0].x;
    let shortest = SPEED * SPEED / (2.0 * ACCELERATION);
    assert!(
        way > shortest * (1.0 - 1e-9) && way < shortest + 2.0 * 100.0 / 400.0,
        "{way}"
    );
    check_limits(&platform, &points);

    run.set_feed(1.0).unwrap();
    points.extend(points_of(run.by_ref()));
    assert!(run.is_finished());
    check_limits(&platform, &points);
    assert_eq!(points.len(), 401);
    assert!((points[400].axes[2].x - 100.0).abs() < ROUNDING);
}

/// Braking as hard as it can before the last segment, the machine would crawl on it.
#[test]
fn no_stop_crawls() {
    let platform = panel_with(LocatorAxis {
        min: -1500.0,
        max: 1500.0,
        speed: SPEED,
        acceleration: 2.0,
        jerk: None,
    });
    let poses = poses();
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let mut knots = [Knot::default(); 51];
    let table = plan(&platform, &path, Cut::Into(50), &mut knots).unwrap();
    for moving in 2..50 {
        let mut ceilings = [FeedCeiling::default(); 51];
        let mut run = table.playback(1.0, &mut ceilings).unwrap();
        let mut points = points_of(run.by_ref().take(moving));
        run.stop();
        points.extend(points_of(run));
        check_limits(&platform, &points);
        for (found, planned) in points.iter().zip(points_of(table.rows())).skip(1) {
            let longer = found.segment_s / planned.segment_s;
            assert!(longer < 10.0, "{moving}: {longer}");
        }
    }
}

#[test]
fn wrong_feeds_and_memory_are_named() {
    let platform = panel();
    let poses = poses();
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let mut knots = [Knot::default(); 11];
    let table = plan(&platform, &path, Cut::Into(10), &mut knots).unwrap();
    let mut ceilings = [FeedCeiling::default(); 11];
    let error = table.playback(1.5, &mut ceilings[..10]).unwrap_err();
    let (needed, available) = (11, 10);
    assert_eq!(error, PlanError::Memory { needed, available });
    for max in [f64::NAN, 0.0, -1.0, f64::INFINITY, 1e-310, 1e300] {
        let error = table.playback(max, &mut ceilings).unwrap_err();
        assert!(matches!(error, PlanError::Feed { .. }), "{error}");
    }
    let mut run = table.playback(1.5, &mut ceilings).unwrap();
    let (feed, min, max) = (1.6, 1e-50, 1.5);
    assert_eq!(run.set_feed(feed), Err(FeedError { feed, min, max }));
    for feed in [-0.1, f64::NAN, 1e-310] {
        assert!(run.set_feed(feed).is_err(), "{feed}");
    }
}

/// The sizes that docs/book/src/body.md states, for three locators in f64 on 64 bits.
#[cfg(target_pointer_width = "64")]
#[test]
fn memory_is_fixed() {
    use pose_pt::{BodyPath, BodyPaths, PtPoints, PtTable};

    use crate::support::table::BodyTable;

    assert_eq!(size_of::<PtTable<'_, 3>>(), 96);
    assert_eq!(size_of::<PtPoints<'_, 3>>(), 680);
    assert_eq!(size_of::<BodyPaths<'_, 3>>(), 64);
    assert_eq!(size_of::<BodyPath<'_, 3>>(), 496);
    assert_eq!(size_of::<BodyTable<'_, 3>>(), 256);
    assert_eq!(size_of::<Playback<'_, [[f64; 3]; 3]>>(), 432);
    assert_eq!(size_of::<Knot<[[f64; 3]; 3]>>(), 264);
    assert_eq!(size_of::<FeedCeiling>(), 16);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// What goes faster at one place must not go slower for it at the next.
    #[test]
    fn more_feed_never_takes_longer(
        translation in prop::array::uniform3(-300.0..300.0), turn in prop::array::uniform3(-1.5..1.5),
        on in prop::array::uniform3(-300.0..300.0), on_turn in prop::array::uniform3(-1.5..1.5),
        segments in 2..30_u32, scale in 0.3..1.0, feed in 1.0..3.0, speed in 5.0..1e4,
    ) {
        let platform = panel_with(LocatorAxis { min: -1e5, max: 1e5, speed, acceleration: ACCELERATION, jerk: None });
        let poses = [pose([0.0; 3], [0.0; 3]), pose(translation, turn), pose(on, on_turn)];
        let Ok(path) = PosePath::new(&poses, Interpolation::Screw) else { return Ok(()) };
        let mut knots = [Knot::default(); 62];
        let table = plan(&platform, &path, Cut::Into(segments), &mut knots);
        // Few segments may be too coarse.
        let Ok(table) = table else { return Ok(()) };
        let table = table.at_speed(scale).unwrap();
        let mut ceilings = [FeedCeiling::default(); 61];
        let mut run = table.playback(feed, &mut ceilings).unwrap();
        run.set_feed(feed).unwrap();
        let points = points_of(run);
        check_limits(&platform, &points);
        let share = points.last().unwrap().time_s / table.duration_s();
        prop_assert!(share <= LIMIT, "{share}");
    }

    /// Any feeds at any points: limits, the path, the end.
    #[test]
    fn limits_hold_under_any_feed(
        feeds in prop::collection::vec((0.0..1.5_f64, 1..30_usize), 1..12),
        segments in 10..150_u32, scale in 0.3..1.0, skew in any::<bool>(), speed in 5.0..500.0,
    ) {
        let platform = if skew {
            skewed()
        } else {
            panel_with(LocatorAxis { min: -1500.0, max: 1500.0, speed, acceleration: ACCELERATION, jerk: None })
        };
        let poses = poses();
        let path = PosePath::new(&poses, Interpolation::Screw).unwrap();
        let mut knots = [Knot::default(); 151];
        let table = plan(&platform, &path, Cut::Into(segments), &mut knots)
            .unwrap();
        let table = table.at_speed(scale).unwrap();
        let mut ceilings = [FeedCeiling::default(); 151];
        let mut run = table.playback(1.5, &mut ceilings).unwrap();
        let mut points = Vec::new();
        for (feed, count) in feeds {
            run.set_feed(if feed < 0.2 { 0.0 } else { feed }).unwrap();
            points.extend(points_of(run.by_ref().take(count)));
        }
        run.set_feed(1.0).unwrap();
        points.extend(points_of(run.by_ref()));
        prop_assert!(run.is_finished());
        prop_assert_eq!(points.len(), table.len());
        check_limits(&platform, &points);
        for (got, wanted) in points.iter().zip(points_of(table.rows())) {
            prop_assert_eq!(got.axes, wanted.axes);
        }
    }
}
