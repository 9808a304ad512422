//! How far the distances between locators depart from those of their anchors between points.

use nalgebra::{RealField, Vector3};

use crate::path::Leg;
use crate::path::leg::Shape;
use crate::{Platform, PvtPoint};

/// Two locators.
pub(crate) struct Pair<T> {
    /// Their distance.
    pub(crate) length: T,
    /// Its part across the axis of the turn; all of it where the axis is not constant.
    pub(crate) across: T,
}

/// All pairs of locators on a leg.
pub(crate) fn pairs<const N: usize, T: RealField + Copy>(
    platform: &Platform<N, T>,
    leg: &Leg<T>,
) -> impl Iterator<Item = Pair<T>> {
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

/// By how much the distances shrink at most while the axes move linearly and the body would
/// turn by `turn`: at half way both ends of the chord are as near to the axis as
/// `across` cos(turn / 2).
pub(crate) fn linear_strain<const N: usize, T: RealField + Copy>(
    platform: &Platform<N, T>,
    leg: &Leg<T>,
    turn: T,
) -> T {
    let sine = (turn.min(T::pi()) * crate::number::half()).sin();
    pairs(platform, leg).fold(T::zero(), |worst, pair| {
        let lost = (pair.across * sine).powi(2);
        worst.max(departure(pair.length, -lost))
    })
}

/// |√(L² + change) - L|, without cancellation; L where the square would be negative.
fn departure<T: RealField + Copy>(length: T, change: T) -> T {
    let square = (length * length + change).max(T::zero());
    (change / (length + square.sqrt())).abs().min(if change < T::zero() {
        length
    } else {
        change.abs()
    })
}

/// The most by which the distance of any two locators departs from that of their anchors
/// while every axis runs the cubic from one point of a PVT table to the next.
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
/// For a turn by δ about a constant axis across D while the speed changes by the share
/// r = (w₁ - w₀)/(w₁ + w₀), that is
///
/// ```text
/// L δ⁴ / 384              at constant speed, r = 0
/// L r² δ² / 32            else, for small δ; L δ² / 32 from rest or to rest
/// ```
///
/// The fourth-order figure alone does not hold where the speed changes.
#[must_use]
pub fn hermite_strain<const N: usize, T: RealField + Copy>(
    platform: &Platform<N, T>,
    from: &PvtPoint<N, T>,
    to: &PvtPoint<N, T>,
) -> T {
    let duration = to.segment_s;
    let ends = [from, to].map(|point| {
        let turned = |vectors: &[Vector3<T>; N]| {
            let mut world = *vectors;
            for (locator, vector) in platform.locators().iter().zip(&mut world) {
                *vector = locator.axes * *vector;
            }
            world
        };
        let positions = platform
            .locator_positions(&point.axes)
            .map(|position| position.coords);
        (positions, turned(&point.velocities))
    });
    numbers::<N>().fold(T::zero(), |worst, (first, second)| {
        let vectors = ends.each_ref().map(|(positions, velocities)| {
            let apart = |all: &[Vector3<T>; N]| Some(all.get(first)? - all.get(second)?);
            apart(positions)
                .zip(apart(velocities))
                .unwrap_or((Vector3::zeros(), Vector3::zeros()))
        });
        worst.max(pair_strain(&vectors, duration))
    })
}

/// The bound for one pair from the vector between them and its derivative at both ends.
fn pair_strain<T: RealField + Copy>(ends: &[(Vector3<T>, Vector3<T>); 2], duration: T) -> T {
    let constant = |value: f64| nalgebra::convert::<f64, T>(value);
    let [(b0, from), (b3, to)] = *ends;
    let third = duration / constant(3.0);
    // Differences from the ends: B₀·B₀ = L² is taken out before anything is rounded.
    let (first, last) = (from * third, to * third);
    let chord = b3 - b0;
    let square = b0.norm_squared();
    let (b1, b2) = (b0 + first, b3 - last);
    let (two, three, nine) = (constant(2.0), constant(3.0), constant(9.0));
    // B₀·B₂ - L² = B₀·(chord - last), and so on.
    let e2 = two * b0.dot(&(chord - last)) + three * first.dot(&(b0 * two + first));
    let e3 = (b0.dot(&chord) + nine * (b1.dot(&b2) - square)) / two;
    let e4 = two * (b1.dot(&b3) - square) + three * (b2.norm_squared() - square);
    let low = (three * e2).min(two * e3).min(three * e4).min(T::zero());
    let high = (three * e2).max(two * e3).max(three * e4).max(T::zero());
    let sixteenth = constant(1.0 / 16.0);
    let length = square.sqrt();
    departure(length, low * sixteenth).max(departure(length, high * sixteenth))
}
