//! Sine, cosine and arc tangent in f32.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;

use trig_kernels::{atan2, sin_cos};

fn work() -> f32 {
    let (sin, cos) = sin_cos(black_box(0.75_f32));
    atan2(sin, cos)
}
