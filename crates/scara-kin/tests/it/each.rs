//! Many points at once: the bits of one by one.

use proptest::prelude::*;
use scara_kin::nalgebra::{Point2, RealField};
use scara_kin::{Arm, JointRange, Joints, Limits, Trig};

/// Machines with and without limits, and points within and out of reach, at the base, not finite.
fn check<T: RealField + Trig>(links: [T; 2], limit: T, points: &[Point2<T>]) {
    let [upper, fore] = links;
    let free = Arm::new(upper, fore).unwrap();
    let range = JointRange::new(-limit, limit).unwrap();
    let limited = free.with_limits(Limits {
        shoulder: range,
        elbow: range,
    });
    for arm in [free, limited] {
        let each: Vec<_> = arm.inverse_each(points).collect();
        let single: Vec<_> = points.iter().map(|point| arm.inverse(*point)).collect();
        // As text, in which a NaN is like another one and a float has all its digits.
        assert_eq!(format!("{each:?}"), format!("{single:?}"));

        let poses: Vec<_> = points.iter().map(|p| Joints::new(p.x, p.y)).collect();
        let each: Vec<_> = arm.forward_each(&poses).collect();
        let single: Vec<_> = poses.iter().map(|joints| arm.forward(*joints)).collect();
        assert_eq!(format!("{each:?}"), format!("{single:?}"));
    }
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -300.0..300.0f64,
        1 => prop::sample::select(&[0.0, -0.0, 264.0, 1e-320, 1e300, f64::NAN, f64::INFINITY][..]),
    ]
}

proptest! {
    #[test]
    fn each_is_the_single_form(
        fore in prop_oneof![Just(132.0), 50.0..200.0f64],
        limit in 0.5..4.0f64,
        points in prop::collection::vec((coordinate(), coordinate()), 0..30),
    ) {
        let double: Vec<_> = points.iter().map(|(x, y)| Point2::new(*x, *y)).collect();
        let single: Vec<Point2<f32>> = double.iter().map(|point| point.cast()).collect();
        check([132.0, fore], limit, &double);
        let [fore, limit]: [f32; 2] = Point2::new(fore, limit).cast().coords.into();
        check([132.0, fore], limit, &single);
    }
}
