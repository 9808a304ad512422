//! PVT tables: the distance error of two locators between the points.

use crate::support::table::{Cut, Point, bound, plan, points_of};
use path_timing::Knot;
use pose_pt::nalgebra::Vector3;
use pose_pt::{Interpolation, LocatorAxis, PosePath, PtTable, Segmentation};
use proptest::prelude::*;

use crate::support::cubic::between;
use crate::support::distance_error::measured;
use crate::support::moves::{ALL, from_rest, poses};
use crate::support::platform::{ACCELERATION, panel, panel_with, skewed};

/// Positions of some metres rounded off.
const ROUNDING: f64 = 1e-11;

/// The axes on a segment as a controller runs it.
fn axes_between<const N: usize>(from: &Point<N>, to: &Point<N>, share: f64) -> [Vector3<f64>; N] {
    let [axes, ..] = between(from, to, share);
    axes
}

/// From rest the fourth-order figure for constant speed does not hold: the distance error is
/// L δ²/32.
#[test]
fn distance_error_from_rest_is_of_second_order() {
    let platform = panel();
    let turn = 0.01;
    let poses = from_rest([0.0; 3], [0.0, 0.0, turn]);
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    let mut knots = [Knot::default(); 3];
    let table = plan(&platform, &path, Cut::Into(2), &mut knots).unwrap();
    let points = points_of(table.rows());
    let length = (platform.anchors()[1] - platform.anchors()[0]).xy().norm();
    let half = turn / 2.0;
    let (bound, measured) = (
        bound(&platform, &table),
        measured(&platform, &points, axes_between),
    );
    let second = length * length / platform.largest_anchor_distance() * half * half / 32.0;
    assert!(
        (measured / second - 1.0).abs() < 1e-3,
        "{measured} {second}"
    );
    assert!(measured > 1e3 * length * half.powi(4) / 384.0);
    assert!(
        bound >= measured && bound < 1.01 * measured,
        "{bound} {measured}"
    );
}

#[test]
fn distance_error_decides_the_number_of_points() {
    let platform = panel();
    let poses = from_rest([30.0, -12.0, 7.0], [0.01, -0.02, 0.08]);
    let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
    for allowed in [0.1, 0.01, 0.001] {
        let mut knots = vec![Knot::default(); 2000];
        let table = plan(&platform, &path, Cut::Within(allowed), &mut knots).unwrap();
        let (segments, most) = (table.len() - 1, bound(&platform, &table));
        let points = points_of(table.rows());
        println!(
            "{allowed} mm: {segments} segments, bound {most}, {} s",
            table.duration_s()
        );
        assert!(most <= allowed && measured(&platform, &points, axes_between) <= most);
        let linear =
            PtTable::plan(&platform, &path, Segmentation::max_distance_error(allowed)).unwrap();
        println!("PT: {} segments", linear.len() - 1);
        assert!(linear.len() > table.len());
        let fewer = Cut::Into(u32::try_from(segments - 1).unwrap());
        let coarse = plan(&platform, &path, fewer, &mut knots).unwrap();
        assert!(bound(&platform, &coarse) > allowed);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(160))]

    #[test]
    fn the_distance_error_never_passes_its_bound(
        poses in poses(), kind in 0..4_usize, segments in 2..12_u32, speed in 1.0..1000.0,
        jerk in prop::option::of(20.0..2000.0), skew in any::<bool>(),
    ) {
        let mut limits = LocatorAxis { min: -1500.0, max: 1500.0, speed, acceleration: ACCELERATION, jerk: None };
        limits.jerk = jerk;
        let platform = if skew { skewed() } else { panel_with(limits) };
        let path = PosePath::new(&poses, ALL[kind]).unwrap();
        let mut knots = [Knot::default(); 13];
        let table = plan(&platform, &path, Cut::Into(segments), &mut knots)
            .unwrap();
        let points = points_of(table.rows());
        let (bound, measured) = (bound(&platform, &table), measured(&platform, &points, axes_between));
        prop_assert!(measured <= bound + ROUNDING, "{} {}", measured, bound);
        prop_assert!(bound <= 3.0 * measured + ROUNDING, "{} {}", measured, bound);
    }
}
