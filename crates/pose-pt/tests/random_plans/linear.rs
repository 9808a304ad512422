//! What a PT table promises, in both float types.

use pose_pt::nalgebra::{RealField, Vector3};
use pose_pt::{Path, Platform, PtTable};

use crate::scene::Scene;

/// Places of a segment at which the distance error is looked at.
const PLACES: u32 = 8;

/// Most points that are looked at.
const MOST: usize = 2000;

/// What positions, and times that are sums of many, round off.
const ROUNDING: f64 = 64.0;

/// Whether there is a table; if so it is within all limits.
pub(crate) fn check_linear<T: RealField + Copy + core::fmt::LowerExp>(scene: &Scene<T>) -> bool {
    let Ok(platform) = Platform::new(scene.locators) else {
        return false;
    };
    let Ok(path) = Path::new(&scene.poses, scene.kind) else {
        return false;
    };
    let table = match PtTable::plan(&platform, &path, scene.segmentation) {
        Ok(table) if table.len() <= MOST => table,
        _ => return false,
    };
    let epsilons = T::default_epsilon() * number(ROUNDING);
    let points: Vec<_> = table.points().collect();
    assert_eq!(points.len(), table.len());
    let lengths = platform
        .locators()
        .iter()
        .map(|locator| locator.origin.coords.amax() + locator.anchor.coords.amax());
    let axes = points
        .iter()
        .flat_map(|point| point.axes.map(|axes| axes.amax()));
    let size = lengths.chain(axes).fold(T::zero(), |a, b| a.max(b));
    let rounding = epsilons * size;
    let bound = table.distance_error_bound();
    if let Some(allowed) = scene.allowed {
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
                let way = (place - from.axes[index][axis]).abs();
                let speed = way / to.segment_s;
                assert!(
                    speed <= limits.speed * (T::one() + epsilons),
                    "speed {speed}"
                );
            }
        }
        for place in 0..=PLACES {
            let share: T = number(f64::from(place) / f64::from(PLACES));
            let mut axes = from.axes;
            for (axes, to) in axes.iter_mut().zip(&to.axes) {
                let way: Vector3<T> = to - *axes;
                *axes += way * share;
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

fn number<T: RealField>(value: f64) -> T {
    T::from_subset(&value)
}
