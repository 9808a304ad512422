//! Curves: arc length, derivatives, blends, and how far cubics depart from them.

use core::f64::consts::PI;

use path_timing::{
    AxisLimits, Curve, CurveError, CurveMotion, Knot, PlanError, Row, Span, Table, ToolLimits,
};

use crate::support::polyline::{smoothed, within};
use crate::support::vectors::{bits, dot, norm, sub};
use proptest::prelude::*;

/// Of sums of some products of coordinates up to 1000.
const ROUNDING: f64 = 1e-11;

/// Step of finite differences, in the unit of length, and what they are off by with curvatures
/// up to 1.
const STEP: f64 = 1e-4;
const DIFFERENCES: f64 = 1e-6;

fn curves() -> Vec<Curve<3>> {
    vec![
        Curve::line([1.0, 2.0, 3.0], [-4.0, 8.0, 10.0]).unwrap(),
        Curve::arc([5.0, 0.0, 1.0], [2.0, 4.0, 1.0], [0.3, 1.0, 0.5], 4.0).unwrap(),
        Curve::bezier([
            [0.0, 0.0, 0.0],
            [30.0, 5.0, -9.0],
            [-10.0, 40.0, 3.0],
            [20.0, 42.0, 8.0],
        ])
        .unwrap(),
    ]
}

/// |dP/ds| = 1 within what the curve says, and the derivatives are those of the points.
#[test]
fn derivatives_are_those_of_the_points() {
    for curve in curves() {
        for number in 1..200 {
            let s = curve.length() * f64::from(number) / 200.0;
            let [before, here, after] = [s - STEP, s, s + STEP].map(|s| curve.at(s));
            let tangent = sub(after.point, before.point).map(|d| d / (2.0 * STEP));
            assert!(
                norm(sub(tangent, here.tangent)) < DIFFERENCES,
                "{curve:?} {s}"
            );
            let curvature = sub(after.tangent, before.tangent).map(|d| d / (2.0 * STEP));
            assert!(
                norm(sub(curvature, here.curvature)) < DIFFERENCES,
                "{curve:?} {s}"
            );
            let off = (norm(here.tangent) - 1.0).abs();
            assert!(off <= curve.speed_error() + ROUNDING, "{off}");
        }
        assert!(curve.speed_error() < 1e-5, "{}", curve.speed_error());
        assert_eq!(bits(curve.at(0.0).point), bits(curve.start()));
        assert_eq!(bits(curve.at(curve.length()).point), bits(curve.end()));
    }
}

#[test]
fn lengths_are_those_of_the_closed_forms() {
    let line = Curve::line([0.0, 0.0], [3.0, 4.0]).unwrap();
    assert!((line.length() - 5.0).abs() < ROUNDING);
    let arc = Curve::arc([10.0, 0.0], [0.0, 0.0], [0.0, -1.0], PI / 2.0).unwrap();
    assert!((arc.length() - 5.0 * PI).abs() < ROUNDING);
    assert!(norm(sub(arc.end(), [0.0, -10.0])) < ROUNDING);
    assert!(
        norm(sub(
            arc.at(5.0 * PI / 2.0).point,
            [50_f64.sqrt(), -50_f64.sqrt()]
        )) < ROUNDING
    );
    // A parabola: (t, t²) has the length √5/2 + asinh(2)/4.
    let parabola = Curve::bezier([
        [0.0, 0.0],
        [1.0 / 3.0, 0.0],
        [2.0 / 3.0, 1.0 / 3.0],
        [1.0, 1.0],
    ]);
    let length = 5_f64.sqrt() / 2.0 + 2_f64.asinh() / 4.0;
    assert!((parabola.unwrap().length() - length).abs() < ROUNDING);
}

#[test]
fn what_is_no_curve_is_refused() {
    let nan = f64::NAN;
    let short = |length| Err(CurveError::NoLength { length });
    assert_eq!(Curve::line([1.0, 2.0], [1.0, 2.0]), short(0.0));
    assert_eq!(
        Curve::line([1.0, 2.0], [nan, 2.0]),
        Err(CurveError::NotFinite)
    );
    assert_eq!(
        Curve::line([1e200, 2.0], [-1e200, 2.0]),
        Err(CurveError::NotFinite)
    );
    let arc = |centre, direction, angle| Curve::arc([5.0, 0.0], centre, direction, angle);
    assert_eq!(arc([5.0, 0.0], [0.0, 1.0], 1.0), short(0.0));
    assert_eq!(arc([0.0, 0.0], [0.0, 1.0], -1.0), short(-5.0));
    assert_eq!(arc([0.0, 0.0], [0.0, 1.0], nan), Err(CurveError::NotFinite));
    assert_eq!(
        arc([0.0, 0.0], [3.0, 0.0], 1.0),
        Err(CurveError::NoDirection)
    );
    assert_eq!(
        arc([0.0, 0.0], [0.0, 0.0], 1.0),
        Err(CurveError::NoDirection)
    );
    assert!(matches!(
        arc([0.0, 0.0], [0.0, 1.0], 101.0),
        Err(CurveError::Angle { .. })
    ));
    assert_eq!(Curve::bezier([[1.0, 2.0]; 4]), short(0.0));
    assert_eq!(Curve::bezier([[nan, 2.0]; 4]), Err(CurveError::NotFinite));
    // There and back: the derivative vanishes at 1/2.
    let back = Curve::bezier([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]);
    let Err(CurveError::Cusp { parameter }) = back else {
        panic!("{back:?}")
    };
    assert!((parameter - 0.5).abs() < 0.05);
}

/// Places of a curve from which nearest ones are looked for, and how many where a bound seems to be
/// passed.
const SAMPLES: u32 = 512;
const MANY: u32 = 1 << 16;

/// Newton steps to the nearest place between two samples; a step that leaves them halves the gap
/// instead.
const STEPS: u32 = 60;

/// The distance of a place from a curve that is known at samples: the least of all that may be
/// least by Lipschitz, each from its nearest sample to the place where its tangent is square to the
/// way there.
fn distance<const D: usize>(curve: &Curve<D>, samples: &[(f64, [f64; D])], place: [f64; D]) -> f64 {
    let step = samples[1].0 * (1.0 + curve.speed_error());
    let far: Vec<_> = (samples.iter().map(|(_, at)| norm(sub(place, *at)))).collect();
    let mut least = far.iter().copied().fold(f64::INFINITY, f64::min);
    let limit = least + step;
    for (index, own) in far.iter().enumerate() {
        let [before, after] = [index.saturating_sub(1), (index + 1).min(far.len() - 1)];
        if *own > limit || far[before] < *own || far[after] < *own {
            continue;
        }
        let [mut low, mut high] = [before, after].map(|index| samples[index].0);
        let mut s = samples[index].0;
        for _ in 0..STEPS {
            let at = curve.at(s);
            let way = sub(place, at.point);
            least = least.min(norm(way));
            let ahead = dot(way, at.tangent);
            if ahead > 0.0 {
                low = s;
            } else {
                high = s;
            }
            let newton = s + ahead / (dot(at.tangent, at.tangent) - dot(way, at.curvature));
            let next = if (low..=high).contains(&newton) {
                newton
            } else {
                f64::midpoint(low, high)
            };
            if (next - s).abs() <= f64::EPSILON * curve.length() {
                break;
            }
            s = next;
        }
    }
    least
}

/// How far the cubics of a segment are from the curve at most, at some places.
fn measured<const D: usize>(
    curve: &Curve<D>,
    span: &Span<[f64; D]>,
    places: u32,
    samples: u32,
) -> f64 {
    let [from, to] = &span.rows;
    let cubics: Vec<_> = path_timing::Cubic::between(from, to).collect();
    let samples: Vec<_> = (0..=samples)
        .map(|number| {
            let s = curve.length() * f64::from(number) / f64::from(samples);
            (s, curve.at(s).point)
        })
        .collect();
    let places = (0..=places).map(|number| {
        let share = f64::from(number) / f64::from(places);
        let place = core::array::from_fn(|axis| cubics[axis].position(share));
        distance(curve, &samples, place)
    });
    places.fold(0.0, f64::max)
}

/// A segment of a curve passed with any speeds at its ends.
fn span<const D: usize>(curve: &Curve<D>, s: [f64; 2], speeds: [f64; 2]) -> Span<[f64; D]> {
    let duration_s = 2.0 * (s[1] - s[0]) / (speeds[0] + speeds[1]);
    let row = |end: usize| {
        let at = curve.at(s[end]);
        Row {
            time_s: 0.0,
            duration_s,
            position: at.point,
            velocity: at.tangent.map(|t| t * speeds[end]),
            leg: 0,
            s: 0.0,
        }
    };
    Span {
        s,
        rows: [row(0), row(1)],
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// The bound holds for any speeds at the ends of any piece of a curve.
    #[test]
    fn no_cubic_departs_by_more_than_its_bound(
        points in prop::array::uniform4(prop::array::uniform2(-100.0..100.0_f64)),
        from in 0.0..0.95_f64,
        share in 0.001..0.2_f64,
        ratio in 0.0..1.0_f64,
        is_rising: bool,
        radius in 1.0..100.0_f64,
    ) {
        let speeds = if is_rising { [ratio, 1.0] } else { [1.0, ratio] };
        let arc = Curve::arc([radius, 0.0], [0.0, 0.0], [0.0, 1.0], 5.0).unwrap();
        let bezier = Curve::bezier(points);
        for curve in [Ok(arc), bezier].into_iter().flatten() {
            let to = (from + share).min(1.0);
            let span = span(&curve, [from, to].map(|share| share * curve.length()), speeds);
            let bound = curve.departure(&span) + ROUNDING;
            let is_within = |samples| measured(&curve, &span, 100, samples) <= bound;
            prop_assert!(is_within(SAMPLES) || is_within(MANY), "{bound}");
        }
    }
}

/// Where the curve nearly turns back, so that steps towards the place ahead do not end at the
/// nearest: the distance is that of a dense look.
#[test]
fn the_nearest_place_is_found_by_a_cusp() {
    let points = [[67.405, 0.0], [-42.509, 0.0], [0.0, -77.517], [0.0, 0.0]];
    let curve = Curve::bezier(points).unwrap();
    let s = [0.7745, 0.7745 + 0.1798].map(|share| share * curve.length());
    let span = span(&curve, s, [0.0, 1.0]);
    let [few, many] = [SAMPLES, MANY].map(|samples| measured(&curve, &span, 100, samples));
    assert!(
        (few - many).abs() < ROUNDING && (0.039..0.04).contains(&few),
        "{few} {many}"
    );
    assert!(few < curve.departure(&span));
}

/// On tables within a tolerance the bound is at most three times what is measured.
#[test]
fn bounds_of_tables_are_near_to_what_is_measured() {
    let axis = AxisLimits {
        speed: 100.0,
        acceleration: 1500.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 2000];
    let mut ratios = Vec::new();
    for number in 0..40_u32 {
        let random = |k: u32| (f64::from(number * 8 + k) * 0.618_034).fract() * 100.0;
        let bezier = Curve::bezier(core::array::from_fn::<_, 4, _>(|i| {
            let k = 2 * u32::try_from(i).unwrap();
            [random(k), random(k + 1)]
        }));
        let arc = Curve::arc(
            [5.0 + random(1), 0.0],
            [0.0, 0.0],
            [0.0, 1.0],
            0.1 + random(2) * 0.05,
        );
        for curve in [bezier, arc].into_iter().flatten() {
            let curve = curve.with_tool(ToolLimits {
                feed: 80.0,
                acceleration: None,
            });
            for tolerance in [0.1, 0.001] {
                let table = Table::plan_within(
                    [curve],
                    [axis; 2],
                    within(4, tolerance),
                    Curve::departure,
                    &mut knots,
                )
                .unwrap();
                let of_all = |departure: &dyn Fn(&Span<[f64; 2]>) -> f64| {
                    table
                        .spans()
                        .map(|span| departure(&span))
                        .fold(0.0, f64::max)
                };
                let bound = of_all(&|span| curve.departure(span));
                assert!(bound <= tolerance);
                let worst = of_all(&|span| measured(&curve, span, 100, SAMPLES));
                assert!(worst <= bound);
                ratios.push(bound / worst);
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    let of = |share: usize| ratios[(ratios.len() - 1) * share / 100];
    println!("bound over measured: {} {} {}", of(50), of(90), of(100));
    assert!(of(100) <= 3.0, "{ratios:?}");
}

/// A Cartesian machine is exact on lines, and a departure that nothing keeps is refused.
#[test]
fn lines_have_no_departure() {
    let line = Curve::line([0.0, 0.0, 0.0], [30.0, 40.0, 0.0]).unwrap();
    let span = span(&line, [0.0, 50.0], [0.0, 10.0]);
    assert!(line.departure(&span) < ROUNDING);
    let axis = AxisLimits {
        speed: 100.0,
        acceleration: 1500.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 10];
    let arc = Curve::arc([50.0, 0.0], [0.0, 0.0], [0.0, 1.0], 3.0).unwrap();
    let table = Table::plan_within(
        [arc],
        [axis; 2],
        within(2, 1e-9),
        Curve::departure,
        &mut knots,
    );
    assert!(matches!(table, Err(PlanError::Memory { .. })));
}

/// The spans of a table of several curves are those of each in turn.
#[test]
fn spans_of_several_curves_follow_each_other() {
    let axis = AxisLimits {
        speed: 100.0,
        acceleration: 1500.0,
        jerk: None,
    };
    let curves = smoothed(&[[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [60.0, 25.0]], 0.5);
    let mut knots = [Knot::default(); 500];
    let table = Table::plan_within(
        curves.iter(),
        [axis; 2],
        within(4, 1e-3),
        |curve: &&Curve<2>, span: &_| curve.departure(span),
        &mut knots,
    );
    let table = table.unwrap();
    let (mut spans, mut before) = (0, (0, 0.0));
    for span in table.spans() {
        let leg = span.rows[1].leg;
        let start: f64 = if leg == before.0 { before.1 } else { 0.0 };
        assert_eq!(span.s[0].to_bits(), start.to_bits());
        assert!(span.s[0] < span.s[1] && span.s[1] <= curves[leg].length());
        assert!(curves[leg].departure(&span) <= 1e-3);
        (spans, before) = (spans + 1, (leg, span.s[1]));
    }
    assert_eq!((spans + 1, before.0), (table.len(), curves.len() - 1));
}

/// At both ends slower than two and a half times the mean, and not backwards: a point stays between
/// them.
#[test]
fn a_motion_that_turns_back_does_not_go_forward() {
    let curve = Curve::line([0.0; 3], [3.0, 4.0, 0.0]).unwrap();
    let goes = |speeds: [f64; 2]| {
        let along = |speed| curve.at(0.0).tangent.map(|x| x * speed * 5.0);
        let [before, after] = speeds.map(along);
        CurveMotion::new(&curve, [0.0, 5.0], [&before, &after], 1.0).goes_forward()
    };
    assert!([[1.0, 1.0], [0.0, 2.0], [2.4, 0.6]].into_iter().all(goes));
    assert!(![[-0.1, 1.0], [1.0, 4.0]].into_iter().any(goes));
}

proptest! {
    /// The series of a point that is accelerated along a curve, beside its places: within the rest.
    #[test]
    fn places_of_a_motion_are_those_of_its_series(
        number in 0_usize..3,
        from in 0.0..0.7_f64,
        share in 0.02..0.3_f64,
        speeds in [0.0..2.0_f64, 0.0..2.0],
        tau in 0.0..=1.0_f64,
        other in 0.0..=1.0_f64,
    ) {
        let curve = curves()[number];
        let s = [from, from + share].map(|part| curve.length() * part);
        let way = s[1] - s[0];
        let [before, after] = [0, 1].map(|end| curve.at(s[end]).tangent.map(|x| x * way * speeds[end]));
        let motion = CurveMotion::new(&curve, s, [&before, &after], 1.0);
        let series = motion.series(tau);
        let [u1, u2, u3] = series.parameter;
        let h = other - tau;
        let u = h * (u1 + h * (u2 + h * u3));
        let mut place = [0.0; 3];
        let divisors = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        for (derivative, divisor) in series.derivatives.iter().zip(divisors).rev() {
            let factor = u / divisor;
            for (place, derivative) in place.iter_mut().zip(derivative) {
                *place = *place * factor + derivative;
            }
        }
        let rest = series.longest_sixth * u.powi(6) / 720.0;
        let off = norm(sub(place, motion.at(other)));
        prop_assert!(off <= rest + ROUNDING, "{off} {rest}");
    }

    /// Evenly along the parameter: the same places as any other motion, one after the other.
    #[test]
    fn an_even_motion_runs_from_place_to_place(number in 0_usize..3, from in 0.0..0.7_f64, share in 0.02..0.3_f64) {
        let curve = curves()[number];
        let s = [from, from + share].map(|part| curve.length() * part);
        let motion = CurveMotion::evenly(&curve, s);
        for (tau, s) in [0.0, 1.0].into_iter().zip(s) {
            prop_assert!(norm(sub(motion.at(tau), curve.at(s).point)) <= ROUNDING);
        }
        let [u1, u2, u3] = motion.series(0.3).parameter;
        prop_assert!(u1 > 0.0 && u2.abs() <= u1 * ROUNDING && u3.abs() <= u1 * ROUNDING);
    }

    /// How far a tool is off says as much as where it is.
    #[test]
    fn a_tool_s_place_and_its_difference_depart_alike(
        number in 0_usize..3,
        off in prop::array::uniform3(-1e-2..1e-2_f64),
        fourth in 0.0..10.0_f64,
    ) {
        let curve = curves()[number];
        let motion = CurveMotion::evenly(&curve, [0.2, 0.4].map(|part| curve.length() * part));
        let difference = |tau: f64| off.map(|x| x * 16.0 * tau * tau * (1.0 - tau) * (1.0 - tau));
        let tool = |tau: f64| {
            let [place, by] = [motion.at(tau), difference(tau)];
            [0, 1, 2].map(|k| place[k] + by[k])
        };
        let by_place = motion.departure_between(tool, fourth, |_| 1e-6);
        let by_difference = motion.departure_by_difference(difference, fourth, |_| 1e-6);
        prop_assert!((by_place - by_difference).abs() <= ROUNDING);
    }
}
