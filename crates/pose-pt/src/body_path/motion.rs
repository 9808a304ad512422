//! The axes of a body in motion, with their slopes.

use nalgebra::{Point3, Rotation3, Vector3};
use trig_kernels::sin_cos;

use crate::leg_axes::{LegAxes, TurningAxes};
use crate::turn::Turn;
use crate::{Convention, Platform};

/// A pose of the body as a matrix, with its derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motion {
    pub(super) rotation: Rotation3<f64>,
    pub(super) position: Vector3<f64>,
    /// Velocity of the reference point.
    pub(super) linear: Vector3<f64>,
    /// Angular velocity in the world.
    pub(super) angular: Vector3<f64>,
}

/// Axis coordinates and their derivative by the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxesPoint<const N: usize> {
    pub(super) axes: [Vector3<f64>; N],
    pub(super) slope: [Vector3<f64>; N],
}

impl<const N: usize> AxesPoint<N> {
    /// The axes of a body that moves.
    pub(super) fn of(platform: &Platform<N>, motion: &Motion) -> Self {
        let velocity = |anchor: Point3<f64>| {
            motion.linear + motion.angular.cross(&(motion.rotation * anchor.coords))
        };
        Self {
            axes: platform.axes_at(&motion.rotation, &motion.position),
            slope: platform.in_axes(platform.anchors().map(velocity)),
        }
    }
}

impl<const N: usize> LegAxes<'_, N> {
    /// Axes and slopes at a parameter.
    pub(super) fn point(&self, s: f64) -> AxesPoint<N> {
        match self {
            Self::Turning(leg_axes) => {
                let turn = Turn::of(leg_axes.angle * s);
                AxesPoint {
                    axes: leg_axes.axes(s, turn),
                    slope: leg_axes.slope(turn),
                }
            }
            Self::Vector(platform, leg) => {
                let vector = leg.at(s);
                let rotation = vector.to_rotation(leg.convention);
                let angular =
                    angular_velocity(leg.convention, &vector.angles(), &leg.angles_change());
                let (position, linear) = (vector.position(), leg.slide());
                AxesPoint::of(
                    platform,
                    &Motion {
                        rotation,
                        position,
                        linear,
                        angular,
                    },
                )
            }
        }
    }
}

impl<const N: usize> TurningAxes<N> {
    fn slope(&self, turn: Turn) -> [Vector3<f64>; N] {
        let mut slope = self.slide;
        for (slope, (sine, versine)) in slope.iter_mut().zip(self.sine.iter().zip(&self.versine)) {
            *slope += (sine * turn.cos() + versine * turn.sin) * self.angle;
        }
        slope
    }
}

/// Angular velocity in the world of the rotation by `angles` that change at `rate`.
///
/// ```text
/// R = Rz(γ) Ry(β) Rx(α)   ω = γ' ẑ + Rz (β' ŷ + Ry α' x̂)
/// R = Rx(α) Ry(β) Rz(γ)   ω = α' x̂ + Rx (β' ŷ + Ry γ' ẑ)
/// ```
pub(super) fn angular_velocity(
    convention: Convention,
    angles: &Vector3<f64>,
    rate: &Vector3<f64>,
) -> Vector3<f64> {
    let (sb, cb) = sin_cos(angles.y);
    match convention {
        Convention::ExtrinsicXyz => {
            let (sg, cg) = sin_cos(angles.z);
            let across = cb * rate.x;
            Vector3::new(
                cg * across - sg * rate.y,
                sg * across + cg * rate.y,
                rate.z - sb * rate.x,
            )
        }
        Convention::IntrinsicXyz => {
            let (sa, ca) = sin_cos(angles.x);
            let across = cb * rate.z;
            Vector3::new(
                rate.x + sb * rate.z,
                ca * rate.y - sa * across,
                sa * rate.y + ca * across,
            )
        }
    }
}
