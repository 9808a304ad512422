//! The bounds of the two arms by hand beside those that follow from their inverses alone, on the
//! paths of the arms' own tests.

use core::f64::consts::FRAC_PI_2;
use core::fmt::Debug;

use delta_kin::{Delta, DeltaPath, Dimensions};
use machine_kin::path_timing::{Accuracy, AxisLimits, Curve, Knot, Path, Span, Table, ToolLimits};
use machine_kin::{Elbow, Machine, MachinePath, PathError};
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::TestRunner;
use scara_kin::nalgebra::{Isometry2, Vector2};
use scara_kin::{Arm, ArmPath, Joints};

use crate::common::arms::{RotaryDelta, TwoLinks};
use crate::common::{cubics, distance, within};

/// The largest ratio of both bounds of a table that is allowed on any path: what the mechanism
/// promises.
const RATIO: f64 = 2.0;

/// Of places of machines of some hundred mm.
const ROUNDING: f64 = 1e-10;

fn any_curve<const N: usize>(
    point: impl Strategy<Value = [f64; N]> + Clone + 'static,
    way: impl Strategy<Value = [f64; N]> + 'static,
) -> BoxedStrategy<Curve<N>> {
    let (a, b, c, d) = (point.clone(), point.clone(), point.clone(), point.clone());
    prop_oneof![
        (point.clone(), point.clone()).prop_map(|(from, to)| Curve::line(from, to).unwrap()),
        (point.clone(), point, way, 0.1..5.0_f64).prop_filter_map(
            "no arc",
            |(start, centre, way, angle)| Curve::arc(start, centre, way, angle).ok()
        ),
        (a, b, c, d).prop_filter_map("a cusp", |(a, b, c, d)| Curve::bezier([a, b, c, d]).ok()),
    ]
    .boxed()
}

/// How many times the bound by hand the other one is, by tables: median, 90 %, most; and the bound
/// over what dense sampling finds.
struct Ratios {
    of_hand_made: Vec<f64>,
    of_measured: Vec<f64>,
    segments: usize,
    /// Those of which it is not known that they may be run at any speeds: the planners' own are
    /// shorter.
    coarse: usize,
}

impl Ratios {
    const fn new() -> Self {
        Self {
            of_hand_made: Vec::new(),
            of_measured: Vec::new(),
            segments: 0,
            coarse: 0,
        }
    }

    fn add<M: Machine<N>, const N: usize>(
        &mut self,
        path: &MachinePath<M, N>,
        spans: impl Iterator<Item = Span<[f64; N]>>,
        by_hand: impl Fn(&Span<[f64; N]>) -> f64,
        forward: impl Fn([f64; N]) -> [f64; N],
    ) {
        let [mut bound, mut hand_made, mut measured] = [0.0_f64; 3];
        for span in spans {
            let (own, by_hand) = (path.departure(&span), by_hand(&span));
            self.segments += 1;
            if let Err(error) = path.check(&span) {
                assert!(matches!(error, PathError::TooCoarse { .. }), "{error}");
                self.coarse += 1;
            }
            (bound, hand_made) = (bound.max(own), hand_made.max(by_hand));
            let mut worst = 0.0_f64;
            for number in 0..=200 {
                let share = f64::from(number) / 200.0;
                let at = span.s[0] + (span.s[1] - span.s[0]) * share;
                let positions = cubics(&span).map(|cubic| cubic.position(share));
                worst = worst.max(distance(path.curve(), forward(positions), at));
            }
            assert!(worst <= own + ROUNDING, "{worst} {own}");
            measured = measured.max(worst);
        }
        self.of_hand_made.push(bound / hand_made);
        self.of_measured.push(bound / measured);
    }

    fn report(&mut self, name: &str) {
        for (of, ratios) in [
            ("the bound by hand", &mut self.of_hand_made),
            ("measured", &mut self.of_measured),
        ] {
            ratios.sort_by(f64::total_cmp);
            let at = |percent| quantile(ratios, percent);
            println!(
                "{name}, bound over {of} on {} paths: median {:.3}, 90 % {:.3}, most {:.3}",
                ratios.len(),
                at(50),
                at(90),
                at(100)
            );
        }
        println!("{} of {} segments too coarse", self.coarse, self.segments);
        assert!(self.coarse * 10 < self.segments);
        let ratios = &self.of_hand_made;
        assert!(ratios.len() >= 20);
        assert!(quantile(ratios, 100) <= RATIO);
    }
}

/// Of sorted numbers the one that so many percent do not exceed.
fn quantile(sorted: &[f64], percent: usize) -> f64 {
    sorted[(sorted.len() - 1) * percent / 100]
}

fn limits<const N: usize>(speed: f64, acceleration: f64) -> [AxisLimits; N] {
    [AxisLimits {
        speed,
        acceleration,
        jerk: None,
    }; N]
}

fn feed(feed: f64, acceleration: f64) -> ToolLimits {
    ToolLimits {
        feed,
        acceleration: Some(acceleration),
    }
}

/// A path that the hand-made proof accepts; whether both do.
fn both<A, E: Debug, B, F: Debug>(own: Result<A, E>, by_hand: Result<B, F>) -> Option<(A, B)> {
    let Ok(by_hand) = by_hand else { return None };
    Some((own.expect("the arm itself accepts it"), by_hand))
}

#[test]
fn the_arm_s_bound_is_near_the_one_by_hand() {
    let arms = [
        (Arm::new(132.0, 132.0).unwrap(), [132.0, 132.0], [0.0; 3]),
        (
            Arm::new(150.0, 110.0)
                .unwrap()
                .with_base(Isometry2::new(Vector2::new(20.0, -30.0), 2.0))
                .unwrap(),
            [150.0, 110.0],
            [20.0, -30.0, 2.0],
        ),
    ];
    let mut ratios = Ratios::new();
    let mut runner = TestRunner::deterministic();
    let mut knots = vec![Knot::default(); 20_000];
    let coordinates = || prop::array::uniform2(-250.0..250.0_f64);
    let curves = any_curve(coordinates(), coordinates());
    for number in 0..60 {
        let curve = curves.new_tree(&mut runner).unwrap().current();
        let curve = curve.with_tool(feed(100.0, 1500.0));
        let (arm, [upper, fore], base) = arms[number % 2];
        let machine = TwoLinks { upper, fore, base };
        let by_hand = arm.path(curve, scara_kin::Elbow::Right);
        let Some((path, by_hand)) = both(machine.path(curve, Elbow::Right), by_hand) else {
            continue;
        };
        let table = Table::plan_within(
            [by_hand],
            limits(3.0, 30.0),
            within(0.01),
            ArmPath::departure,
            &mut knots,
        );
        let table = table.unwrap();
        let departure = |span: &Span<_>| by_hand.departure(span);
        ratios.add(&path, table.spans(), departure, |[shoulder, elbow]| {
            arm.forward(Joints::new(shoulder, elbow)).coords.into()
        });
    }
    ratios.report("two links");
}

#[test]
fn the_delta_s_bound_is_near_the_one_by_hand() {
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .unwrap();
    let machines = [
        (delta, 0.0),
        (delta.with_zero(FRAC_PI_2).unwrap(), FRAC_PI_2),
    ];
    let mut ratios = Ratios::new();
    let mut runner = TestRunner::deterministic();
    let mut knots = vec![Knot::default(); 5000];
    let point = || [-130.0..130.0_f64, -130.0..130.0_f64, -340.0..-180.0_f64];
    let curves = any_curve(point(), point());
    for number in 0..60 {
        let curve = curves.new_tree(&mut runner).unwrap().current();
        let curve = curve.with_tool(feed(400.0, 8000.0));
        let (delta, zero) = machines[number % 2];
        let machine = RotaryDelta {
            radius: 24.0,
            upper: 120.0,
            lower: 243.0,
            zero,
        };
        let own = machine.path(curve, ());
        if let (
            Err(PathError::Singular { point, .. } | PathError::BranchEnds { point, .. }),
            Ok(_),
        ) = (&own, delta.path(curve))
        {
            // Nearer to the edge of the workspace than a part of a thousand of its size.
            assert!(delta.clearance(*point) < 0.1, "{own:?}");
            continue;
        }
        let Some((path, by_hand)) = both(own, delta.path(curve)) else {
            continue;
        };
        let accuracy = Accuracy {
            min_segments: 4,
            ..within(0.01)
        };
        let departure = DeltaPath::departure;
        let table = Table::plan_within(
            [by_hand],
            limits(6.0, 100.0),
            accuracy,
            departure,
            &mut knots,
        );
        let table = table.unwrap();
        let departure = |span: &Span<_>| by_hand.departure(span);
        ratios.add(&path, table.spans(), departure, |angles| {
            delta.forward(angles).unwrap().coords.into()
        });
    }
    ratios.report("rotary Delta");
}
