//! Streams whose motors keep their torque: as fast as tables, at any feed, held at any time.

use core::fmt::Debug;

use path_timing::{
    Axes, AxisLimits, Cubic, Curve, Dynamics, Knot, Path, PlanError, Row, Span, TorqueCurve,
    TorqueLimits,
};
use proptest::prelude::*;
use scara_kin::{ArmDynamics, ArmMasses, ArmPath, Elbow, JointDrive};

use super::{
    FREE, LINES, WITHIN, alike, arm, constant, delta, limits, line, masses, planned, sampled,
    stepper,
};

/// All rows, with feeds that are wanted after some of them; at the end the whole feed.
pub(super) fn streamed<D, P>(
    limits: &TorqueLimits<D>,
    paths: &[P],
    segments: u32,
    window: usize,
    feeds: &[(usize, f64)],
) -> Vec<Row<D::Axes>>
where
    D: Dynamics + Copy,
    P: Path<Axes = D::Axes, Error: Debug>,
{
    let mut window = vec![Knot::default(); window];
    let free = D::Axes::filled(FREE);
    let mut motion = limits
        .look_ahead(paths, free, |_| Ok(segments), &mut window)
        .unwrap();
    let mut rows = Vec::new();
    for (count, feed) in feeds.iter().chain([&(usize::MAX, 1.0)]) {
        rows.extend(motion.by_ref().map(Result::unwrap).take(*count));
        motion.set_feed(*feed).unwrap();
    }
    rows.extend(motion.by_ref().map(Result::unwrap));
    assert!(motion.is_finished());
    rows
}

/// The largest part of its torque that a motor is asked for.
fn most<D: Dynamics>(limits: &TorqueLimits<D>, rows: &[Row<D::Axes>]) -> f64 {
    let spans = rows.windows(2).map(|pair| Span {
        s: [0.0; 2],
        rows: [pair[0], pair[1]],
    });
    let used = spans.map(|span| limits.utilisation(&span));
    used.fold(0.0, |most, used| if used <= most { most } else { used })
}

pub(super) fn end_s<A: Axes>(rows: &[Row<A>]) -> f64 {
    rows.last().unwrap().time_s
}

/// By what a stream of these segments may be slower than a table: their knots stand elsewhere.
const SLOWER: f64 = 1.001;

#[test]
fn a_stream_is_as_fast_as_a_table() {
    for motors in [constant(), stepper()] {
        for payload_kg in [0.0, 3.0] {
            let limits = limits(payload_kg, motors);
            for ends in LINES {
                let (_, table_s) = planned(&limits, line(ends), 400);
                let rows = streamed(&limits, &[line(ends)], 400, 512, &[]);
                let used = most(&limits, &rows);
                println!(
                    "{:.5} of {table_s:.4} s, {used:.5} used",
                    end_s(&rows) / table_s
                );
                assert!(used <= WITHIN && end_s(&rows) <= table_s * SLOWER);
                let exact = sampled(&limits, &rows, 20);
                assert!(exact <= WITHIN && exact > 0.99, "{exact}");
            }
        }
    }
}

/// At the speed up to which a motor has torque all along, a cubic is a little faster between rows:
/// tables were refused there, and streams rested.
#[test]
fn motors_go_at_their_highest_speed() {
    for max_speed in [0.5, 1.0, 2.0, 3.0] {
        let motors = [30.0, 12.0].map(|torque| TorqueCurve::constant(torque, max_speed).unwrap());
        let limits = limits(1.0, motors);
        for ends in LINES {
            let (rows, table_s) = planned(&limits, line(ends), 200);
            let at_most = most_speed(&rows) / max_speed;
            assert!(at_most <= 1.0 && most(&limits, &rows) <= WITHIN);
            let rows = streamed(&limits, &[line(ends)], 200, 512, &[]);
            let slower = end_s(&rows) / table_s;
            println!("up to {at_most:.6} of {max_speed}: {slower:.5}");
            assert!(most(&limits, &rows) <= WITHIN && slower <= SLOWER);
        }
    }
}

/// The largest speed of an axis.
fn most_speed(rows: &[Row<[f64; 2]>]) -> f64 {
    let cubics = rows
        .windows(2)
        .flat_map(|pair| Cubic::between(&pair[0], &pair[1]));
    cubics.map(|cubic| cubic.peak_speed()).fold(0.0, f64::max)
}

/// Braking takes no more than the second half of a motion from rest to rest, and two segments.
#[test]
fn a_hold_rests_as_soon_as_the_motors_can_brake() {
    let limits = limits(1.0, constant());
    let rows = streamed(&limits, &[line(LINES[0])], 100, 256, &[]);
    let fastest =
        (1..rows.len()).min_by(|a, b| rows[*a].duration_s.total_cmp(&rows[*b].duration_s));
    let peak = fastest.unwrap();
    let braking_s = end_s(&rows) - rows[peak].time_s;
    for held in [10, 30, peak - 5] {
        let stopped = streamed(&limits, &[line(LINES[0])], 100, 256, &[(held, 0.0)]);
        assert!(most(&limits, &stopped) <= WITHIN);
        let rest = stopped
            .iter()
            .skip(held)
            .find(|row| row.is_at_rest())
            .unwrap();
        let rest_s = rest.time_s - stopped[held - 1].time_s;
        println!("held at row {held}: rests after {rest_s:.4} s, {braking_s:.4} s at most");
        assert!(rest_s <= braking_s + 2.0 * stopped[held - 1].duration_s);
        assert!(end_s(&stopped) > end_s(&rows));
    }
}

#[test]
fn a_segment_that_no_motor_can_bear_is_refused_at_rest() {
    let upright = ArmMasses {
        gravity_m_s2: 9.806_65,
        ..masses(3.0)
    };
    let dynamics = arm().dynamics(1e-3, upright).unwrap();
    // At rest at its end the arm needs 27.3 Nm, of which friction may carry 0.8.
    let motors = [26.0, 25.0].map(|torque| TorqueCurve::constant(torque, 20.0).unwrap());
    let weak = TorqueLimits { dynamics, motors };
    let path = line([[60.0, 300.0], [520.0, 200.0]]);
    let mut window = [Knot::default(); 64];
    let mut motion = weak
        .look_ahead([path], [FREE; 2], |_| Ok(80), &mut window)
        .unwrap();
    let (mut rows, mut refused) = (Vec::new(), None);
    while refused.is_none() {
        match motion.next_row() {
            Ok(row) => rows.push(row.unwrap()),
            Err(error) => refused = Some(error),
        }
    }
    let last = rows.last().unwrap();
    assert!(last.is_at_rest() && rows.len() > 10 && most(&weak, &rows) <= WITHIN);
    let Some(PlanError::Overload { leg: 0, s }) = refused else {
        panic!("{refused:?}");
    };
    assert!((s - last.s).abs() <= 0.0);
    assert!(!motion.is_finished() && motion.next_row().is_err());
}

fn gravity(g: f64, payload_kg: f64, motors: [TorqueCurve; 2]) -> TorqueLimits<ArmDynamics> {
    let masses = ArmMasses {
        gravity_m_s2: g,
        ..masses(payload_kg)
    };
    let dynamics = arm().dynamics(1e-3, masses).unwrap();
    TorqueLimits { dynamics, motors }
}

fn places() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let place = (150.0..560.0_f64, -1.2..1.2_f64);
    let place = place.prop_map(|(reach, angle)| [reach * angle.cos(), reach * angle.sin()]);
    prop::collection::vec(place, 2..6)
}

fn paths(places: &[[f64; 2]]) -> Vec<ArmPath> {
    let lines = places.windows(2).map_while(|pair| {
        let curve = Curve::line(pair[0], pair[1]).ok()?;
        arm().path(curve, Elbow::Right).ok()
    });
    lines.collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn no_feed_and_no_hold_takes_more_torque_than_there_is(
        places in places(), segments in 6..60_u32, window in 8..200_usize,
        payload_kg in 0.0..3.0_f64, falls in any::<bool>(), is_upright in any::<bool>(),
        feeds in prop::collection::vec((0..40_usize, prop_oneof![Just(0.0), 0.05..1.0_f64]), 0..6),
    ) {
        let paths = paths(&places);
        prop_assume!(!paths.is_empty());
        let motors = if falls { stepper() } else { constant() };
        let strong = [90.0, 40.0].map(|torque| TorqueCurve::holding(torque, 3.0, 30.0).unwrap());
        let limits = if is_upright { gravity(9.806_65, payload_kg, strong) } else { gravity(0.0, payload_kg, motors) };
        let rows = streamed(&limits, &paths, segments, window, &feeds);
        let last = rows.last().unwrap();
        prop_assert!(last.leg + 1 == paths.len() && last.is_at_rest());
        let used = most(&limits, &rows);
        prop_assert!(used <= WITHIN, "{used}");
    }

    #[test]
    fn nor_does_friction_that_is_nearly_all(
        places in places(), segments in 6..60_u32, viscous in 1.0..12.0_f64, torque in 20.0..60.0_f64,
        feeds in prop::collection::vec((0..40_usize, prop_oneof![Just(0.0), 0.05..1.0_f64]), 0..6),
    ) {
        let paths = paths(&places);
        prop_assume!(!paths.is_empty());
        let used = most_in_grease(&paths, segments, [viscous, torque], &feeds);
        prop_assert!(used <= WITHIN, "{used}");
    }
}

/// The largest part of its torque that a motor is asked for, of an upright arm whose joints have
/// viscous friction.
fn most_in_grease(
    paths: &[ArmPath],
    segments: u32,
    [viscous, torque]: [f64; 2],
    feeds: &[(usize, f64)],
) -> f64 {
    let mut masses = ArmMasses {
        gravity_m_s2: 9.806_65,
        ..masses(1.0)
    };
    masses.shoulder.viscous_nm_s = viscous;
    masses.elbow.viscous_nm_s = 0.4 * viscous;
    let motors = [torque, 0.5 * torque].map(|t| TorqueCurve::holding(t, 1.0, 30.0).unwrap());
    let dynamics = arm().dynamics(1e-3, masses).unwrap();
    let limits = TorqueLimits { dynamics, motors };
    let mut window = [Knot::default(); 100];
    let mut motion = limits
        .look_ahead(paths, [FREE; 2], |_| Ok(segments), &mut window)
        .unwrap();
    let mut rows = Vec::new();
    for (count, feed) in feeds.iter().chain([&(usize::MAX, 1.0)]) {
        rows.extend(motion.by_ref().map_while(Result::ok).take(*count));
        motion.set_feed(*feed).unwrap();
    }
    rows.extend(motion.by_ref().map_while(Result::ok));
    most(&limits, &rows)
}

/// Slower than planned at a speed that the elbow's motor cannot hold, a segment asked for more than
/// its torque at the planned ratio of speeds.
#[test]
fn what_cannot_be_held_is_braked() {
    let paths = paths(&[
        [239.933_182_188_251_1, -65.617_860_405_840_94],
        [412.179_903_799_693_8, 83.212_681_313_910_11],
    ]);
    let friction = [10.839_210_173_326_615, 20.617_604_798_108_218];
    let used = most_in_grease(&paths, 34, friction, &[]);
    assert!(used <= WITHIN, "{used}");
}

/// At the end of a window the machine was to rest at a knot; after more had come, it passed that
/// knot at 5e-14 of the speed before, and took 12 trillion seconds to the rest at the next.
#[test]
fn a_rest_is_not_crawled_to() {
    let drive = JointDrive {
        rotor_kg_m2: 0.031_123_223_098_094_326,
        viscous_nm_s: 0.337_767_476_897_508_6,
        coulomb_nm: 0.764_592_410_021_209_8,
    };
    let masses = alike(1.683_411_682_526_423_6, drive, 2.659_793_170_175_839_3);
    let motors = [
        TorqueCurve::holding(185.151_462_094_955_38, 3.995_920_485_501_659_2, 40.0).unwrap(),
        TorqueCurve::constant(39.754_452_210_015_75, 40.0).unwrap(),
    ];
    let dynamics = arm().dynamics(1e-3, masses).unwrap();
    let torque = TorqueLimits { dynamics, motors };
    let curve = Curve::bezier([
        [-13.736_236_387_671, 125.414_910_504_134_06],
        [179.973_526_586_832_58, 413.228_595_121_814_7],
        [263.039_758_767_567_04, 146.868_278_787_059_75],
        [247.090_214_013_062_8, 151.445_308_183_296_22],
    ]);
    let path = arm().path(curve.unwrap(), Elbow::Right).unwrap();
    let joints = [
        (6.962_512_063_100_581, 162.683_773_500_840_35),
        (17.724_487_859_063_274, 314.083_073_909_624_9),
    ];
    let joints = joints.map(|(speed, acceleration)| AxisLimits {
        speed,
        acceleration,
        jerk: None,
    });
    let time_s = |window: usize| {
        let mut window = vec![Knot::default(); window];
        let rows = torque.look_ahead([path], joints, |_| Ok(64), &mut window);
        end_s(&rows.unwrap().map(Result::unwrap).collect::<Vec<_>>())
    };
    let whole_s = time_s(128);
    for window in 15..24 {
        let ratio = time_s(window) / whole_s;
        assert!(ratio < 1.1, "{ratio} with a window of {window}");
    }
}

proptest! {
    // Each takes as long as twenty of an arm.
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn nor_does_a_delta_take_more(
        places in prop::collection::vec((-60.0..60.0_f64, -60.0..60.0_f64, -310.0..-240.0_f64), 2..5),
        segments in 6..60_u32, window in 8..200_usize,
        feeds in prop::collection::vec((0..40_usize, prop_oneof![Just(0.0), 0.05..1.0_f64]), 0..6),
    ) {
        let (delta, limits) = delta();
        let lines = places.windows(2).map_while(|pair| {
            let [from, to] = [pair[0], pair[1]].map(|(x, y, z)| [x, y, z]);
            delta.path(Curve::line(from, to).ok()?).ok()
        });
        let paths: Vec<_> = lines.collect();
        prop_assume!(!paths.is_empty());
        let rows = streamed(&limits, &paths, segments, window, &feeds);
        let last = rows.last().unwrap();
        prop_assert!(last.leg + 1 == paths.len() && last.is_at_rest());
        let used = most(&limits, &rows);
        prop_assert!(used <= WITHIN, "{used}");
    }
}
