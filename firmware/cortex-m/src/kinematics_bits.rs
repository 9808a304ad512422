//! Hashes of what the kinematics make of random poses.

use pose_pt::Convention;
use scara_kin::nalgebra::Vector2;
use scara_kin::{Arm, Elbow};

use crate::random::{Random, delta, platform};
use crate::{Hash, Real};

#[path = "../../../crates/trig-kernels/tests/it/common/bits.rs"]
mod trig;

const ROUNDS: u32 = 300;

/// Says a name, a precision and a hash for each calculation.
pub fn hashes(say: &mut dyn FnMut(&str, &str, Hash)) {
    let [single, double] = trig::hashes();
    say("sines and arc tangents", "f32", Hash(single));
    say("sines and arc tangents", "f64", Hash(double));
    each::<f32>(say);
    each::<f64>(say);
}

fn each<T: Real>(say: &mut dyn FnMut(&str, &str, Hash)) {
    say("arm", T::NAME, arm::<T>());
    say("line of an arm", T::NAME, follow::<T>());
    say("Delta", T::NAME, rotary_delta::<T>());
    say("body on nine axes", T::NAME, body::<T>());
}

/// Both elbows of unequal links, on a turned base; forward, rates.
fn arm<T: Real>() -> Hash {
    let (mut hash, mut random) = (Hash::default(), Random::new());
    let arm = Arm::<T>::new(T::of(132.0), T::of(131.0)).expect("good lengths");
    for _ in 0..ROUNDS {
        let point = random.arm_point(&arm);
        let velocity = random.velocity::<T>();
        for (_, joints) in arm.inverse(point).expect("forward made it").iter() {
            hash.add_all([joints.shoulder, joints.elbow]);
            hash.add_all(arm.forward(joints).coords.iter().copied());
            let velocity = Vector2::new(velocity.x, velocity.y);
            let rates = arm.joint_rates(joints, velocity).expect("not stretched");
            hash.add_all(rates.iter().copied());
            hash.add_all(arm.tool_velocity(joints, rates).iter().copied());
        }
    }
    hash
}

fn follow<T: Real>() -> Hash {
    let mut hash = Hash::default();
    let arm = Arm::<T>::new(T::of(132.0), T::of(132.0)).expect("good lengths");
    let line = [[-80.0, 100.0], [80.0, 100.0]].map(|point| point.map(T::of).into());
    let waypoints = arm.follow(line, Elbow::Right, T::of(0.05));
    for waypoint in waypoints.expect("within reach") {
        hash.add_all([waypoint.joints.shoulder, waypoint.joints.elbow]);
    }
    hash
}

fn rotary_delta<T: Real>() -> Hash {
    let (mut hash, mut random, delta) = (Hash::default(), Random::new(), delta::<T>());
    for _ in 0..ROUNDS {
        let pose = delta.pose_at(random.delta_point()).expect("within reach");
        hash.add_all(pose.angles().iter().copied());
        let back = delta.forward(pose.angles()).expect("inverse made it");
        hash.add_all(back.iter().copied());
        let rates = pose.joint_rates(random.velocity()).expect("not singular");
        hash.add_all(rates.iter().copied());
    }
    hash
}

fn body<T: Real>() -> Hash {
    let (mut hash, mut random, platform) = (Hash::default(), Random::new(), platform::<T>());
    for _ in 0..ROUNDS {
        let pose = random.pose().to_isometry(Convention::ExtrinsicXyz);
        let axes = platform.axes(&pose);
        hash.add_all(axes.iter().flatten().copied());
        let fit = platform.pose(&axes).expect("axes of a pose");
        hash.add_all(fit.pose.translation.vector.iter().copied());
        hash.add_all(fit.pose.rotation.coords.iter().copied());
    }
    hash
}
