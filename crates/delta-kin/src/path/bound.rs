//! How far the platform leaves its curve while the arms run the cubics of a table.

use path_timing::{Cubic, Span};
use trig_kernels::atan2;

use super::passage::{Passage, cubics};
use super::wrists::are_free;
use super::{DeltaPath, DeltaPathError};
use crate::arm::zip;
use crate::range::sqrt;
use crate::{Arm, ArmRange};

/// By how much an arm may pass an end of its range between two rows, in radians: rounding, and a
/// path that touches it.
const RANGE_SLACK: f64 = 1e-9;

impl DeltaPath {
    /// The most by which the platform's centre leaves the curve on a segment of a table, in the
    /// unit of length; infinite where the segment is too long to know. For
    /// [`Table::plan_within`](path_timing::Table::plan_within).
    ///
    /// Proof. Let P(τ) run along the curve as in [`CurveMotion`](path_timing::CurveMotion), K the
    /// centres of the rods' spheres as the arms' cubics have them, D = P - K, and e the platform's
    /// distance from P. With g = |D|² - La², n = g/2La and B the matrix whose rows are D/La, the
    /// rods have their lengths where
    ///
    /// ```text
    /// B e = -(n + q)    |qᵢ| ≤ |e|² / 2La
    /// ```
    ///
    /// At both ends g and g' vanish, so |n| ≤ M τ² (1 - τ)²/24, between nodes τ = k/16 n is linear
    /// but for M/24576, and it is w n(½), w = 16 τ² (1 - τ)², but for F/13416, with
    ///
    /// ```text
    /// g⁗ = 2 (D · D⁗ + 4 D' · D‴ + 3 D" · D")             M ≥ max |g⁗| / 2La
    /// g⁽⁵⁾ = 2 (D · D⁽⁵⁾ + 5 D' · D⁗ + 10 D" · D‴)         F ≥ max |g⁽⁵⁾| / 2La
    /// ```
    ///
    /// from the derivatives of P and K, the first two as they are halfway. B changes by at most β
    /// dτ, β the norm of all |D'|/La; with κ the Frobenius norm of its inverse halfway that of the
    /// inverse is at most κ' = κ / (1 - κ β/2) everywhere. With ν the largest norm of n, e, which
    /// begins at zero and is continuous, stays within
    ///
    /// ```text
    /// E = 2 κ' ν / (1 + √(1 - x))    x = 2 √3 κ'² ν / La ≤ 1
    /// ```
    ///
    /// where B + e/La is invertible, so that the assembly mode stays. At the nodes e is known by
    /// [`forward`](crate::Delta::forward). Between them, put in from both sides, it is linear but
    /// for
    ///
    /// ```text
    /// κ' (M/24576 + β E/32 + √3 E²/La)
    /// ```
    ///
    /// As w |τ - ½| ≤ 0.1432 it is w e(½) but for
    ///
    /// ```text
    /// κ' (F/13416 + 0.1432 β |e(½)| + √3 E²/La)
    /// ```
    ///
    /// which is enough where it is small beside e(½).
    #[must_use]
    pub fn departure(&self, span: &Span<[f64; 3]>) -> f64 {
        let departure = Passage::new(self, span).and_then(|passage| passage.departure());
        departure.unwrap_or(f64::INFINITY)
    }

    /// The most by which the platform's centre leaves the curve where each arm is off its cubic by
    /// at most `off` radians, as a shaped motion is off the motion [`Shaped::delay_s`] earlier by
    /// [`Shaper::departure`]; in the unit of length, infinite where the segment is too long or the
    /// angles are too much to tell.
    ///
    /// Proof. As that of [`departure`](Self::departure), with the centres K moved by ΔK: what is
    /// missing from the rods grows by at most
    ///
    /// ```text
    /// |D · K'| δ / La + |D| Lb δ² / 2La + Lb² δ² / 2La
    /// ```
    ///
    /// and the rows of B change by Lb δ / La. What the inverse of B halfway makes of that is known
    /// for all signs of it.
    ///
    /// [`Shaped::delay_s`]: path_timing::Shaped::delay_s
    /// [`Shaper::departure`]: path_timing::Shaper::departure
    #[must_use]
    pub fn shifted_departure(&self, span: &Span<[f64; 3]>, off: [f64; 3]) -> f64 {
        let shifted = Passage::new(self, span).and_then(|passage| passage.shifted(off));
        shifted.map_or(f64::INFINITY, |farthest| farthest + self.delta.tolerance())
    }

    /// Whether the machine may run a segment: all arms within their ranges, and no rod out of the
    /// plane of its arm by more than its ball joints let it.
    pub(super) fn check_span(&self, span: &Span<[f64; 3]>) -> Result<(), DeltaPathError> {
        let [from, to] = &span.rows;
        let arms = Cubic::between(from, to).zip(self.delta.ranges());
        for ((cubic, range), arm) in arms.zip(Arm::ALL) {
            if let Some(angle) = beyond(range, &cubic) {
                return Err(DeltaPathError::Range {
                    s: span.s,
                    arm,
                    angle,
                    min: range.min(),
                    max: range.max(),
                });
            }
        }
        match self.delta.max_swivel() {
            Some(max) => self.check_wrists(span, max),
            None => Ok(()),
        }
    }

    /// How far a rod is out of the plane of its arm depends on the platform's place alone, which is
    /// known at the nodes of [`departure`](Self::departure) and linear between them but for what it
    /// departs by there and the curve's own bend. Far from the limit, which most segments are, the
    /// ends tell enough.
    #[inline(never)]
    fn check_wrists(&self, span: &Span<[f64; 3]>, max: f64) -> Result<(), DeltaPathError> {
        let (delta, s) = (&self.delta, span.s);
        let cubics = cubics(&span.rows);
        let places = s.map(|s| delta.flip(self.centre(s).coords));
        if are_free(delta, places, &cubics) {
            return Ok(());
        }
        let passage = Passage::new(self, span).ok_or(DeltaPathError::TooCoarse { s })?;
        let is_clear = passage.sides_by_ends().is_some_and(|sides| {
            let arms = zip(delta.prepared().each_ref(), sides);
            arms.iter()
                .all(|(prepared, side)| *side <= prepared.max_side)
        });
        if is_clear {
            return Ok(());
        }
        let sides = passage.sides().ok_or(DeltaPathError::TooCoarse { s })?;
        let arms = zip(delta.prepared().each_ref(), sides);
        for ((prepared, side), arm) in arms.into_iter().zip(Arm::ALL) {
            // Written so that NaN is refused too.
            let is_free = side <= prepared.max_side;
            if !is_free {
                let in_plane = (prepared.lower - side) * (prepared.lower + side);
                let swivel = atan2(side, sqrt(in_plane.max(0.0)));
                return Err(DeltaPathError::BallJoint {
                    s,
                    arm,
                    swivel,
                    max,
                });
            }
        }
        Ok(())
    }
}

/// The angle that is farthest beyond an end of the range, if one is.
fn beyond(range: &ArmRange, cubic: &Cubic) -> Option<f64> {
    let mut points = cubic.control_points().into_iter();
    if points.all(|point| range.min() <= point && point <= range.max()) {
        return None;
    }
    let [low, high] = cubic.extent();
    // Written so that NaN is beyond.
    let (is_above, is_below) = (
        low >= range.min() - RANGE_SLACK,
        high <= range.max() + RANGE_SLACK,
    );
    if is_above && is_below {
        return None;
    }
    let is_lower = range.min() - low > high - range.max();
    Some(if is_lower { low } else { high })
}
