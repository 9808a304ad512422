//! How far the distances between locators depart while the axes run cubics.

use nalgebra::Vector3;
use path_timing::Row;

use crate::Platform;
use crate::distance_error::departure;
use crate::number::sqrt;

/// A bound on how far the distance of any two locators departs from that of their anchors
/// while every axis runs the cubic from one row of a table to the next.
///
/// Proof. The axes are linear in the positions, so the vector D between two locators is a
/// cubic as well, with control points B₀ = D₀, B₁ = D₀ + T D₀'/3, B₂ = D₁ - T D₁'/3,
/// B₃ = D₁. Both ends belong to a rigid motion: |D| = L and D·D' = 0. So |D|² - L² and
/// its derivative are zero at both ends, and with τ = t/T it is
///
/// ```text
/// |D|² - L² = τ² (1-τ)² (3 e₂ (1-τ)² + 2 · 2 e₃ τ (1-τ) + 3 e₄ τ²)
///    e₂ = 2 B₀·B₂ + 3 B₁·B₁ - 5 L²
///    e₃ = (B₀·B₃ + 9 B₁·B₂ - 10 L²) / 2
///    e₄ = 2 B₁·B₃ + 3 B₂·B₂ - 5 L²
/// ```
///
/// τ² (1-τ)² is at most 1/16, and the bracket a mean of 3 e₂, 2 e₃ and 3 e₄. Hence |D|² departs
/// from L² by at most a sixteenth of the largest of them, to either side.
///
/// For a turn by δ about a constant axis across D while the speed changes by the fraction
/// r = (w₁ - w₀)/(w₁ + w₀), that is
///
/// ```text
/// L δ⁴ / 384              at constant speed, r = 0
/// L r² δ² / 32            else, for small δ; L δ² / 32 from rest or to rest
/// ```
///
/// The fourth-order figure alone does not hold where the speed changes.
#[must_use]
pub fn hermite_distance_error<const N: usize>(
    platform: &Platform<N>,
    rows: &[Row<[[f64; 3]; N]>; 2],
) -> f64 {
    let [from, to] = rows;
    // Where each locator is in the world, and how fast.
    let held = |row: &Row<[[f64; 3]; N]>| {
        let mut held = [(Vector3::zeros(), Vector3::zeros()); N];
        let axes = row.position.iter().zip(&row.velocity);
        let locators = platform.locators().iter().zip(axes);
        for ((locator, (axes, velocity)), held) in locators.zip(&mut held) {
            let [axes, velocity] = [*axes, *velocity].map(Vector3::from);
            *held = (locator.position(&axes).coords, locator.axes * velocity);
        }
        held
    };
    let (starts, ends, duration) = (held(from), held(to), to.duration_s);
    let both = || starts.iter().zip(&ends).enumerate();
    let mut worst = 0.0;
    for (number, (start, end)) in both() {
        for (_, (other_start, other_end)) in both().take(number) {
            let from = (start.0 - other_start.0, start.1 - other_start.1);
            let to = (end.0 - other_end.0, end.1 - other_end.1);
            worst = larger_or_nan(worst, pair_distance_error([from, to], duration));
        }
    }
    worst
}

/// The bound for one pair from the vector between them and its derivative at both ends.
fn pair_distance_error(ends: [(Vector3<f64>, Vector3<f64>); 2], duration: f64) -> f64 {
    let [(b0, from), (b3, to)] = ends;
    let third = duration / 3.0;
    // Differences from the ends: B₀·B₀ = L² is taken out before anything is rounded.
    let (first, last) = (from * third, to * third);
    let chord = b3 - b0;
    let square = b0.norm_squared();
    let (b1, b2) = (b0 + first, b3 - last);
    // B₀·B₂ - L² = B₀·(chord - last), and so on.
    let e2 = 2.0 * b0.dot(&(chord - last)) + 3.0 * first.dot(&(b0 * 2.0 + first));
    let e3 = (b0.dot(&chord) + 9.0 * (b1.dot(&b2) - square)) / 2.0;
    let e4 = 2.0 * (b1.dot(&b3) - square) + 3.0 * (b2.norm_squared() - square);
    let length = sqrt(square);
    [3.0 * e2, 2.0 * e3, 3.0 * e4].iter().fold(0.0, |worst, e| {
        larger_or_nan(worst, departure(length, e / 16.0))
    })
}

/// The larger of two numbers; not a number where either is none, unlike `f64::max`.
fn larger_or_nan(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Point3};

    use super::*;
    use crate::leg_axes::LegAxes;
    use crate::{Interpolation, Locator, LocatorAxis, PosePath};

    /// L = 4000 mm across the axis of every turn, which is Z.
    fn flat() -> Platform<3> {
        let limits = LocatorAxis {
            min: -9000.0,
            max: 9000.0,
            speed: 1.0,
            acceleration: 1.0,
            jerk: None,
        };
        let anchors = [[0.0, 0.0, 0.0], [4000.0, 0.0, 0.0], [1800.0, 1500.0, 0.0]];
        Platform::new(
            anchors.map(|anchor| Locator::new(Point3::from(anchor), Point3::origin(), [limits; 3])),
        )
        .unwrap()
    }

    /// A turn by `turn` in which the speed changes by the fraction `change`, and the distance error
    /// at 1000 times of it.
    fn bound_and_measured(turn: f64, change: f64) -> (f64, f64) {
        let platform = flat();
        let poses = [
            Isometry3::identity(),
            Isometry3::new(Vector3::zeros(), Vector3::z() * turn),
        ];
        let path = PosePath::new(&poses, Interpolation::Straight).unwrap();
        let leg_axes = LegAxes::new(&platform, &path.leg(0).unwrap());
        // The mean speed is 1, and so is the time.
        let point = |s, speed| {
            let at = leg_axes.point(s);
            Row {
                time_s: s,
                duration_s: s,
                position: at.axes.map(Into::into),
                velocity: at.slope.map(|slope| <[f64; 3]>::from(slope * speed)),
                leg: 0,
                s,
            }
        };
        let rows = [point(0.0, 1.0 - change), point(1.0, 1.0 + change)];
        let measured = (0..=1000).fold(0.0_f64, |worst, index| {
            let u = f64::from(index) / 1000.0;
            let v = 1.0 - u;
            let at = |row: usize, i: usize| Vector3::from(rows[row].position[i]);
            let speed = |row: usize, i: usize| Vector3::from(rows[row].velocity[i]);
            let axes = core::array::from_fn(|i| {
                at(0, i) * ((1.0 + 2.0 * u) * v * v)
                    + speed(0, i) * (u * v * v)
                    + at(1, i) * (u * u * (3.0 - 2.0 * u))
                    - speed(1, i) * (u * u * v)
            });
            let distance_error = platform.distance_error(&platform.locator_positions(&axes));
            worst.max(distance_error.change.abs())
        });
        (hermite_distance_error(&platform, &rows), measured)
    }

    #[test]
    fn the_bound_holds_and_is_near_for_every_change_of_speed() {
        for turn in [1e-3, 0.01, 0.1, 0.5, 1.0, 2.0] {
            for change in [-1.0, -0.3, -0.01, 0.0, 1e-3, 0.1, 0.5, 1.0] {
                let (bound, measured) = bound_and_measured(turn, change);
                // Coordinates of 4 m are rounded to 1e-12 mm.
                assert!(
                    measured <= bound + 4e-12,
                    "{turn} {change}: {measured} {bound}"
                );
                let near = bound <= 2.0 * measured + 4e-12;
                // Where the two orders nearly cancel, the bound does not.
                let cancels = (0.1..5.0).contains(&(12.0 * change * change / (turn * turn)));
                assert!(near || cancels, "{turn} {change}: {measured} {bound}");
            }
        }
    }

    #[test]
    fn closed_forms_for_small_turns() {
        let length = 4000.0;
        let (bound, measured) = bound_and_measured(0.05, 0.0);
        let fourth = length * 0.05_f64.powi(4) / 384.0;
        assert!(
            (measured / fourth - 1.0).abs() < 1e-3,
            "{measured} {fourth}"
        );
        assert!((bound / fourth - 1.0).abs() < 1e-2, "{bound} {fourth}");
        for change in [0.5, 1.0, -1.0] {
            let (bound, measured) = bound_and_measured(1e-3, change);
            let second = length * (change * 1e-3_f64).powi(2) / 32.0;
            assert!(
                (measured / second - 1.0).abs() < 1e-3,
                "{measured} {second}"
            );
            assert!((bound / second - 1.0).abs() < 1e-2, "{bound} {second}");
        }
    }
}
