//! How far the platform can leave the straight line between two poses while the arms turn linearly.

use nalgebra::{Point3, RealField, Vector3};
use trig_kernels::{Trig, sin_cos};

use crate::arm::zip;
use crate::assembly::from_above;
use crate::pose::{invert_rods, smallest_sine};
use crate::prepared::PreparedArm;
use crate::range::{half, two};
use crate::{Delta, Pose};

/// One arm during a move of unit time.
struct Swing<T> {
    /// Unit vector along the rods, halfway.
    rod: Vector3<T>,
    /// Largest amount by which the rod would have to be longer or shorter on the line.
    miss: T,
    /// Largest amount by which the rod's direction differs from that halfway.
    turn: T,
    /// Where the centre of the rod's sphere is halfway, and the most by which it is elsewhere.
    centre: Vector3<T>,
    moves: T,
}

impl<T: RealField + Trig> Delta<T> {
    /// A bound on how far the platform leaves the straight line between two poses of this machine
    /// while all arms turn linearly from one to the other, in the unit of length; `None` where
    /// the move is too long to know, or a pose is another machine's. The platform stays in its
    /// assembly mode throughout.
    ///
    /// Proof. Let the platform be on the line, P(s) = P0 + s V over s = 0..=1, and the elbows where
    /// the arms have them, C(s), so that |C'| = Lb |ω|, |C"| = Lb ω², |C‴| = Lb |ω|³. The square
    /// of a rod's length there, g(s) = |P - C|², is right at both ends and departs between them
    /// from La² by at most an eighth of its largest second derivative
    ///
    /// ```text
    /// g" = 2 |V - C'|² - 2 (P - C) · C"
    /// G  = |g"(½)| + 3 a b + l c   with a = |V - C'(½)| + b/2 ≥ |V - C'|,  b = Lb ω²,  c = Lb |ω|³,
    ///                                   l = |P - C|(½) + a/2 ≥ |P - C|
    /// ```
    ///
    /// so that the rod misses its length by at most ε = G / (8 La), and by the
    /// [`tolerance`](Self::tolerance) that is left for rounding. The platform itself is where
    /// all three rods have their lengths. Let A be the matrix of the rods' unit vectors, κ the
    /// Frobenius norm of its inverse halfway, η that of the change of A from there, so that
    /// |A⁻¹| ≤ κ' = κ / (1 - κ η) all along the line. Within δ ≤ La/2 - ε of P(s) the lengths
    /// depart from linear by at most δ²/La each, and Newton's map takes the ball of radius
    ///
    /// ```text
    /// δ = 2 κ' e / (1 + √(1 - x)),   x = 4 √3 κ'² e / La,   e = √(ε1² + ε2² + ε3²)
    /// ```
    ///
    /// into itself and contracts there if x ≤ 1: it holds one point where all rods have
    /// their lengths. That point moves continuously from one pose to the other, so it is the
    /// platform, and δ is the bound. A is invertible in the whole ball, so its determinant keeps
    /// its sign, which is the assembly mode. For short steps δ is the true departure times at
    /// most κ. The triangle of the elbows, as seen from above, keeps its area from 0, as in
    /// [`clearance`](Self::clearance).
    #[must_use]
    pub fn chord_bound(&self, from: &Pose<T>, to: &Pose<T>) -> Option<T> {
        for pose in [from, to] {
            let local = self.flip(pose.point().coords);
            let prepared = zip(self.prepared().each_ref(), self.thetas(pose.angles()));
            for (prepared, theta) in prepared {
                // Written so that NaN is refused too.
                let is_met = prepared.stretch(&local, theta).abs() <= self.tolerance();
                if !is_met {
                    return None;
                }
            }
        }
        self.bound((from.angles(), from.point()), (to.angles(), to.point()))
    }

    pub(super) fn bound(
        &self,
        from: (Vector3<T>, Point3<T>),
        to: (Vector3<T>, Point3<T>),
    ) -> Option<T> {
        let (start, velocity) = (
            self.flip(from.1.coords),
            self.flip(to.1.coords - from.1.coords),
        );
        let halfway = start + velocity * half::<T>();
        let thetas = zip(self.thetas(from.0), self.thetas(to.0));
        let [first, second, third] = zip(self.prepared().each_ref(), thetas);
        let rounding = self.tolerance();
        let swing =
            |(prepared, thetas)| Swing::new(prepared, thetas, &halfway, &velocity, rounding);
        let swings = [swing(first)?, swing(second)?, swing(third)?];
        let ([s1, s2, s3], area2) = from_above(swings.each_ref().map(|swing| swing.centre));
        let [m1, m2, m3] = swings.each_ref().map(|swing| swing.moves);
        if m1 * (s1 + m2) + m2 * (s2 + m3) + m3 * (s3 + m1) >= area2 {
            return None;
        }

        let rods = swings.each_ref().map(|swing| swing.rod);
        // Nearer to a parallel singularity half the digits of κ would be lost.
        if smallest_sine(&rods) <= T::default_epsilon().sqrt() {
            return None;
        }
        let [a, b, c] = invert_rods(&rods);
        let kappa = (a.norm_squared() + b.norm_squared() + c.norm_squared()).sqrt();
        let eta = Vector3::from(swings.each_ref().map(|swing| swing.turn)).norm();
        let misses = Vector3::from(swings.each_ref().map(|swing| swing.miss));
        let e = misses.norm();
        let rest = T::one() - kappa * eta;
        if rest <= T::zero() {
            return None;
        }
        let kappa = kappa / rest;
        let [l1, l2, l3] = self.prepared().each_ref().map(|prepared| prepared.lower);
        let lower = l1.min(l2).min(l3);
        let root3: T = nalgebra::convert(1.732_050_807_568_877_4); // √3, upwards
        let x = two::<T>() * two() * root3 * kappa * kappa * e / lower;
        if x > T::one() {
            return None;
        }
        let delta = two::<T>() * kappa * e / (T::one() + (T::one() - x).sqrt());
        (delta + misses.max() <= lower * half()).then_some(delta)
    }
}

impl<T: RealField + Trig> Swing<T> {
    fn new(
        prepared: &PreparedArm<T>,
        (from, to): (T, T),
        halfway: &Vector3<T>,
        velocity: &Vector3<T>,
        rounding: T,
    ) -> Option<Self> {
        let rate = to - from;
        let theta = from + rate * half();
        let theta = sin_cos(theta);
        let centre = prepared.centre(theta);
        let rod = halfway - centre;
        let length = rod.norm();
        let relative = velocity - prepared.tangent(theta) * rate;
        let inward = prepared.spoke(theta) * (-rate * rate);
        let b = prepared.upper * rate * rate;
        let c = b * rate.abs();
        let a = relative.norm() + b * half();
        let l = length + a * half();
        let curved = two::<T>() * (relative.norm_squared() - rod.dot(&inward)).abs();
        let largest = curved + (two::<T>() + T::one()) * a * b + l * c;
        // Between unit vectors: twice the distance over the sum of the lengths, which is at least
        // 2 |P - C|(½) less the distance.
        let distance = a * half();
        let sum = length + (length - distance);
        (sum > T::zero()).then(|| Self {
            rod: rod / length,
            miss: largest / (prepared.lower * nalgebra::convert(8.0)) + rounding,
            turn: two::<T>() * distance / sum,
            centre,
            moves: prepared.upper * rate.abs() * half(),
        })
    }
}
