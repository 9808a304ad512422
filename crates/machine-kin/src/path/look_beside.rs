//! Looking beside a path, and beside one segment of it, for where the inverse is regular.

use path_timing::CurveMotion;

use super::MachinePath;
use super::corridor::{Beside, Corridor};
use super::stretch::Stretch;
use crate::matrix::{Bounded, Enclosure, Matrix, inverse, largest};
use crate::{Gradient, Machine};

/// How far beside the path is looked, in each coordinate and as a part of the path's size: less far
/// where that is too near to a singular pose.
const RADII: [f64; 4] = [1.0 / 128.0, 1.0 / 512.0, 1.0 / 2048.0, 1.0 / 8192.0];

/// How far Jacobians on a piece of a path may be from that in its middle, as a part of itself.
const ON_CURVE: f64 = 0.25;

/// Corridors narrower than this part of what was looked at are looked at again: less is known of wide
/// ones.
const NARROW: f64 = 0.25;

/// Coefficients of the Taylor models of second derivatives.
const MODEL: usize = 3;

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    /// What is known beside a piece of a path of this size; none where something there cannot be
    /// reached, or is singular, or may be, or the piece is too long to say.
    pub(super) fn look_beside(&self, piece: &Stretch<N>, size: f64) -> Option<Beside<N>> {
        let (on_curve, _) = self.on_curve(piece)?;
        if on_curve.spread() > ON_CURVE {
            return None;
        }
        RADII.iter().find_map(|share| {
            let widest = size * share;
            let found = Beside::new(&on_curve, self.bends(piece, widest)?, widest)?;
            (found.corridor.radius >= widest * NARROW).then_some(found)
        })
    }

    /// What is known beside the path, if the motion stays on it: what turns back may leave it at its
    /// ends.
    pub(super) fn beside_of(&self, motion: &CurveMotion<'_, N>) -> Option<&Beside<N>> {
        self.beside.as_ref().filter(|_| motion.goes_forward())
    }

    /// Corridors of one segment whose axes are off by so much: by what is known beside all of the
    /// path, and by a look at the segment alone; and about the inverse of the Jacobian halfway.
    pub(super) fn corridors(
        &self,
        beside: Option<&Beside<N>>,
        segment: &Stretch<N>,
        errors: &[f64; N],
    ) -> Option<(impl Iterator<Item = Corridor<N>>, Matrix<N>)> {
        let (on_curve, y) = self.on_curve(segment)?;
        let of_path = beside.and_then(|path| path.of_part(&on_curve));
        let radius = largest(&on_curve.off(errors)) * 2.0 + self.rounding;
        let own = core::iter::once_with(move || {
            let around = self.around(segment, &[radius; N]).ok()?;
            let enclosure = Enclosure::by(&y, around.jacobian())?;
            Some(Corridor { radius, enclosure })
        });
        Some((of_path.into_iter().chain(own.flatten()), y))
    }

    /// All Jacobians on the curve itself, and about the inverse of that halfway.
    fn on_curve(&self, piece: &Stretch<N>) -> Option<(Enclosure<N>, Matrix<N>)> {
        let around = self.around(piece, &[0.0; N]).ok()?;
        let y = inverse(around.at(0.0))?;
        Some((Enclosure::by(&y, around.jacobian())?, y))
    }

    /// Of each axis, Σ |∂²q/∂x∂y| within a radius of a piece at most.
    fn bends(&self, piece: &Stretch<N>, radius: f64) -> Option<[f64; N]> {
        let places = piece.models::<MODEL>(&[radius; N]);
        let beside = Gradient::variables(Gradient::variables(places));
        let beside = self.machine.inverse(beside, self.branch).ok()?;
        let bends = beside.map(|axis| {
            let bends = axis.slopes().iter().flat_map(Gradient::slopes);
            bends.map(Bounded::most).sum::<f64>()
        });
        let is_known = bends.iter().all(|bend| bend.is_finite());
        is_known.then_some(bends)
    }
}
