//! Many points or poses at once: `inverse` and `forward` in blocks that vectorise.

use nalgebra::{Point2, RealField};
use trig_kernels::{Trig, atan2_of_length_lanes, sin_cos_lanes};

use crate::inverse::Triangle;
use crate::{Arm, InverseError, Joints, Solutions};

/// Points of a block: two of the widest vectors in f64, one in f32.
const LANES: usize = 8;

impl<T: RealField + Trig> Arm<T> {
    /// What [`inverse`](Self::inverse) gives for each of the points, to the last bit, computed in
    /// blocks of eight points by vector instructions.
    ///
    /// ```
    /// use scara_kin::Arm;
    /// use scara_kin::nalgebra::Point2;
    ///
    /// let arm = Arm::new(132.0, 132.0)?;
    /// let points = [Point2::new(100.0, 50.0), Point2::new(300.0, 0.0)];
    /// let mut found = arm.inverse_each(&points);
    /// assert!(found.next().unwrap().is_ok());
    /// assert!(found.next().unwrap().is_err()); // too far
    /// # Ok::<(), scara_kin::GeometryError<f64>>(())
    /// ```
    pub fn inverse_each<'a>(
        &'a self,
        points: &'a [Point2<T>],
    ) -> impl Iterator<Item = Result<Solutions<T>, InverseError<T>>> + Clone + use<'a, T> {
        blocks(points).flat_map(|(block, len)| self.inverse_block(&block).take(len))
    }

    /// What [`forward`](Self::forward) gives for each of the poses, to the last bit, computed in
    /// blocks of eight poses by vector instructions.
    pub fn forward_each<'a>(
        &'a self,
        joints: &'a [Joints<T>],
    ) -> impl Iterator<Item = Point2<T>> + Clone + use<'a, T> {
        blocks(joints).flat_map(|(block, len)| self.forward_block(&block).take(len))
    }

    #[expect(clippy::indexing_slicing, reason = "lanes of arrays of LANES")]
    #[inline]
    fn inverse_block(
        &self,
        points: &[Point2<T>; LANES],
    ) -> impl Iterator<Item = Result<Solutions<T>, InverseError<T>>> + Clone + use<'_, T> {
        let triangles = points.map(|point| self.triangle(point));
        let angles = |sides: fn(&Triangle<T>) -> (T, T, T)| {
            let (mut y, mut x) = ([T::zero(); LANES], [T::one(); LANES]);
            let mut inverse = x;
            // The lane of a point that has no triangle keeps any angle.
            for (k, triangle) in triangles.iter().enumerate() {
                if let Ok(triangle) = triangle {
                    (y[k], x[k], inverse[k]) = sides(triangle);
                }
            }
            lanes(&y, &x, &inverse)
        };
        let elbows = angles(Triangle::elbow);
        let rights = angles(Triangle::right_shoulder);
        let lefts = angles(Triangle::left_shoulder);
        triangles.into_iter().enumerate().map(move |(k, triangle)| {
            let triangle = triangle?;
            let right = Joints::new(rights[k], elbows[k]);
            let left = Joints::new(lefts[k], -elbows[k]);
            Solutions::new(self, [right, left], triangle.tool)
        })
    }

    #[expect(clippy::indexing_slicing, reason = "lanes of arrays of LANES")]
    #[inline]
    fn forward_block(
        &self,
        joints: &[Joints<T>; LANES],
    ) -> impl Iterator<Item = Point2<T>> + Clone + use<'_, T> {
        let (sin1, cos1) = sin_cos_lanes(joints.map(|joints| joints.shoulder));
        let (sin2, cos2) = sin_cos_lanes(joints.map(|joints| joints.elbow));
        (0..LANES).map(move |k| {
            let tip = self.tip_of([sin1[k], sin2[k]], [cos1[k], cos2[k]]);
            self.base() * Point2::from(tip)
        })
    }
}

/// A call of its own: inlined, the compiler no longer makes vectors of the lanes.
#[inline(never)]
fn lanes<T: Trig>(y: &[T; LANES], x: &[T; LANES], inverse: &[T; LANES]) -> [T; LANES] {
    atan2_of_length_lanes(*y, *x, *inverse)
}

/// Blocks of all items and how many are in each; the last one is filled up with an item of its own.
#[expect(clippy::indexing_slicing, reason = "no chunk is empty")]
fn blocks<A: Copy>(items: &[A]) -> impl Iterator<Item = ([A; LANES], usize)> + Clone {
    items.chunks(LANES).map(|chunk| {
        let mut block = [chunk[0]; LANES];
        block[..chunk.len()].copy_from_slice(chunk);
        (block, chunk.len())
    })
}
