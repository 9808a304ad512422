//! Strain, recomputed from the axes.

use pose_pt::Platform;
use pose_pt::nalgebra::Vector3;

/// The worst change of a distance between two locators.
pub(crate) fn strain<const N: usize>(platform: &Platform<N>, axes: &[Vector3<f64>; N]) -> f64 {
    platform
        .strain(&platform.locator_positions(axes))
        .change
        .abs()
}
