//! The places that benches ask for.

use scara_kin::nalgebra::Point2;

pub(crate) const LINK: f64 = 132.0;
pub(crate) const POINTS: u32 = 4096;

/// Points spread evenly over the annulus, in an order that jumps about.
pub(crate) fn points() -> Vec<Point2<f64>> {
    (0..POINTS)
        .map(|k| {
            let golden = f64::from(k) * 2.399_963_229_728_653;
            let r = 2.0 * LINK * (f64::from(k) + 0.5).sqrt() / f64::from(POINTS).sqrt();
            Point2::new(r * golden.cos(), r * golden.sin())
        })
        .collect()
}
