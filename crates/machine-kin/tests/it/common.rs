//! What several modules use.

pub(crate) mod arms;

use machine_kin::path_timing::{Accuracy, AxisLimits, Cubic, Curve, Span};
use machine_kin::{Axis, Gradient, Machine};
use scara_kin::nalgebra::{SMatrix, SVector};

/// The Jacobian of the inverse at a place, and the axes.
pub(crate) fn slopes<M: Machine<N>, const N: usize>(
    machine: &M,
    tool: [f64; N],
    branch: M::Branch,
) -> Option<([f64; N], SMatrix<f64, N, N>)> {
    let axes = machine.inverse(Gradient::variables(tool), branch).ok()?;
    let matrix = SMatrix::from_fn(|row, column| axes[row].slopes()[column]);
    Some((axes.map(|axis| axis.value()), matrix))
}

/// Where the tool is with the axes at `positions`, from a place nearby on: by Newton.
pub(crate) fn forward<M: Machine<N>, const N: usize>(
    machine: &M,
    axes: &[Axis; N],
    positions: [f64; N],
    branch: M::Branch,
    near: [f64; N],
) -> Option<[f64; N]> {
    let mut tool = SVector::from(near);
    // Next to singular poses rounding is more than the last digits.
    for round in 0..50 {
        let (found, slopes) = slopes(machine, tool.into(), branch)?;
        let off = SVector::from_fn(|row, _| apart(&axes[row], positions[row] - found[row]));
        let mut step = slopes.try_inverse()? * off;
        // Newton's step may lead over the end of the branch.
        while machine.inverse((tool + step).into(), branch).is_err() && step.norm() > 0.0 {
            step *= 0.5;
        }
        tool += step;
        if step.norm() <= (if round < 20 { 1e-13 } else { 1e-10 }) * (1.0 + tool.norm()) {
            return Some(tool.into());
        }
    }
    None
}

/// A difference of positions, of an angle the one of less than half a turn.
pub(crate) fn apart(axis: &Axis, difference: f64) -> f64 {
    use core::f64::consts::TAU;
    if axis.is_angle() {
        difference - (difference / TAU).round() * TAU
    } else {
        difference
    }
}

pub(crate) fn cubics<const N: usize>(span: &Span<[f64; N]>) -> [Cubic; N] {
    let [from, to] = &span.rows;
    let mut cubics = Cubic::between(from, to);
    [(); N].map(|()| cubics.next().unwrap())
}

/// How far a place is from a curve, near the parameter `at`.
pub(crate) fn distance<const N: usize>(curve: &Curve<N>, place: [f64; N], mut at: f64) -> f64 {
    let mut off = SVector::<f64, N>::zeros();
    for _ in 0..5 {
        let there = curve.at(at);
        off = SVector::from(place) - SVector::from(there.point);
        let tangent = SVector::from(there.tangent);
        at = (at + off.dot(&tangent) / tangent.norm_squared()).clamp(0.0, curve.length());
    }
    off.norm()
}

/// Usual limits: in rad/s and rad/s², or mm/s and mm/s².
pub(crate) fn limits<M: Machine<N>, const N: usize>(machine: &M) -> [AxisLimits; N] {
    machine.axes().map(|axis| {
        let (speed, acceleration) = if axis.is_angle() {
            (4.0, 60.0)
        } else {
            (300.0, 4000.0)
        };
        AxisLimits {
            speed,
            acceleration,
            jerk: None,
        }
    })
}

/// Some accuracy whatever the time.
pub(crate) fn within(max_departure: f64) -> Accuracy {
    Accuracy {
        min_segments: 8,
        max_departure,
        max_time_ratio: f64::INFINITY,
    }
}
