//! How far a straight joint move can leave the straight line between its ends.

use nalgebra::RealField;
use trig_kernels::{Trig, sin_cos};

use crate::limits::two;
use crate::{Arm, Joints};

impl<T: RealField + Trig> Arm<T> {
    /// A bound on how far the tool leaves the straight line between two poses while both
    /// joints move linearly from one to the other, in the unit of length.
    ///
    /// Proof. Let the shoulder move by a and the forearm, in the base's frame, by
    /// b = a + δ2. Both links turn at constant rates over t = 0..=1, so that
    ///
    /// ```text
    /// p" = -w,   w = upper a² + fore b²,   w' = ẑ × (upper a³ + fore b³)
    /// |upper p + fore q|² = ((l1 p + l2 q) cos(q2/2))² + ((l1 p - l2 q) sin(q2/2))²
    /// ```
    ///
    /// The last is monotonic in q2 from one pose straight or folded to the next, so
    /// that M = max |w| and N = max |w'| are found at the ends of the move.
    ///
    /// A function departs from the straight line between its ends by at most an eighth
    /// of its largest second derivative: M/8, at each time t on its own.
    ///
    /// Across the line only the component of w along its normal n counts, which is at most
    /// |n · w(½)| + N/2. Along the line the speed departs from its mean, the distance c
    /// between the ends, by at most M/2; where M ≤ 2c the tool never turns back, each
    /// point of the path has its foot on the line, and each point of the line is such a foot. Hence
    ///
    /// ```text
    /// bound = min(M, |n · w(½)| + N/2) / 8   where M ≤ 2c,   M/8 elsewhere
    /// ```
    ///
    /// For short steps this is the true departure to first order.
    #[must_use]
    pub fn chord_bound(&self, from: Joints<T>, to: Joints<T>) -> T {
        let turns = Turns::new(from, to);
        let (a, b) = (turns.upper, turns.fore);
        let largest = turns.longest(self, a * a, b * b);
        let chord = self.tip(to) - self.tip(from);
        let length = chord.norm();
        let eighth = nalgebra::convert(0.125);
        if length == T::zero() || largest > length * two() {
            return largest * eighth;
        }
        let middle = Joints::new(
            from.shoulder + a / two(),
            from.elbow + (to.elbow - from.elbow) / two(),
        );
        let links = self.links(middle);
        let w = links.upper * (a * a) + links.fore * (b * b);
        let across = (chord.perp(&w) / length).abs();
        let drift = turns.longest(self, a * a * a, b * b * b);
        largest.min(across + drift / two()) * eighth
    }
}

/// A joint move as each link sees it.
struct Turns<T> {
    /// Turn of the upper arm in the base's frame.
    upper: T,
    /// Turn of the forearm in the base's frame.
    fore: T,
    /// Sine and cosine of half the elbow angle at both ends of the move.
    halves: [(T, T); 2],
    /// Whether the arm may be straight or folded between the ends.
    is_singular: bool,
}

impl<T: RealField + Trig> Turns<T> {
    fn new(from: Joints<T>, to: Joints<T>) -> Self {
        let change = to - from;
        let halves = [from, to].map(|joints| sin_cos(joints.elbow / two()));
        // Half the sines of the elbow angles.
        let [from, to] = halves.map(|(sin, cos)| sin * cos);
        let changes_sign = from.min(to) < T::zero() && from.max(to) > T::zero();
        Self {
            upper: change.x,
            fore: change.x + change.y,
            halves,
            is_singular: changes_sign || change.y.abs() >= T::pi(),
        }
    }

    /// The largest length of upper · p + fore · q during the move.
    fn longest(&self, arm: &Arm<T>, p: T, q: T) -> T {
        let stretched = (arm.upper() * p + arm.fore() * q).abs();
        let folded = (arm.upper() * p - arm.fore() * q).abs();
        if self.is_singular {
            return stretched.max(folded);
        }
        let [from, to] = self
            .halves
            .map(|(sin, cos)| (stretched * cos).hypot(folded * sin));
        from.max(to)
    }
}
