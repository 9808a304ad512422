//! The shortest time along a leg by a fine phase plane, independent of any table.

use pose_pt::nalgebra::{Isometry3, Vector3};
use pose_pt::{Leg, Platform};

/// Slope and curvature of an axis at a place, and its limits.
struct AxisHere {
    slope: f64,
    bend: f64,
    speed: f64,
    acceleration: f64,
}

/// Central differences of the leg's poses; the steps leave seven digits.
fn axes_here<const N: usize>(platform: &Platform<N>, leg: &Leg, s: f64) -> Vec<AxisHere> {
    let step = 1e-4;
    let at = |s: f64| -> [Vector3<f64>; N] {
        let pose: Isometry3<f64> = leg.pose(s);
        platform.axes(&pose)
    };
    let (before, here, after) = (at(s - step), at(s), at(s + step));
    let mut all = Vec::new();
    for (number, locator) in platform.locators().iter().enumerate() {
        for (axis, limits) in locator.limits.iter().enumerate() {
            let [b, h, a] = [&before, &here, &after].map(|axes| axes[number][axis]);
            all.push(AxisHere {
                slope: (a - b) / (2.0 * step),
                bend: (a - 2.0 * h + b) / (step * step),
                speed: limits.speed,
                acceleration: limits.acceleration,
            });
        }
    }
    all
}

/// Range of the path acceleration u with |bend x + slope u| ≤ acceleration, x the squared speed.
fn range(axes: &[AxisHere], x: f64) -> (f64, f64) {
    axes.iter().fold((f64::MIN, f64::MAX), |(low, high), axis| {
        if axis.slope.abs() < 1e-6 {
            return (low, high);
        }
        let middle = -axis.bend * x / axis.slope;
        let wide = (axis.acceleration / axis.slope).abs();
        (low.max(middle - wide), high.min(middle + wide))
    })
}

/// The largest squared speed for which there is such a u.
fn most(axes: &[AxisHere]) -> f64 {
    let caps = axes.iter().map(|axis| (axis.speed / axis.slope).powi(2));
    let mut high = caps.fold(1e9, f64::min);
    let allows = |x: f64| {
        let (low, top) = range(axes, x);
        let still = axes.iter().filter(|axis| axis.slope.abs() < 1e-6);
        let mut bends = still.map(|axis| axis.bend.abs() * x <= axis.acceleration);
        low <= top && bends.all(|keeps| keeps)
    };
    let mut low = 0.0;
    if allows(high) {
        return high;
    }
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if allows(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

pub(crate) fn seconds<const N: usize>(platform: &Platform<N>, leg: &Leg, grid: u32) -> f64 {
    let step = 1.0 / f64::from(grid);
    let places: Vec<_> = (0..=grid)
        .map(|k| axes_here(platform, leg, f64::from(k) * step))
        .collect();
    let mut squares: Vec<f64> = places.iter().map(|axes| most(axes)).collect();
    *squares.last_mut().unwrap() = 0.0;
    for k in (0..squares.len() - 1).rev() {
        let (low, _) = range(&places[k + 1], squares[k + 1]);
        squares[k] = squares[k].min((squares[k + 1] - 2.0 * low * step).max(0.0));
    }
    squares[0] = 0.0;
    for k in 1..squares.len() {
        let (_, high) = range(&places[k - 1], squares[k - 1]);
        squares[k] = squares[k].min((squares[k - 1] + 2.0 * high * step).max(0.0));
    }
    let pairs = squares.windows(2);
    pairs
        .map(|pair| 2.0 * step / (pair[0].sqrt() + pair[1].sqrt()))
        .sum()
}
