//! One arm with all that follows from its geometry, in the frame of [Delta thesis].

use nalgebra::{RealField, Vector2, Vector3};
use trig_kernels::{Trig, atan2_of_length, atan2_of_length_lanes, sin_cos, sqrt};

use crate::range::{half, length, max_value, norm, two};
use crate::{ArmGeometry, ArmRange, ElbowSide, Positive};

/// An arm ready for use. Angles named `theta` are the thesis', `angle` is what is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PreparedArm<T> {
    cos: T,
    sin: T,
    /// R - r.
    offset: T,
    pub(crate) upper: T,
    /// 1 / Lb
    per_upper: T,
    pub(crate) lower: T,
    zero: T,
    /// 1 where angles grow outward, else -1.
    pub(crate) turn: T,
    /// Smallest and largest angle as it reads.
    pub(crate) min: T,
    pub(crate) max: T,
    /// The lower end as theta.
    pub(crate) low: T,
    pub(crate) high: T,
    /// How far the wrist may lie off the arm's plane.
    pub(crate) max_side: T,
}

/// The shoulder, the wrist and what lies between, as seen perpendicular to the arm's plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle<T> {
    /// From the wrist inward to the shoulder.
    pub(crate) inward: T,
    pub(crate) z: T,
    /// Distance of the wrist from the arm's plane.
    pub(crate) side: T,
    /// h², the square of the distance between shoulder and wrist in the plane.
    pub(crate) h2: T,
    /// La² - w² - Lb² - h²: twice the product of Lb, h and the cosine of the upper arm's angle from
    /// the line to the wrist, reversed.
    along: T,
    /// The square of twice the product of Lb, h and the sine: negative out of reach.
    across2: T,
}

/// An upper arm's direction, sin θ and cos θ times 2 Lb h².
#[derive(Debug, Clone, Copy)]
pub(crate) struct Heading<T> {
    pub(crate) sin: T,
    pub(crate) cos: T,
}

impl<T: RealField + Trig> PreparedArm<T> {
    pub(crate) fn new(
        arm: &ArmGeometry<T>,
        range: ArmRange<T>,
        max_swivel: Option<T>,
        positive: Positive,
    ) -> Self {
        let (sin, cos) = sin_cos(arm.azimuth);
        let huge = max_value::<T>();
        let turn = match positive {
            Positive::Outward => T::one(),
            Positive::Inward => -T::one(),
        };
        let (min, max) = (range.min(), range.max());
        let (a, b) = (arm.zero + turn * min, arm.zero + turn * max);
        Self {
            cos,
            sin,
            offset: arm.base - arm.platform,
            upper: arm.upper,
            per_upper: arm.upper.recip(),
            lower: arm.lower,
            zero: arm.zero,
            turn,
            min,
            max,
            low: a.min(b),
            high: a.max(b),
            max_side: max_swivel.map_or(huge, |swivel| arm.lower * sin_cos(swivel).0),
        }
    }

    /// The angle that is read at `theta`.
    #[inline]
    pub(crate) fn angle(&self, theta: T) -> T {
        self.turn * (theta - self.zero)
    }

    #[inline]
    pub(crate) fn theta(&self, angle: T) -> T {
        self.zero + self.turn * angle
    }

    /// The part of [`Delta::tolerance`](crate::Delta::tolerance) that the size of the angles asks
    /// for, in machine epsilons.
    pub(crate) fn angle_rounding(&self) -> T {
        let reading = if self.is_limited() {
            self.min.abs().max(self.max.abs())
        } else {
            T::zero()
        };
        // Half an epsilon for each arm, two arms in each sphere's centre, once here and once there.
        self.upper * (self.zero.abs() + reading) * two()
    }

    pub(crate) fn is_limited(&self) -> bool {
        self.max < max_value()
    }

    #[inline(always)]
    pub(crate) fn triangle(&self, point: &Vector3<T>) -> Triangle<T> {
        let inward = self.offset - (point.x * self.cos + point.y * self.sin);
        let side = point.y * self.cos - point.x * self.sin;
        let h2 = inward * inward + point.z * point.z;
        // La² - w², differences before products: short lower arms keep their digits.
        let in_plane = (self.lower - side) * (self.lower + side);
        let upper2 = self.upper * self.upper;
        let (along, across2) = if h2 * (two::<T>() * two()) < upper2 {
            self.near_axis(h2, in_plane)
        } else {
            // Heron's formula in squares, within reach none of them above 9 h².
            let longer = h2 - in_plane;
            let opposite = longer - upper2;
            let product = upper2 * two() * two() * in_plane;
            (-(longer + upper2), product - opposite * opposite)
        };
        Triangle {
            inward,
            z: point.z,
            side,
            h2,
            along,
            across2,
        }
    }

    /// `along` and `across2` of a wrist near the motor's axis, where squares of lengths that are
    /// about equal would be subtracted.
    #[cold]
    #[inline(never)]
    fn near_axis(&self, h2: T, in_plane: T) -> (T, T) {
        let h = sqrt(h2);
        let (near, far) = (h - self.upper, h + self.upper);
        let (past_near, short_of_far) = (in_plane - near * near, far * far - in_plane);
        (
            (past_near - short_of_far) * half(),
            past_near * short_of_far,
        )
    }

    /// One over the length of a heading with `scale` = 1 / 2 h².
    #[inline(always)]
    pub(crate) fn per_heading(&self, scale: T) -> T {
        self.per_upper * scale
    }

    /// The rod, from the elbow to the wrist, with `scale` as before.
    #[inline(always)]
    pub(crate) fn rod(&self, triangle: &Triangle<T>, heading: &Heading<T>, scale: T) -> Vector3<T> {
        let outward = -triangle.inward - heading.sin * scale;
        let up = triangle.z + heading.cos * scale;
        Vector3::new(
            outward * self.cos - triangle.side * self.sin,
            outward * self.sin + triangle.side * self.cos,
            up,
        )
    }

    /// Centre of the sphere on which the platform's centre lies: the elbow, moved inward by
    /// the platform's radius. From sine and cosine of theta, as the next two.
    #[inline]
    pub(crate) fn centre(&self, (sin, cos): (T, T)) -> Vector3<T> {
        self.in_plane(self.offset + self.upper * sin, -self.upper * cos)
    }

    /// No centre is farther from the axis of the base.
    pub(crate) fn farthest_centre(&self) -> T {
        self.offset.abs() + self.upper
    }

    /// The upper arm as a vector.
    pub(crate) fn spoke(&self, (sin, cos): (T, T)) -> Vector3<T> {
        self.in_plane(self.upper * sin, -self.upper * cos)
    }

    /// How the elbow moves when theta grows.
    pub(crate) fn tangent(&self, (sin, cos): (T, T)) -> Vector3<T> {
        self.in_plane(self.upper * cos, self.upper * sin)
    }

    /// Perpendicular to the arm's plane.
    pub(crate) fn sideways(&self) -> Vector3<T> {
        Vector3::new(-self.sin, self.cos, T::zero())
    }

    /// A vector of the arm's plane, outward and up.
    #[inline(always)]
    pub(crate) fn in_plane(&self, outward: T, up: T) -> Vector3<T> {
        Vector3::new(outward * self.cos, outward * self.sin, up)
    }

    /// By how much the rod would be too short if the elbow were at `theta`.
    #[inline(never)]
    pub(crate) fn stretch(&self, point: &Vector3<T>, theta: T) -> T {
        norm(&(point - self.centre(sin_cos(theta)))) - self.lower
    }

    /// How far the nearest and the farthest point of the elbow's circle are from the wrist.
    pub(crate) fn elbow_distances(&self, triangle: &Triangle<T>) -> (T, T) {
        let length = |x, y| length(&Vector2::new(x, y));
        let h = length(triangle.inward, triangle.z);
        let near = length(h - self.upper, triangle.side);
        let far = length(h + self.upper, triangle.side);
        (near, far)
    }
}

impl<T: RealField + Trig> Triangle<T> {
    /// 1 / 2 h²
    #[inline(always)]
    pub(crate) fn scale(&self) -> T {
        (self.h2 * two()).recip()
    }

    /// The triangle on the edge, from one that may be a little beyond.
    pub(crate) fn at_edge(self) -> Self {
        Self {
            across2: self.across2.max(T::zero()),
            ..self
        }
    }

    /// The upper arm with the elbow on the given side; not a number out of reach.
    #[inline(always)]
    pub(crate) fn heading(&self, elbow: ElbowSide) -> Heading<T> {
        let along = self.along;
        let across = sqrt(self.across2);
        let across = match elbow {
            ElbowSide::Out => across,
            ElbowSide::In => -across,
        };
        Heading {
            sin: along * self.inward - across * self.z,
            cos: along * self.z + across * self.inward,
        }
    }
}

/// The thetas of three upper arms, each from its heading and one over the heading's length.
#[inline(always)]
pub(crate) fn thetas<T: Trig>([first, second, third]: [(Heading<T>, T); 3]) -> [T; 3] {
    // Two fill the vectors of every processor that has some; three would not be put into them.
    let [one, two] = atan2_of_length_lanes(
        [first.0.sin, second.0.sin],
        [first.0.cos, second.0.cos],
        [first.1, second.1],
    );
    [one, two, atan2_of_length(third.0.sin, third.0.cos, third.1)]
}

/// The mean of two numbers that may be as large as there are.
pub(crate) fn middle<T: RealField + Copy>(a: T, b: T) -> T {
    a * half() + b * half()
}
