//! A Delta in f32: inverse and forward.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;

use delta_kin::nalgebra::Point3;
use delta_kin::{Delta, Dimensions};

fn work() -> Option<f32> {
    let delta = Delta::<f32>::new(Dimensions {
        base: black_box(42.0),
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .ok()?;
    let point = Point3::new(black_box(50.0), 50.0, -300.0);
    let angles = delta.inverse(point).ok()?;
    Some(delta.forward(angles).ok()?.x)
}
