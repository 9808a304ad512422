//! The distance error, recomputed from the axes.

use pose_pt::Platform;
use pose_pt::nalgebra::Vector3;

/// The worst change of a distance between two locators.
pub(crate) fn distance_error<const N: usize>(
    platform: &Platform<N>,
    axes: &[Vector3<f64>; N],
) -> f64 {
    platform
        .distance_error(&platform.locator_positions(axes))
        .change
        .abs()
}

/// The largest distance error between points, at 1000 places of each segment: `between` has the
/// axes at a share of it.
pub(crate) fn measured<const N: usize, P>(
    platform: &Platform<N>,
    points: &[P],
    between: impl Fn(&P, &P, f64) -> [Vector3<f64>; N],
) -> f64 {
    let mut worst = 0.0_f64;
    for pair in points.windows(2) {
        for place in 0..=1000 {
            let axes = between(&pair[0], &pair[1], f64::from(place) / 1000.0);
            worst = worst.max(distance_error(platform, &axes));
        }
    }
    worst
}
