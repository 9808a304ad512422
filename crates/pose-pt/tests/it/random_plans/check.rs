//! What a PVT table and its runs promise, looked at on the numbers that a controller gets.

use crate::support::table::{BodyTable, Point, bound, points_of};
use path_timing::Playback;
use pose_pt::nalgebra::Vector3;
use pose_pt::{LocatorAxis, Platform};

use crate::random_plans::scene::{Draw, Scene};
use crate::support::exact::Exact;

/// Places of a segment at which the distance error is looked at.
const PLACES: u32 = 24;

/// What positions round off, in parts of the lengths that are added.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What a sum of times rounds off.
const TIME: f64 = 1e-9;

/// One axis between two points.
struct Cubic {
    q0: f64,
    q1: f64,
    v0: f64,
    v1: f64,
    time: f64,
}

fn cubics<'a>(
    platform: &'a Platform<3>,
    from: &'a Point<3>,
    to: &'a Point<3>,
) -> impl Iterator<Item = (Cubic, &'a LocatorAxis)> {
    (0..9)
        .map(|number| (number / 3, number % 3))
        .map(move |(number, axis)| {
            let cubic = Cubic {
                q0: from.axes[number][axis],
                q1: to.axes[number][axis],
                v0: from.velocities[number][axis],
                v1: to.velocities[number][axis],
                time: to.segment_s,
            };
            (cubic, &platform.locators()[number].limits[axis])
        })
}

impl Cubic {
    /// Accelerations at the start and at the end, times the square of the duration.
    fn accelerations(&self) -> [Exact; 2] {
        let [q0, q1, v0, v1, time] =
            [self.q0, self.q1, self.v0, self.v1, self.time].map(Exact::from);
        let [two, four, six] = [2.0, 4.0, 6.0].map(Exact::from);
        let way = six * (q1 - q0);
        [
            way - (four * v0 + two * v1) * time,
            (two * v0 + four * v1) * time - way,
        ]
    }

    /// Speed, acceleration and jerk, in 32 digits: the speed at its extreme is
    /// v₀ + a₀² T / 2 (a₀ - a₁).
    fn check_limits(&self, limits: &LocatorAxis, heeds_jerk: bool) {
        let time = Exact::from(self.time);
        let [a0, a1] = self.accelerations();
        let allowed = Exact::from(limits.acceleration) * time * time;
        for asked in [a0, a1] {
            assert!(
                asked.abs() <= allowed,
                "acceleration {}",
                share(asked, allowed)
            );
        }
        let speed = Exact::from(limits.speed);
        let v0 = Exact::from(self.v0);
        for end in [self.v0, self.v1] {
            assert!(end.abs() <= limits.speed, "speed {end} of {}", limits.speed);
        }
        let zero = Exact::from(0.0);
        let (rises, falls) = (a0 > zero && a1 < zero, a0 < zero && a1 > zero);
        if rises || falls {
            let room = if rises { speed - v0 } else { speed + v0 };
            let allowed = Exact::from(2.0) * room * time * (a0 - a1).abs();
            assert!(a0 * a0 <= allowed, "speed {}", share(a0 * a0, allowed));
        }
        if let Some(jerk) = limits.jerk.filter(|_| heeds_jerk) {
            let allowed = Exact::from(jerk) * time * time * time;
            assert!(
                (a1 - a0).abs() <= allowed,
                "jerk {}",
                share(a1 - a0, allowed)
            );
        }
    }

    fn position(&self, u: f64) -> f64 {
        let (rest, third) = (1.0 - u, self.time / 3.0);
        let (b1, b2) = (self.q0 + self.v0 * third, self.q1 - self.v1 * third);
        let outer = self.q0 * rest * rest * rest + self.q1 * u * u * u;
        outer + 3.0 * u * rest * (b1 * rest + b2 * u)
    }

    /// Positions at both ends and where the speed is zero between.
    fn extremes(&self) -> Vec<f64> {
        let [a0, a1] = self.accelerations().map(Exact::value);
        // v₀ T + a₀ T² u + (a₁ - a₀) T² u² / 2 = 0.
        let (a, b, c) = ((a1 - a0) / 2.0, a0, self.v0 * self.time);
        let root = (b * b - 4.0 * a * c).sqrt();
        let sum = -(b + root.copysign(b));
        let inside = [sum / (2.0 * a), 2.0 * c / sum];
        let inside = inside.into_iter().filter(|u| *u > 0.0 && *u < 1.0);
        let mut all = vec![self.q0, self.q1];
        all.extend(inside.map(|u| self.position(u)));
        all
    }
}

fn share(asked: Exact, allowed: Exact) -> f64 {
    asked.abs().value() / allowed.value()
}

/// The lengths that positions are made of.
fn size(platform: &Platform<3>, points: &[Point<3>]) -> f64 {
    let origins = platform
        .locators()
        .iter()
        .map(|locator| locator.origin.coords.amax() + locator.anchor.coords.amax());
    let axes = points
        .iter()
        .flat_map(|point| point.axes.map(|axes| axes.amax()));
    origins.chain(axes).fold(0.0, f64::max)
}

fn distance_error(platform: &Platform<3>, axes: &[Vector3<f64>; 3]) -> f64 {
    platform
        .distance_error(&platform.locator_positions(axes))
        .change
        .abs()
}

/// The distance error between two points is within the bound.
fn check_distance_error(platform: &Platform<3>, pair: [&Point<3>; 2], bound: f64, rounding: f64) {
    let [from, to] = pair;
    for place in 0..=PLACES {
        let share = f64::from(place) / f64::from(PLACES);
        let mut places = cubics(platform, from, to).map(|(cubic, _)| cubic.position(share));
        let axes = [(); 3].map(|()| Vector3::from_fn(|_, _| places.next().unwrap()));
        let distance_error = distance_error(platform, &axes);
        assert!(
            distance_error <= bound + rounding,
            "distance error {distance_error}, bound {bound}"
        );
    }
}

pub(crate) fn check_table(scene: &Scene, platform: &Platform<3>, table: &BodyTable<'_, 3>) {
    let points = points_of(table.rows());
    assert_eq!(points.len(), table.len());
    let rounding = ROUNDING * size(platform, &points);
    let bound = bound(platform, table);
    if let Some(allowed) = scene.allowed() {
        assert!(bound <= allowed, "bound {bound}, allowed {allowed}");
    }
    let first = points.first().unwrap();
    assert!(first.time_s == 0.0 && first.velocities.iter().all(|v| v.amax() == 0.0));
    for pair in points.windows(2) {
        let [from, to] = pair else { unreachable!() };
        assert!(to.time_s > from.time_s && to.time_s.is_finite());
        for (cubic, limits) in cubics(platform, from, to) {
            cubic.check_limits(limits, true);
            for place in cubic.extremes() {
                let out = (limits.min - place).max(place - limits.max);
                assert!(out <= rounding, "{place} is {out} out of its stroke");
            }
        }
        check_distance_error(platform, [from, to], bound, rounding);
    }
    let last = points.last().unwrap();
    assert!(last.velocities.iter().all(|v| v.amax() == 0.0));
    assert!((last.time_s - table.duration_s()).abs() <= TIME * table.duration_s());
}

/// Runs a table with changes of the feed, stops too, to its end.
pub(crate) fn check_run(
    platform: &Platform<3>,
    table: &BodyTable<'_, 3>,
    run: Playback<'_, [[f64; 3]; 3]>,
    max: f64,
    draw: &mut Draw,
) {
    let steady: Vec<_> = {
        let mut run = run.clone();
        run.set_feed(max).unwrap();
        points_of(run)
    };
    assert_eq!(steady.len(), table.len());
    let longest = table.duration_s() / max.min(1.0);
    let time_s = steady.last().unwrap().time_s;
    assert!(
        time_s <= longest * (1.0 + TIME),
        "{time_s} s, not {longest} s at {max}"
    );
    let mut run = run;
    let mut points = Vec::new();
    for _ in 0..draw.count(8.0) {
        let feed = if draw.one_in(3) {
            0.0
        } else {
            max * draw.size(-2.0, 0.0)
        };
        run.set_feed(feed).unwrap();
        let many = usize::try_from(draw.count(30.0)).unwrap();
        points.extend(points_of(run.by_ref().take(many)));
    }
    run.set_feed(max).unwrap();
    points.extend(points_of(run.by_ref()));
    assert!(run.is_finished() && points.len() == table.len());
    for points in [&steady, &points] {
        for pair in points.windows(2) {
            let [from, to] = pair else { unreachable!() };
            assert!(to.segment_s > 0.0 && to.time_s.is_finite());
            for (cubic, limits) in cubics(platform, from, to) {
                cubic.check_limits(limits, false);
            }
        }
        for (point, planned) in points.iter().zip(points_of(table.rows())) {
            assert_eq!(point.axes, planned.axes);
        }
        let last = points.last().unwrap();
        assert!(last.velocities.iter().all(|v| v.amax() == 0.0));
    }
}
