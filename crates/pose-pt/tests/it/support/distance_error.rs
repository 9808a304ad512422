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
