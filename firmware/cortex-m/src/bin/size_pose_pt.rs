//! A body in f32: pose vector to nine axes.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;

use cortex_m_firmware::random::platform;
use pose_pt::{Convention, PoseVector};

fn work() -> f32 {
    let vector = PoseVector::new(black_box(10.0), -20.0, 100.0, 0.01, 0.02, -0.03);
    let pose = vector.to_isometry(Convention::ExtrinsicXyz);
    platform::<f32>().axes(&pose)[1].z
}
