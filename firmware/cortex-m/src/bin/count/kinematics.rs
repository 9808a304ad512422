//! Angles, arms, Deltas, bodies.

use core::array::from_fn;
use core::hint::black_box;

use cortex_m_firmware::Real;
use cortex_m_firmware::meter::Meter;
use cortex_m_firmware::random::{Random, delta, platform};
use pose_pt::Convention;
use scara_kin::nalgebra::{Point2, Vector2};
use scara_kin::{Arm, Elbow};
use trig_kernels::{atan2, sin_cos};

use crate::cycle;

const CALLS: u32 = 64;
const POSES: usize = CALLS as usize;

pub fn count<T: Real>(meter: &Meter) {
    angles::<T>(meter);
    arm::<T>(meter);
    rotary_delta::<T>(meter);
    body::<T>(meter);
}

fn angles<T: Real>(meter: &Meter) {
    let mut random = Random::new();
    let numbers: [[T; 2]; POSES] = from_fn(|_| [0; 2].map(|_| random.between(-3.0, 3.0)));
    let mut number = cycle(&numbers);
    meter.count("sin_cos", T::NAME, CALLS, || {
        black_box(sin_cos(number()[0]));
    });
    meter.count("atan2", T::NAME, CALLS, || {
        let [y, x] = number();
        black_box(atan2(y, x));
    });
}

fn arm<T: Real>(meter: &Meter) {
    let mut random = Random::new();
    let arm = black_box(Arm::<T>::new(T::of(132.0), T::of(132.0)).expect("good lengths"));
    let points: [Point2<T>; POSES] = from_fn(|_| random.arm_point(&arm));
    let mut point = cycle(&points);
    let (elbow, near) = (Elbow::Right, points[0]);
    let joints = points.map(|point| arm.inverse_elbow(point, elbow).expect("forward made it"));
    let mut pose = cycle(&joints);
    meter.count("arm: forward", T::NAME, CALLS, || {
        black_box(arm.forward(pose()));
    });
    meter.count("arm: inverse, both elbows", T::NAME, CALLS, || {
        let _ = black_box(arm.inverse(point()));
    });
    meter.count("arm: inverse_elbow", T::NAME, CALLS, || {
        let _ = black_box(arm.inverse_elbow(point(), elbow));
    });
    let near = arm.inverse_elbow(near, elbow).expect("forward made it");
    meter.count("arm: inverse_nearest", T::NAME, CALLS, || {
        let _ = black_box(arm.inverse_nearest(point(), near));
    });
    let velocity = black_box(Vector2::new(T::of(10.0), T::of(-3.0)));
    meter.count("arm: joint_rates", T::NAME, CALLS, || {
        let _ = black_box(arm.joint_rates(pose(), velocity));
    });
    let line = [[-80.0, 100.0], [80.0, 100.0]].map(|point| point.map(T::of).into());
    let mut waypoints = arm.follow(line, elbow, T::of(0.05)).expect("in reach");
    meter.count("arm: waypoint of follow", T::NAME, 16, || {
        black_box(waypoints.next());
    });
}

fn rotary_delta<T: Real>(meter: &Meter) {
    let (mut random, delta) = (Random::new(), black_box(delta::<T>()));
    let points: [_; POSES] = from_fn(|_| random.delta_point());
    let mut point = cycle(&points);
    let angles = points.map(|point| delta.inverse(point).expect("in reach"));
    let mut angles = cycle(&angles);
    meter.count("Delta: inverse", T::NAME, CALLS, || {
        let _ = black_box(delta.inverse(point()));
    });
    meter.count("Delta: forward", T::NAME, CALLS, || {
        let _ = black_box(delta.forward(angles()));
    });
    let poses = points.map(|point| delta.pose_at(point).expect("in reach"));
    let mut poses = poses.iter().cycle();
    let velocity = black_box(random.velocity());
    meter.count("Delta: joint_rates of a pose", T::NAME, CALLS, || {
        let pose = black_box(poses.next().expect("endless"));
        let _ = black_box(pose.joint_rates(velocity));
    });
}

fn body<T: Real>(meter: &Meter) {
    let (mut random, platform) = (Random::new(), black_box(platform::<T>()));
    let convention = Convention::ExtrinsicXyz;
    let vectors: [_; POSES] = from_fn(|_| random.pose());
    let mut vector = cycle(&vectors);
    meter.count("body: pose vector to nine axes", T::NAME, CALLS, || {
        let vector = vector();
        let rotation = vector.to_rotation(convention);
        black_box(platform.axes_at(&rotation, &vector.position()));
    });
    let poses = vectors.map(|vector| vector.to_isometry(convention));
    let mut pose = cycle(&poses);
    meter.count("body: isometry to nine axes", T::NAME, CALLS, || {
        black_box(platform.axes(&pose()));
    });
    let axes = poses.map(|pose| platform.axes(&pose));
    let mut axes = cycle(&axes);
    meter.count("body: nine axes to pose", T::NAME, 16, || {
        let _ = black_box(platform.pose(&axes()));
    });
}
