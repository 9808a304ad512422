//! What the kinematics are measured against.

const LINK: f64 = 132.0;

/// The same arithmetic without base, checks, limits or types: both elbows.
pub(crate) fn bare(x: f64, y: f64) -> [f64; 4] {
    let r2 = x * x + y * y;
    let r = r2.sqrt();
    let s2 = r2 * ((2.0 * LINK - r) * (2.0 * LINK + r));
    let s = s2.max(0.0).sqrt();
    let elbow = libm::atan2(s, (r - LINK) * (r + LINK) - LINK * LINK);
    let right = libm::atan2(r2 * y - s * x, r2 * x + s * y);
    let left = libm::atan2(r2 * y + s * x, r2 * x - s * y);
    [right, elbow, left, -elbow]
}
