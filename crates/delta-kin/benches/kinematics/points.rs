//! The places that benches ask for.

use delta_kin::nalgebra::Point3;

pub(crate) const POINTS: u32 = 4096;

/// Points spread over a cylinder of radius 100 mm and height 60 mm, in an order that jumps about.
pub(crate) fn points() -> Vec<Point3<f64>> {
    (0..POINTS)
        .map(|k| {
            let golden = f64::from(k) * 2.399_963_229_728_653;
            let r = 100.0 * (f64::from(k) + 0.5).sqrt() / f64::from(POINTS).sqrt();
            let z = -290.0 + 60.0 * (f64::from(k) * 0.618_033_988_749_894_8).fract();
            Point3::new(r * golden.cos(), r * golden.sin(), z)
        })
        .collect()
}
