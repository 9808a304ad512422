//! An arm in f32: inverse alone.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;

use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, Elbow};

fn work() -> Option<f32> {
    let arm = Arm::<f32>::new(black_box(132.0), 132.0).ok()?;
    let point = Point2::new(black_box(150.0), 80.0);
    Some(arm.inverse_elbow(point, Elbow::Right).ok()?.shoulder)
}
