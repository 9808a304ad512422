//! Higher limits, a larger tolerance and more segments do not make a motion slower.

use core::fmt::Debug;

use path_timing::{AxisLimits, Curve, Knot, Path, Table};
use proptest::prelude::*;
use scara_kin::{Arm, Elbow};
use test_support::{Random, setting};

use crate::support::machine::{Line, limits};
use crate::support::polyline::{points, smoothed};
use crate::support::waves::Waves;

/// By what a motion may be slower, as a part of its time.
const SLOWER: f64 = 1.01;

/// The same for twice the segments where a row lasts longer than half the ramp of an acceleration
/// at the jerk's limit: a row hides what happens in it.
const HIDDEN: f64 = 1.1;

const RAMP: f64 = 0.5;

/// And no more at a lone corner, for each ramp that the longest row lasts: of 37,500 plans of one
/// corner and more the most was 0.043.
const HIDDEN_IN_A_RAMP: f64 = 0.05;

/// Points of a polyline with a lone corner.
const LONE: usize = 3;

/// None where a curve turns too sharply for the segments.
fn time_s<P: Path<Axes = [f64; 2]>>(paths: &[P], limits: AxisLimits, segments: u32) -> Option<f64>
where
    P::Error: Debug,
{
    times_s(paths, limits, segments).map(|[time_s, _]| time_s)
}

/// And the time of the longest row.
fn times_s<P: Path<Axes = [f64; 2]>>(
    paths: &[P],
    limits: AxisLimits,
    segments: u32,
) -> Option<[f64; 2]>
where
    P::Error: Debug,
{
    let mut knots = vec![Knot::default(); 4000];
    let table = Table::plan(paths, [limits; 2], |_| segments, &mut knots).ok()?;
    let longest_s = table.rows().map(|row| row.duration_s).fold(0.0, f64::max);
    Some([table.duration_s(), longest_s])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn more_does_not_take_longer(
        points in points(), tolerance in 0.01..2.0_f64, segments in 16..40_u32,
        speed in 50.0..500.0_f64, acceleration in 200.0..5000.0_f64, rate in 10.0..300.0_f64,
        more in 1.0..3.0_f64,
    ) {
        let own = limits(speed, acceleration, Some(acceleration * rate));
        let curves = smoothed(&points, tolerance);
        let before_s = time_s(&curves, own, segments);
        prop_assume!(before_s.is_some());
        let before_s = before_s.unwrap();
        let jerk = own.jerk.map(|jerk| jerk * more);
        let higher = [
            AxisLimits { speed: speed * more, ..own },
            AxisLimits { acceleration: acceleration * more, ..own },
            AxisLimits { jerk, ..own },
            AxisLimits { jerk: None, ..own },
        ];
        for limits in higher {
            let after_s = time_s(&curves, limits, segments).unwrap();
            prop_assert!(after_s < before_s * SLOWER, "{} {:?}", after_s / before_s, limits);
        }
        if let Some(after_s) = time_s(&smoothed(&points, tolerance * more), own, segments) {
            prop_assert!(after_s < before_s * SLOWER, "{} within more", after_s / before_s);
        }
    }

    #[test]
    fn more_segments_do_not_take_longer(
        points in points(), tolerance in 0.01..2.0_f64, speed in 50.0..500.0_f64,
        acceleration in 200.0..5000.0_f64, rate in 10.0..300.0_f64,
    ) {
        let own = limits(speed, acceleration, Some(acceleration * rate));
        let curves = smoothed(&points, tolerance);
        for segments in [4, 8, 16, 32, 64] {
            let Some([before_s, longest_s]) = times_s(&curves, own, segments) else { continue };
            let ramps = longest_s * rate;
            let hidden = if points.len() == LONE { SLOWER + HIDDEN_IN_A_RAMP * ramps } else { HIDDEN };
            let slower = if ramps < RAMP { SLOWER } else { hidden.min(HIDDEN) };
            let after_s = time_s(&curves, own, 2 * segments).unwrap();
            prop_assert!(after_s < before_s * slower, "{} with {segments}", after_s / before_s);
        }
    }
}

/// By what twice the segments may be slower along an arm's path, whose axes bend on its lines, too:
/// of 1,500 polylines the most was 2.3 %.
const SLOWER_ALONG_AN_ARM: f64 = 1.03;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn more_segments_along_an_arm_do_not_take_longer(
        points in points(), by in prop::array::uniform2(-150.0..150.0_f64),
        tolerance in 0.01..2.0_f64, speed in 1.0..10.0_f64, acceleration in 5.0..200.0_f64,
        rate in 10.0..300.0_f64,
    ) {
        let own = limits(speed, acceleration, Some(acceleration * rate));
        let moved: Vec<_> = points.iter().map(|[x, y]| [x + by[0], y + by[1]]).collect();
        let arm = Arm::new(132.0, 132.0).unwrap();
        let paths = smoothed(&moved, tolerance).into_iter();
        let paths: Result<Vec<_>, _> = paths.map(|curve| arm.path(curve, Elbow::Right)).collect();
        prop_assume!(paths.is_ok());
        let paths = paths.unwrap();
        for segments in [8, 16, 32, 64] {
            let Some([before_s, longest_s]) = times_s(&paths, own, segments) else { continue };
            if longest_s * rate < RAMP {
                let after_s = time_s(&paths, own, 2 * segments).unwrap();
                prop_assert!(after_s < before_s * SLOWER_ALONG_AN_ARM, "{}", after_s / before_s);
            }
        }
    }
}

/// Two gentle corners that overlap, where the second derivative of curves once stepped: rows a
/// sixteenth as long took 25 % longer.
#[test]
fn short_rows_lose_nothing_where_corners_overlap() {
    let points = [
        [-55.2105322568584, 4.219190565759776],
        [-70.75169724420448, 21.87841093371806],
        [-75.7619884368985, 47.77204062839085],
        [-59.40490475773268, 70.36911837366034],
    ];
    let curves = smoothed(&points, 1.925153302396467);
    let own = limits(254.0990886644021, 200.0, Some(2000.0));
    let [few_s, many_s] = [32, 512].map(|segments| time_s(&curves, own, segments).unwrap());
    assert!(many_s < few_s * SLOWER, "{many_s} s, not {few_s} s");
}

/// A leg that turns round with another, whose plan for itself was to begin faster than the one before
/// may end: what its segments were stretched by for that cost 7 % from 96 of them on.
#[test]
fn more_segments_of_two_curves_that_turn_round_take_no_longer() {
    let points = [
        [28.078708928812663, 32.30835402328227],
        [39.34838040309374, 38.5073876304579],
        [-81.14579207450105, 0.0],
    ];
    let curves = smoothed(&points, 1.30023688160193);
    let own = limits(
        412.9365340394341,
        2518.7876100976164,
        Some(25187.876100976164),
    );
    let few_s = time_s(&curves, own, 16).unwrap();
    for segments in [32, 64, 96, 128, 256, 512] {
        let many_s = time_s(&curves, own, segments).unwrap();
        assert!(
            many_s < few_s * SLOWER,
            "{many_s} s by {segments}, not {few_s} s"
        );
    }
}

/// Three hairpins whose ways are too short for the accelerations at their jerk: what segments were
/// stretched by for a plan with all of the acceleration cost 3 % with 2.5 times as much.
#[test]
fn an_acceleration_that_is_not_reached_takes_no_longer() {
    let points = [
        [78.8068464647553, 5.42411776991525],
        [69.48283837492205, -64.63005065804644],
        [58.14925390689331, 51.374833549913845],
        [41.87918575100103, -90.56798394158942],
    ];
    let curves = smoothed(&points, 1.374);
    let [own_s, higher_s] = [4967.8, 12_210.9].map(|acceleration| {
        let limits = limits(154.6, acceleration, Some(53_900.0));
        time_s(&curves, limits, 29).unwrap()
    });
    assert!(higher_s < own_s * SLOWER, "{higher_s} s, not {own_s} s");
}

/// By what rows of a microsecond may be slower: rounding takes a part of the limits there.
const SLOWER_BY_ROUNDING: f64 = 1.05;

/// A line of 0.018 mm between two corners, in hundreds of segments, was the end of all speeds: what
/// rounding had left of a pivot made steps that were no numbers, and the search ended at 1.9 times
/// the time.
#[test]
fn many_segments_of_a_short_line_take_little_longer() {
    let points = [
        [-54.11037813060624, -8.441223435043835],
        [-39.741681169455006, 76.24639849231764],
        [-67.87462186711517, -17.164677238235043],
        [-56.16927690665478, -26.989630107658147],
        [3.4437975307116573, 69.81646313114103],
    ];
    let curves = smoothed(&points, 1.6564415803177879);
    let own = limits(437.34545906576654, 3783.720106023696, Some(68_138.0));
    let few_s = time_s(&curves, own, 64).unwrap();
    for segments in [128, 160, 256, 384] {
        let many_s = time_s(&curves, own, segments).unwrap();
        assert!(
            many_s < few_s * SLOWER_BY_ROUNDING,
            "{many_s} s, not {few_s} s"
        );
    }
}

/// The time around a corner that bends so sharply that its own jerk, which the parameter's makes up
/// for, would be all of the limit inside of the cubics: then it was 0.709 s.
const BENT_S: f64 = 0.685;

#[test]
fn a_bend_uses_up_no_jerk() {
    let points = [
        [0.0, 0.0],
        [36.169_158_188_501_825, 0.0],
        [0.0, 70.527_238_171_810_48],
    ];
    let curves = smoothed(&points, 0.549_317_519_938_579_6);
    let own = limits(
        270.424_399_117_266_3,
        4_946.433_858_118_036,
        Some(49_464.338_581_180_36),
    );
    for segments in [32, 256] {
        let time_s = time_s(&curves, own, segments).unwrap();
        assert!(time_s < BENT_S, "{segments}: {time_s}");
    }
}

/// Segments from which on twice as many are not slower.
const STEADY: [u32; 3] = [32, 48, 64];

/// By what these may be slower: of 3,400 plans of random paths one took over 1 % longer, 1.3 %.
const SLOWER_TWICE: f64 = 1.02;

/// One of so many plans at most: of a curve that nearly turns back on the spot.
const MOST_REFUSED: u32 = 200;

/// Twice the segments take no longer. How many plans were made, and of how many twice the segments
/// are refused.
fn check_twice<P>(path: &P, random: &mut Random, speeds: [f64; 2]) -> [u32; 2]
where
    P: Path<Axes = [f64; 2], Error: Debug> + Clone,
{
    let own = speeds.map(|speed| {
        let speed = speed * random.size(-0.5, 0.5);
        limits(speed, speed * random.size(0.1, 1.5), None)
    });
    let mut knots = vec![Knot::default(); 200];
    let mut time_s = |segments| {
        let table = Table::plan([path.clone()], own, |_| segments, &mut knots);
        table.map(|table| table.duration_s())
    };
    let [mut plans, mut refused] = [0; 2];
    for segments in STEADY {
        let Ok(before_s) = time_s(segments) else {
            continue;
        };
        plans += 1;
        let Ok(after_s) = time_s(2 * segments) else {
            refused += 1;
            continue;
        };
        assert!(
            after_s < before_s * SLOWER_TWICE,
            "{} with {segments}, {own:?}",
            after_s / before_s
        );
    }
    [plans, refused]
}

/// `PATHS` of each kind, some of which nearly turn back on the spot.
#[test]
fn more_segments_without_jerk_do_not_take_longer() {
    let mut random = Random::new(setting("SEED", 1));
    let [mut plans, mut refused] = [0; 2];
    let mut add = |[more, less]: [u32; 2]| (plans, refused) = (plans + more, refused + less);
    for _ in 0..setting("PATHS", 40) {
        let mut end = || [random.within(-200.0, 200.0), random.within(10.0, 200.0)];
        let (from, to) = (end(), end());
        add(check_twice(&Line { from, to }, &mut random, [2.0, 300.0]));
        let waves = Waves::random(&mut random).path();
        add(check_twice(&waves, &mut random, [1.0, 1.0]));
        let mut point = || [(); 2].map(|()| random.within(-100.0, 100.0));
        let curve = Curve::bezier([point(), point(), point(), point()]);
        if let Ok(curve) = curve {
            add(check_twice(&curve, &mut random, [200.0, 200.0]));
        }
    }
    println!("{plans} plans, of {refused} twice the segments are refused");
    assert!(plans > 200 && refused * MOST_REFUSED <= plans);
}
