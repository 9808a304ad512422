//! What several modules use.

use scara_kin::nalgebra::{self, Point2, RealField};
use scara_kin::{Arm, JointRange, Joints, Limits, Trig};

/// The arm of the engraver, in mm.
pub(crate) fn engraver() -> Arm {
    Arm::new(132.0, 132.0).unwrap()
}

/// Ranges of shoulder and elbow, from their least angle to their largest.
pub(crate) fn limits(shoulder: [f64; 2], elbow: [f64; 2]) -> Limits {
    let [shoulder, elbow] = [shoulder, elbow].map(|[min, max]| JointRange::new(min, max).unwrap());
    Limits { shoulder, elbow }
}

pub(crate) fn single<T: RealField>(number: f64) -> T {
    nalgebra::convert(number)
}

pub(crate) fn double<T: RealField>(number: T) -> f64 {
    nalgebra::convert_unchecked(number)
}

pub(crate) fn epsilon<T: RealField>() -> f64 {
    double(T::default_epsilon())
}

/// What rounding may move the tool by: of lengths or, many turns from zero, of angles.
pub(crate) fn rounding<T: RealField + Trig>(arm: &Arm<T>, joints: Joints<T>) -> f64 {
    let angles = double(joints.shoulder).abs() * double(arm.reach())
        + double(joints.elbow).abs() * double(arm.fore());
    double(arm.tolerance()).max(angles * epsilon::<T>())
}

/// How far the tool is from the nearest point of the straight line from `a` to `b`, at each of
/// `samples` steps of a move of the joints; the most.
pub(crate) fn departure<T: RealField + Trig>(
    arm: &Arm<T>,
    (from, to): (Joints<T>, Joints<T>),
    [a, b]: [Point2<T>; 2],
    samples: u32,
) -> f64 {
    let change = to - from;
    let places = (0..=samples).map(|k| {
        let t: T = single(f64::from(k) / f64::from(samples));
        let (shoulder, elbow) = (from.shoulder + change.x * t, from.elbow + change.y * t);
        distance_to_line(arm.forward(Joints::new(shoulder, elbow)), a, b)
    });
    places.fold(0.0, f64::max)
}

fn distance_to_line<T: RealField + Trig>(tool: Point2<T>, a: Point2<T>, b: Point2<T>) -> f64 {
    let (along, off) = ((b - a).map(double), (tool - a).map(double));
    // Of squares of which the sum is a number.
    let size = along.amax().max(off.amax());
    if size == 0.0 {
        return 0.0;
    }
    let (along, off) = (along / size, off / size);
    let square = along.norm_squared();
    let fraction = if square > 0.0 {
        (off.dot(&along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (off - along * fraction).norm() * size
}
