//! The machine of [Delta thesis], in mm.

use delta_kin::nalgebra::Vector3;
use delta_kin::{Delta, Dimensions};
use proptest::prelude::*;

pub(crate) fn thesis() -> Delta {
    Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .unwrap()
}

/// Unit vectors.
pub(crate) fn directions() -> impl Strategy<Value = Vector3<f64>> {
    [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64]
        .prop_map(Vector3::from)
        .prop_filter("has a length", |v| v.norm() > 0.1)
        .prop_map(|v| v.normalize())
}
