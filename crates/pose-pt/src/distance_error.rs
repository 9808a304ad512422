//! How far the distances between locators depart from those of their anchors between points.

use nalgebra::Vector3;

use crate::Platform;
use crate::number::sqrt;
use crate::path::Leg;
use crate::path::leg::Shape;

/// Two locators.
pub(crate) struct Pair {
    /// Their distance.
    pub(crate) length: f64,
    /// Its component perpendicular to the axis of the turn; all of it where the axis is not
    /// constant.
    pub(crate) across: f64,
}

/// All pairs of locators on a leg.
pub(crate) fn pairs<const N: usize>(
    platform: &Platform<N>,
    leg: &Leg,
) -> impl Iterator<Item = Pair> {
    let anchors = *platform.anchors();
    let turning = match leg.shape {
        Shape::Turning(leg) => Some((leg.axis, leg.rotation)),
        Shape::Vector(_) => None,
    };
    numbers::<N>().filter_map(move |(first, second)| {
        let apart = anchors.get(first)? - anchors.get(second)?;
        let length = apart.norm();
        let across = match turning {
            Some((axis, rotation)) => axis.cross(&(rotation * apart)).norm(),
            None => length,
        };
        Some(Pair { length, across })
    })
}

/// The numbers of all pairs of `N` locators.
fn numbers<const N: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..N).flat_map(|first| (first + 1..N).map(move |second| (first, second)))
}

/// By how much a distance shrinks at most while the axes move linearly from one point to the
/// next: at half way |D|² is L² less a quarter of |D₁ - D₀|².
pub(crate) fn linear_distance_error<const N: usize>(
    platform: &Platform<N>,
    from: &[Vector3<f64>; N],
    to: &[Vector3<f64>; N],
) -> f64 {
    let ends = [from, to].map(|axes| platform.locator_positions(axes));
    numbers::<N>().fold(0.0, |worst, (first, second)| {
        let [from, to] = ends
            .each_ref()
            .map(|points| Some(points.get(first)? - points.get(second)?));
        match (from, to) {
            (Some(from), Some(to)) => {
                let lost = (to - from).norm_squared() * 0.25;
                worst.max(departure(from.norm(), -lost))
            }
            _ => worst,
        }
    })
}

/// |√(L² + change) - L|, without cancellation; L where the square would be negative.
pub(crate) fn departure(length: f64, change: f64) -> f64 {
    let square = length * length + change;
    if square <= 0.0 {
        return length;
    }
    change.abs() / (length + sqrt(square))
}
