//! Assembly modes: whether the platform is at the lower or the higher of its two points.

use nalgebra::{RealField, Vector3};
use trig_kernels::Trig;

use crate::arm::zip;
use crate::prepared::PreparedArm;
use crate::range::{half, norm, two};
use crate::{AssemblyMode, Delta, ElbowSide, InverseError, ZAxis};

/// The platform above the plane of the spheres' centres.
struct Tripod<T> {
    /// Perpendicular to the plane, twice the area of the centres' triangle long.
    normal: Vector3<T>,
    /// Square of a side of the triangle, not much shorter than the longest.
    side2: T,
    /// The platform's distance from the plane times the normal's length.
    volume: T,
}

impl<T: RealField + Trig> Tripod<T> {
    /// From the rods, each from its centre to the platform.
    #[inline(always)]
    fn new([first, second, third]: [Vector3<T>; 3]) -> Self {
        let (d2, d3) = (first - second, first - third);
        let normal = d2.cross(&d3);
        Self {
            normal,
            side2: d2.norm_squared().max(d3.norm_squared()),
            volume: first.dot(&normal),
        }
    }

    /// Whether a triangle of twice this area is higher than twice what rounding makes of a line.
    fn is_plane(&self, area2: T, tolerance: T) -> bool {
        let height = tolerance * two();
        area2 > self.side2 * (height * height)
    }
}

impl<T: RealField + Trig> Delta<T> {
    /// Whether the rods, each from its centre to the platform, are clearly in the machine's
    /// assembly mode: so far that neither the triangle nor what is seen of it from above is a line.
    ///
    /// The platform is above the plane by volume/|n|, and is the higher of its two points if that
    /// has the sign of `n_z`. With centres within C, |n| is at most 4 C² and the volume La times
    /// it, so that one bound on their product holds each off rounding:
    ///
    /// ```text
    /// |volume n_z| > 16 tolerance C³ (C + La)   =>   |n_z| > 4 tolerance C,
    ///                                               |volume| > 4 tolerance C (C + La)
    /// ```
    #[inline(always)]
    pub(crate) fn is_assembled(&self, rods: [Vector3<T>; 3]) -> bool {
        let tripod = Tripod::new(rods);
        tripod.volume * tripod.normal.z * self.side() > self.min_product()
    }

    /// Whether `forward` of these angles is the platform's position, or why it is not.
    ///
    /// A point as far beyond the singular surface as a change of the rods' lengths by a quarter
    /// of the [`tolerance`](Self::tolerance), the rounding of `forward` and `inverse` together,
    /// moves it counts as on it:
    ///
    /// ```text
    /// La - √(La² - d²) = d²/(2 La) ≤ tolerance/4
    /// ```
    pub(crate) fn check_assembly(
        &self,
        local: &Vector3<T>,
        thetas: [T; 3],
    ) -> Result<(), InverseError<T>> {
        let centres = self.centres_at(thetas);
        let tripod = Tripod::new(centres.map(|centre| local - centre));
        let (normal, up) = (tripod.normal, tripod.normal.z);
        if !tripod.is_plane(normal.norm_squared(), self.tolerance()) {
            return Err(InverseError::Collinear);
        }
        if !tripod.is_plane(up * up, self.tolerance()) {
            return Err(InverseError::Upright);
        }
        let beyond = -tripod.volume * up.signum() * self.side() / norm(&normal);
        let [l1, l2, l3] = self.prepared().each_ref().map(|prepared| prepared.lower);
        let rounding = l1.min(l2).min(l3) * self.tolerance() * half();
        if beyond <= T::zero() || beyond * beyond <= rounding {
            return Ok(());
        }
        let assembly_mode = self.assembly_mode().other();
        let z = self.other_z(local);
        Err(InverseError::OtherAssembly { assembly_mode, z })
    }

    /// The other direction of z, where a point on the far side of the base plane would be in the
    /// machine's modes with it.
    pub(crate) fn other_z(&self, local: &Vector3<T>) -> Option<ZAxis> {
        let is_across = match self.assembly_mode() {
            AssemblyMode::Lower => local.z > T::zero(),
            AssemblyMode::Upper => local.z < T::zero(),
        };
        let mirrored = Vector3::new(local.x, local.y, -local.z);
        let rods = zip(self.prepared().each_ref(), self.working_mode())
            .map(|(prepared, elbow)| rod_at_edge(prepared, &mirrored, elbow));
        (is_across && self.is_assembled(rods)).then(|| match self.z() {
            ZAxis::Up => ZAxis::Down,
            ZAxis::Down => ZAxis::Up,
        })
    }
}

/// Sides of a triangle as it is seen from above, each opposite its corner, and twice its area.
pub(crate) fn from_above<T: RealField + Trig>([c1, c2, c3]: [Vector3<T>; 3]) -> ([T; 3], T) {
    let sides = [c3 - c2, c1 - c3, c2 - c1].map(|side| side.xy());
    let [_, d3, d2] = &sides;
    (sides.each_ref().map(norm), d2.perp(d3).abs())
}

/// Once for all arms, out of line: what is rare should be small.
#[inline(never)]
fn rod_at_edge<T: RealField + Trig>(
    prepared: &PreparedArm<T>,
    point: &Vector3<T>,
    elbow: ElbowSide,
) -> Vector3<T> {
    let triangle = prepared.triangle(point).at_edge();
    prepared.rod(&triangle, &triangle.heading(elbow), triangle.scale())
}
