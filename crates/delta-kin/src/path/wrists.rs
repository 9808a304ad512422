//! How far the wrists come beside the planes of their arms on a segment, by its ends alone and in
//! single precision: enough where they stay far from what their ball joints let them.
//!
//! Goal: a microcontroller without doubles looks at each segment of a table, and most are nowhere
//! near a limit. Method: what the arms turn in half of the segment moves the platform no farther
//! from its nearer end than E.
//!
//! Proof. Let D be the rods at that end, in shortest lower arms, B the matrix whose rows are D/La,
//! c the columns of its inverse, m the ways of the elbows from there, at most μ = Lb δ where the
//! arms turn by φ, at most δ, and e that of the platform. The rods keep their lengths where
//!
//! ```text
//! B e = n - q    n = D · m / La = l φ + r    l = D · K' / La    |r| ≤ μ δ/2
//!                0 ≤ q = |e - m|² / 2La ≤ (|e| + μ)²/2
//! ```
//!
//! with K' the way of an elbow by its angle. The three φ together are always a mean of their
//! control points, and 0, so that |Σ c l φ| is at most A, the largest of it at one of these; and
//! |Σ c q| is at most C times the largest q, C the longest sum of some of the c. So |e|, which
//! begins at zero and is continuous, stays below the smaller root of
//!
//! ```text
//! E = N + M E + C E²/2    N = A + Σ |c| μ δ/2 + C μ²/2    M = C μ
//! ```
//!
//! with the largest μ. Where Σ |c| (E + μ) < 1 the matrix stays invertible on the way, and the
//! assembly mode the same.

use nalgebra::Vector3;
use path_timing::Cubic;
use trig_kernels::{sin_cos, sqrt};

use crate::Delta;
use crate::arm::zip;
use crate::pose::invert_rods;
use crate::prepared::PreparedArm;

/// Above all rounding of machines of this size in shortest lower arms, angles of so many radians
/// and this C.
const MARGIN: f32 = 0.01;
const LARGEST: f32 = 16.0;
const MAX_INVERSE: f32 = 48.0;

/// The least of (1 - M)² - 2 C N as a part of (1 - M)², of 1 - M and of 1 - Σ |c| (E + μ): nearer
/// to 0 the root has no digits.
const LEAST: f32 = 0.05;

/// One arm at an end of a segment, in single precision and in shortest lower arms.
#[derive(Clone, Copy)]
struct Side {
    /// A row of B.
    rod: Vector3<f32>,
    /// The control points of φ.
    turns: [f32; 3],
    /// δ, and μ: how far the elbow goes in half of the segment, at most.
    turn: f32,
    way: f32,
    /// l
    lever: f32,
    /// From the wrist to the plane of the arm, and the most of that.
    beside: f32,
    max_beside: f32,
}

/// Whether all wrists stay within what their ball joints let them; false where that is not known.
///
/// `places` are those of the platform's centre at the ends, in the machine's frame.
pub(super) fn are_free(delta: &Delta, places: [Vector3<f64>; 2], cubics: &[Cubic; 3]) -> bool {
    let arms = delta.prepared();
    let [l1, l2, l3] = arms.each_ref().map(|prepared| prepared.lower);
    let scale = l1.min(l2).min(l3).recip();
    let forth = cubics.each_ref().map(Cubic::control_points);
    let back = forth.map(|[q0, b1, b2, q1]| [q1, b2, b1, q0]);
    let [start, end] = places;
    [(start, forth), (end, back)]
        .into_iter()
        .all(|(place, angles)| {
            let sides = zip(arms.each_ref(), angles);
            is_free(&sides.map(|(prepared, angle)| Side::new(prepared, scale, &place, &angle)))
        })
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "what is beyond f32 is infinite, and is not known to be free"
)]
const fn single(value: f64) -> f32 {
    value as f32
}

impl Side {
    /// With the control points of the arm's angle from this end on.
    fn new(
        prepared: &PreparedArm<f64>,
        scale: f64,
        place: &Vector3<f64>,
        [from, next, after, to]: &[f64; 4],
    ) -> Self {
        let theta = single(prepared.theta(*from));
        let (sin, cos) = sin_cos(theta);
        let heading = (sin.into(), cos.into());
        let (centre, tangent) = (prepared.centre(heading), prepared.tangent(heading));
        let scaled = |length: f64| single(length * scale);
        let (rod, upper) = ((place - centre).map(scaled), scaled(prepared.upper));
        // The control points of the half that begins here, from where it begins.
        let [next, after, to] = [next, after, to].map(|point| single(point - from));
        let turns = [
            next * 0.5,
            next * 0.5 + after * 0.25,
            (3.0 * (next + after) + to) * 0.125,
        ];
        let largest = [theta, upper, rod.x, rod.y, rod.z].into_iter().chain(turns);
        // NaN is not small.
        let is_small = { largest }.all(|value| value.abs() <= LARGEST);
        let turn = turns.map(f32::abs).into_iter().fold(0.0, f32::max);
        let rod = rod / scaled(prepared.lower);
        let way = if is_small { upper * turn } else { f32::NAN };
        Self {
            rod,
            turns,
            turn,
            way,
            lever: rod.dot(&tangent.map(scaled)),
            beside: scaled(place.dot(&prepared.sideways()).abs()),
            max_beside: scaled(prepared.max_side),
        }
    }
}

fn is_free(sides: &[Side; 3]) -> bool {
    let columns = invert_rods(&sides.map(|side| side.rod));
    let (mut inverse, mut bend, mut beside, mut way) = (0.0, 0.0, 0.0, 0.0_f32);
    let mut moves = [Vector3::zeros(); 3];
    for (column, side) in zip(columns, *sides) {
        for (moved, turn) in moves.iter_mut().zip(side.turns) {
            *moved += column * (side.lever * turn);
        }
        let length = column.norm();
        inverse += length;
        bend += length * side.way * side.turn * 0.5;
        beside += length * side.way;
        way = way.max(side.way);
    }
    let ahead = longest(&moves);
    let [a, b, c] = columns;
    let square = longest(&[a, b, c, a + b, b + c, c + a, a + b + c]);
    let (forth, rest) = (ahead + bend + square * way * way * 0.5, 1.0 - square * way);
    let left = rest * rest - 2.0 * square * forth;
    let farthest = 2.0 * forth / (rest + sqrt(left));
    // Written so that NaN is not known.
    let is_known = inverse <= MAX_INVERSE
        && rest >= LEAST
        && left >= LEAST * rest * rest
        && inverse * farthest + beside <= 1.0 - LEAST;
    let more = farthest * (1.0 + MARGIN) + MARGIN;
    is_known && (sides.iter()).all(|side| side.beside + more <= side.max_beside)
}

fn longest(vectors: &[Vector3<f32>]) -> f32 {
    let squares = vectors.iter().map(Vector3::norm_squared);
    sqrt(squares.fold(0.0, f32::max))
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;
    use proptest::prelude::*;

    use super::*;
    use crate::Dimensions;

    /// Places at which a segment is looked at.
    const PLACES: u32 = 100;

    fn place() -> impl Strategy<Value = [f64; 3]> {
        [-150.0..150.0_f64, -150.0..150.0_f64, -340.0..-150.0_f64]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

        /// Any arms, any cubics between any places: where the wrists are said to be free, they are.
        #[test]
        fn free_wrists_keep_within_their_ball_joints(
            upper in 80.0..150.0_f64, lower in 180.0..300.0_f64, base in 0.0..80.0_f64,
            from in place(), way in [-40.0..40.0_f64, -40.0..40.0_f64, -40.0..40.0_f64], power in -3.0..0.0_f64,
            velocities in [[-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0]],
            more in 0.0..0.2_f64,
        ) {
            let share = 10.0_f64.powf(power);
            let dimensions = Dimensions { base, platform: 18.0, upper, lower };
            let Ok(delta) = Delta::new(dimensions) else { return Ok(()) };
            let ends = [Point3::from(from), Point3::from(from) + Vector3::from(way) * share];
            let [Ok(a), Ok(b)] = ends.map(|end| delta.inverse(end)) else { return Ok(()) };
            let [v0, v1] = velocities.map(|velocity| Vector3::from(velocity) * share);
            let cubics = [0, 1, 2].map(|axis| {
                Cubic { q0: a[axis], q1: b[axis], v0: v0[axis], v1: v1[axis], duration_s: 1.0 }
            });
            let beside = |point: Point3<f64>| -> f64 {
                let sides = delta.prepared().each_ref().map(|arm| arm.sideways().dot(&point.coords).abs());
                sides.into_iter().fold(0.0, f64::max)
            };
            let swivel = (ends.map(beside).into_iter().fold(0.0, f64::max) / lower).asin() + more;
            let Ok(delta) = delta.with_ball_joints(swivel) else { return Ok(()) };
            if !are_free(&delta, ends.map(|end| end.coords), &cubics) {
                return Ok(());
            }
            for number in 0..=PLACES {
                let angles = cubics.map(|cubic| cubic.position(f64::from(number) / f64::from(PLACES)));
                let platform = delta.forward(Vector3::from(angles));
                prop_assert!(platform.is_ok(), "{platform:?}");
                prop_assert!(beside(platform.unwrap()) <= lower * swivel.sin());
            }
        }
    }
}
