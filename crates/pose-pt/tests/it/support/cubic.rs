//! What a controller runs between two points of a PVT table.

use super::table::Point;
use pose_pt::nalgebra::Vector3;

/// Position, speed, acceleration and jerk of one axis at a share of a segment's time.
fn cubic(from: (f64, f64), to: (f64, f64), time: f64, share: f64) -> [f64; 4] {
    let ((q0, v0), (q1, v1)) = (from, to);
    let (u, rest) = (share, 1.0 - share);
    let position = q0 * (1.0 + 2.0 * u) * rest * rest
        + v0 * time * u * rest * rest
        + q1 * u * u * (3.0 - 2.0 * u)
        - v1 * time * u * u * rest;
    let mean = (q1 - q0) / time;
    let speed = 6.0 * mean * u * rest + v0 * rest * (1.0 - 3.0 * u) + v1 * u * (3.0 * u - 2.0);
    let acceleration =
        (6.0 * mean * (1.0 - 2.0 * u) + v0 * (6.0 * u - 4.0) + v1 * (6.0 * u - 2.0)) / time;
    let jerk = (-12.0 * mean + 6.0 * (v0 + v1)) / (time * time);
    [position, speed, acceleration, jerk]
}

/// Position, speed, acceleration and jerk of all axes at a share of a segment's time.
pub(crate) fn between<const N: usize>(
    from: &Point<N>,
    to: &Point<N>,
    share: f64,
) -> [[Vector3<f64>; N]; 4] {
    let mut all = [[Vector3::zeros(); N]; 4];
    for locator in 0..N {
        for axis in 0..3 {
            let end =
                |point: &Point<N>| (point.axes[locator][axis], point.velocities[locator][axis]);
            let values = cubic(end(from), end(to), to.segment_s, share);
            for (all, value) in all.iter_mut().zip(values) {
                all[locator][axis] = value;
            }
        }
    }
    all
}
