//! trig-kernels: any number, not a number, infinite, too.

use std::hint::black_box;

use no_panic::no_panic;
use trig_kernels::{atan2, atan2_lanes, sin_cos, sin_cos_lanes};

#[no_panic]
#[inline(never)]
fn sin_cos_f32(x: f32) -> (f32, f32) {
    sin_cos(x)
}

#[no_panic]
#[inline(never)]
fn sin_cos_f64(x: f64) -> (f64, f64) {
    sin_cos(x)
}

#[no_panic]
#[inline(never)]
fn sin_cos_of_lanes(x: [f64; 8]) -> ([f64; 8], [f64; 8]) {
    sin_cos_lanes(x)
}

#[no_panic]
#[inline(never)]
fn atan2_f32(y: f32, x: f32) -> f32 {
    atan2(y, x)
}

#[no_panic]
#[inline(never)]
fn atan2_f64(y: f64, x: f64) -> f64 {
    atan2(y, x)
}

#[no_panic]
#[inline(never)]
fn atan2_of_lanes(y: [f64; 8], x: [f64; 8]) -> [f64; 8] {
    atan2_lanes(y, x)
}

pub fn run() {
    black_box(sin_cos_f32(black_box(1.0)));
    black_box(sin_cos_f64(black_box(1.0)));
    black_box(sin_cos_of_lanes(black_box([1.0; 8])));
    black_box(atan2_f32(black_box(1.0), black_box(1.0)));
    black_box(atan2_f64(black_box(1.0), black_box(1.0)));
    black_box(atan2_of_lanes(black_box([1.0; 8]), black_box([1.0; 8])));
}
