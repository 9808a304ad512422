//! How far arms reach, by the plain geometry of the elbow's circle.

use delta_kin::ArmGeometry;
use delta_kin::nalgebra::{Point3, Vector3};

/// By how much each arm reaches a point, by the wrist's distances from the nearest and the
/// farthest place of the elbow; negative: by how much its rods are too short or too long.
pub(crate) fn reach_margins(arms: &[ArmGeometry; 3], point: Point3<f64>) -> Vector3<f64> {
    Vector3::from(arms.map(|arm| {
        let (sin, cos) = arm.azimuth.sin_cos();
        let inward = arm.base - arm.platform - (point.x * cos + point.y * sin);
        let side = point.y * cos - point.x * sin;
        let h = inward.hypot(point.z);
        let (near, far) = ((h - arm.upper).hypot(side), (h + arm.upper).hypot(side));
        (arm.lower - near).min(far - arm.lower)
    }))
}
