//! No result depends on the unit of length: where all lengths are given in another unit, each
//! result that is a length comes out in that unit, and no other result changes.

mod scene;

use crate::support::table::{Cut, bound, plan, points_of};
use path_timing::Knot;
use pose_pt::{Interpolation, PosePath};
use proptest::prelude::*;
use scene::{Number, Scene, scaled_platform, scaled_pose};

use crate::support::cubic::between;
use crate::support::distance_error::distance_error;
use crate::support::moves::{from_rest, poses};
use crate::support::platform::panel;

/// Lengths that are not powers of two are rounded when their unit changes, and the bisections
/// of the planner stop at a relative gap of 1e-5.
const RELATIVE: f64 = 1e-4;

/// Of the size of the platform: what cancels where a length is a difference.
const CANCELLED: f64 = 1e-12;

/// Size of the platforms, in the unit of the scene.
const SPAN: f64 = 4000.0;

fn scenes() -> impl Strategy<Value = Scene> {
    let jerk = prop::option::of(20.0..2000.0);
    (poses(), 0..4_usize, 2..40_u32, jerk, any::<bool>()).prop_map(
        |(poses, kind, segments, jerk, is_skewed)| Scene {
            poses,
            kind,
            segments,
            jerk,
            is_skewed,
        },
    )
}

/// Both lists of numbers, and what a length in the one is in the other.
fn pairs(scene: &Scene, unit: f64) -> impl Iterator<Item = (Number, Number)> {
    let [here, there] = [1.0, unit].map(|unit| scene.numbers(unit));
    assert_eq!(here.len(), there.len());
    here.into_iter().zip(there)
}

/// Locators 4 m, 0.3, 0.1 and 0.01 of a unit apart: a bound that takes a length for its square is
/// too small below a half.
#[test]
fn the_bound_on_the_distance_error_holds_in_every_unit() {
    let poses = from_rest([30.0, -12.0, 7.0], [0.01, -0.02, 0.08]);
    for apart in [SPAN, 0.3, 0.1, 0.01] {
        let unit = apart / SPAN;
        let platform = scaled_platform(&panel(), unit);
        let poses = poses.map(|pose| scaled_pose(&pose, unit));
        let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
        let allowed = 1e-6 * apart;
        let mut knots = [Knot::default(); 100];
        let table = plan(&platform, &path, Cut::Within(allowed), &mut knots).unwrap();
        let points = points_of(table.rows());
        let mut measured = 0.0_f64;
        for pair in points.windows(2) {
            for place in 0..=1000 {
                let [axes, ..] = between(&pair[0], &pair[1], f64::from(place) / 1000.0);
                measured = measured.max(distance_error(&platform, &axes));
            }
        }
        let bound = bound(&platform, &table);
        println!("{apart}: {measured}, bound {bound}, allowed {allowed}");
        assert!(
            measured <= bound && bound <= allowed,
            "{apart}: {measured}, {bound}"
        );
        assert!(bound <= 3.0 * measured, "{apart}: {measured}, {bound}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Powers of two change no digit of a length: no digit of any result may change, from one end
    /// of the range to the other (near the lower one, what points must be apart is the range's).
    #[test]
    fn a_unit_that_is_a_power_of_two_changes_no_digit(
        scene in scenes(), exponent in -130..=150_i32,
    ) {
        let unit = 2_f64.powi(exponent);
        for (here, there) in pairs(&scene, unit) {
            let wanted = here.value * unit.powi(here.power);
            prop_assert_eq!(wanted.to_bits(), there.value.to_bits(), "{}: {} {}", here.name, here.value, there.value);
        }
    }

    #[test]
    fn all_results_are_in_the_unit_of_the_lengths(scene in scenes(), exponent in -6..=6_i32) {
        let unit = 10_f64.powi(exponent);
        for (here, there) in pairs(&scene, unit) {
            let found = there.value / unit.powi(here.power);
            let allowed = here.value.abs() * RELATIVE + SPAN.powi(here.power) * CANCELLED;
            let off = (found - here.value).abs();
            prop_assert!(off <= allowed, "{}: {} {}", here.name, here.value, there.value);
        }
    }
}
