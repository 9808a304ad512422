//! What a PT table promises.

use pose_pt::nalgebra::Vector3;
use pose_pt::{Platform, PosePath, PtTable};

use crate::random_plans::scene::Scene;

/// Positions in a segment at which the distance error is looked at.
const POSITIONS: u32 = 8;

/// Largest number of points that are looked at.
const MAX_POINTS: usize = 2000;

/// What positions, and times that are sums of many, round off.
const ROUNDING: f64 = 64.0;

/// Whether there is a table; if so it is within all limits.
pub(crate) fn check_linear(scene: &Scene) -> bool {
    let Ok(platform) = Platform::new(scene.locators) else {
        return false;
    };
    let Ok(path) = PosePath::new(&scene.poses, scene.kind) else {
        return false;
    };
    let table = match PtTable::plan(&platform, &path, scene.segmentation) {
        Ok(table) if table.len() <= MAX_POINTS => table,
        _ => return false,
    };
    let epsilons = f64::EPSILON * ROUNDING;
    let points: Vec<_> = table.points().collect();
    assert_eq!(points.len(), table.len());
    let lengths = platform
        .locators()
        .iter()
        .map(|locator| locator.origin.coords.amax() + locator.anchor.coords.amax());
    let axes = points
        .iter()
        .flat_map(|point| point.axes.map(|axes| axes.amax()));
    let size = lengths.chain(axes).fold(0.0, f64::max);
    let rounding = epsilons * size;
    let bound = table.distance_error_bound();
    if let Some(allowed) = scene.allowed() {
        assert!(
            bound <= allowed + rounding,
            "bound {bound}, allowed {allowed}"
        );
    }
    for pair in points.windows(2) {
        let [from, to] = pair else { unreachable!() };
        assert!(to.time_s > from.time_s && to.time_s.is_finite());
        for (index, locator) in platform.locators().iter().enumerate() {
            for (axis, limits) in locator.limits.iter().enumerate() {
                let place = to.axes[index][axis];
                let out = (limits.min - place).max(place - limits.max);
                assert!(out <= rounding, "{place} is {out} out of its stroke");
                let travel = (place - from.axes[index][axis]).abs();
                let speed = travel / to.segment_s;
                assert!(speed <= limits.speed * (1.0 + epsilons), "speed {speed}");
            }
        }
        for place in 0..=POSITIONS {
            let fraction = f64::from(place) / f64::from(POSITIONS);
            let mut axes = from.axes;
            for (axes, to) in axes.iter_mut().zip(&to.axes) {
                let change: Vector3<f64> = to - *axes;
                *axes += change * fraction;
            }
            let distance_error = platform
                .distance_error(&platform.locator_positions(&axes))
                .change;
            assert!(
                distance_error.abs() <= bound + rounding,
                "distance error {distance_error}, bound {bound}"
            );
        }
    }
    let last = points.last().unwrap().time_s;
    assert!((last - table.duration_s()).abs() <= epsilons * last);
    true
}
