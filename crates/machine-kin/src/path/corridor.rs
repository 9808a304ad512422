//! Corridors: where the inverse is regular beside a path, and beside one segment of it.

use crate::matrix::{Enclosure, larger_or_nan, product};

/// All places within a radius of a curve in each coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Corridor<const N: usize> {
    /// In the unit of length.
    pub(super) radius: f64,
    /// All Jacobians.
    pub(super) enclosure: Enclosure<N>,
}

impl<const N: usize> Corridor<N> {
    /// The most that each coordinate of the tool is off the path by where the axes are by `errors`;
    /// none where that may be more than the corridor is wide.
    ///
    /// Newton's map takes the corridor round each place into itself: there is one such place of the
    /// tool, on the path's branch.
    pub(super) fn off(&self, errors: &[f64; N]) -> Option<[f64; N]> {
        self.off_by(product(self.enclosure.inverse(), errors))
    }

    /// The same by the most that the inverse halfway makes of the errors.
    pub(super) fn off_by(&self, made: [f64; N]) -> Option<[f64; N]> {
        let off = self.enclosure.bounded(made);
        // Written so that NaN is none.
        let is_within = off.iter().all(|off| *off <= self.radius);
        is_within.then_some(off)
    }
}

/// What is known beside a path, or a piece of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beside<const N: usize> {
    /// The corridor of all of it.
    pub(super) corridor: Corridor<N>,
    /// Of each axis, Σ |∂²q/∂x∂y|, up to `widest` in each coordinate.
    bends: [f64; N],
    widest: f64,
}

impl<const N: usize> Beside<N> {
    /// Beside no piece at all.
    pub(super) const NONE: Self = Self {
        corridor: Corridor {
            radius: f64::INFINITY,
            enclosure: Enclosure::NONE,
        },
        bends: [0.0; N],
        widest: f64::INFINITY,
    };

    /// From the Jacobians on a curve, and the second derivatives beside it:
    ///
    /// ```text
    /// Σⱼ |J(P + e) - J(P)|ᵢⱼ ≤ Σⱼₖ |∂²qᵢ/∂xⱼ∂xₖ| max |e|
    /// ```
    pub(super) fn new(on_curve: &Enclosure<N>, bends: [f64; N], widest: f64) -> Option<Self> {
        // Halfway to singular: there axes may be off by the most.
        let most = 0.5 + on_curve.spread() * 0.5;
        let radius = widest.min(on_curve.room(&bends, most));
        let enclosure = on_curve.with_others(&bends.map(|bend| bend * radius))?;
        let corridor = Corridor { radius, enclosure };
        Some(Self {
            corridor,
            bends,
            widest,
        })
    }

    /// The corridor of a part of it, from the Jacobians on that.
    pub(super) fn of_part(&self, on_curve: &Enclosure<N>) -> Option<Corridor<N>> {
        let part = Self::new(on_curve, self.bends, self.widest)?;
        Some(part.corridor)
    }

    /// What is true beside both.
    pub(super) fn and(&self, other: &Self) -> Self {
        let mut bends = self.bends;
        for (bend, other) in bends.iter_mut().zip(other.bends) {
            *bend = larger_or_nan(*bend, other);
        }
        let (a, b) = (&self.corridor, &other.corridor);
        Self {
            corridor: Corridor {
                radius: a.radius.min(b.radius),
                enclosure: a.enclosure.and(&b.enclosure),
            },
            bends,
            widest: self.widest.min(other.widest),
        }
    }
}
