//! What the kinematics are measured against: the same arithmetic without frame, checks, limits
//! or types.

use libm::{atan2, cos, sin, sqrt};

/// cos and sin of an azimuth.
pub(crate) type Direction = (f64, f64);

pub(crate) const BASE: f64 = 42.0;
pub(crate) const PLATFORM: f64 = 18.0;
pub(crate) const UPPER: f64 = 120.0;
pub(crate) const LOWER: f64 = 243.0;

pub(crate) fn directions() -> [Direction; 3] {
    [30.0f64, 150.0, 270.0].map(|degrees| {
        let azimuth = degrees.to_radians();
        (cos(azimuth), sin(azimuth))
    })
}

/// Three angles, elbows out.
pub(crate) fn inverse(arms: &[Direction; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    arms.map(|(c, s)| {
        let p = (BASE - PLATFORM) - (x * c + y * s);
        let w = y * c - x * s;
        let h2 = p * p + z * z;
        let k = ((LOWER - UPPER) * (LOWER + UPPER) - (h2 + w * w)) * (0.5 / UPPER);
        let m = sqrt(h2 - k * k);
        atan2(k * p - m * z, k * z + m * p)
    })
}

/// The lower assembly.
pub(crate) fn forward(arms: &[Direction; 3], angles: [f64; 3]) -> [f64; 3] {
    let centre = |(c, s): Direction, theta: f64| {
        let out = (BASE - PLATFORM) + UPPER * sin(theta);
        [out * c, out * s, -UPPER * cos(theta)]
    };
    let [a1, a2, a3] = *arms;
    let [t1, t2, t3] = angles;
    let (c1, c2, c3) = (centre(a1, t1), centre(a2, t2), centre(a3, t3));
    let (d2, d3) = (minus(c2, c1), minus(c3, c1));
    let n = cross(d2, d3);
    let length = sqrt(dot(n, n));
    let unit = n.map(|n| n / length);
    let (b2, b3) = (0.5 * dot(d2, d2), 0.5 * dot(d3, d3));
    let (e2, e3) = (cross(d3, unit), cross(unit, d2));
    let v = [0, 1, 2].map(|i| (b2 * e2[i] + b3 * e3[i]) / length);
    let up = sqrt(LOWER * LOWER - dot(v, v));
    [0, 1, 2].map(|i| c1[i] + v[i] - unit[i] * up)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
