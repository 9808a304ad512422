//! Limits of torque: motions as fast as the motors can turn what they carry.
//!
//! Goal: the fastest speeds along paths with which no motor gives more torque than it has at its
//! speed, on the cubics themselves. Method: at both ends of a segment a torque is a form of the
//! speeds there; a backward and a forward pass choose these. Then the torque of each cubic is
//! bounded all along it, segments that ask for more are planned anew with less of it, and the whole
//! is slowed by the little that is missing.

mod curve;
mod laden;
mod load;
mod look_ahead;
mod passes;
mod table;
mod utilisation;

pub use curve::{TorqueCurve, TorqueCurveError};
pub use look_ahead::TorqueLookAhead;
pub use table::TorqueTable;

use crate::knots::span_in_a_second;
use crate::number::sqrt;
use crate::reciprocals::Reciprocals;
use crate::{Axes, AxisLimits, Cubic, Knot, PlanError, Span};

/// What a machine's axes weigh against a motion: its inverse dynamics. Torques of axes in radians
/// are in Nm, forces of axes in metres in N; in any unit that goes with the axes', the same
/// throughout.
pub trait Dynamics {
    /// `[f64; N]` for N axes.
    type Axes: Axes;

    /// The torque of each axis that a motion takes, without friction: a sum of a part that is
    /// linear in the accelerations, one that is quadratic in the velocities, and one that the
    /// positions alone ask for.
    ///
    /// ```text
    /// τ = M(q) q̈ + h(q, q̇) + g(q)
    /// ```
    fn torques(
        &self,
        position: &Self::Axes,
        velocity: &Self::Axes,
        acceleration: &Self::Axes,
    ) -> Self::Axes;

    /// The torques of motions that pass one position, each by its velocity and acceleration: as
    /// [`torques`](Self::torques), for what has work in common.
    fn torques_of<const N: usize>(
        &self,
        position: &Self::Axes,
        motions: &[[Self::Axes; 2]; N],
    ) -> [Self::Axes; N] {
        motions
            .each_ref()
            .map(|[velocity, acceleration]| self.torques(position, velocity, acceleration))
    }

    /// The friction of each axis, which is added.
    fn friction(&self) -> <Self::Axes as Axes>::Of<Friction>;

    /// The most that the second derivative of each torque by time can be, while all axes run their
    /// cubics of a segment; without friction.
    fn bend(&self, span: &Span<Self::Axes>) -> Self::Axes;
}

/// The friction of an axis.
///
/// ```text
/// viscous q̇ + coulomb sign(q̇)
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct Friction {
    /// Torque for each unit of speed.
    pub viscous: f64,
    /// Torque at any speed.
    pub coulomb: f64,
}

/// A machine's dynamics, and what its motors can give.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct TorqueLimits<D: Dynamics> {
    /// What the axes weigh.
    pub dynamics: D,
    /// What the motor of each axis can give, at the axis' side of its gear.
    pub motors: <D::Axes as Axes>::Of<TorqueCurve>,
}

impl<D: Dynamics> TorqueLimits<D> {
    /// The torques of all axes at both ends of a segment, friction included: feed-forward for servo
    /// drives. Where the acceleration steps at a row, the end of one segment and the start of the
    /// next differ. An axis at rest has the Coulomb friction of where it goes or comes from.
    #[must_use]
    pub fn torques(&self, span: &Span<D::Axes>) -> [D::Axes; 2] {
        let [from, to] = &span.rows;
        let [mut start, mut end] = [D::Axes::zeros(); 2];
        let accelerations = (start.as_mut_slice().iter_mut()).zip(end.as_mut_slice());
        for ((a0, a1), cubic) in accelerations.zip(Cubic::between(from, to)) {
            [*a0, *a1] = cubic.accelerations();
        }
        let friction = self.dynamics.friction();
        [(from, to, start), (to, from, end)].map(|(row, other, acceleration)| {
            let mut torques = self
                .dynamics
                .torques(&row.position, &row.velocity, &acceleration);
            let speeds = row.velocity.as_slice().iter();
            let speeds = speeds.zip(other.velocity.as_slice());
            let axes = torques.as_mut_slice().iter_mut().zip(speeds);
            for ((torque, (speed, other)), friction) in axes.zip(D::Axes::each(&friction)) {
                *torque += friction.viscous * speed + friction.coulomb * heading(*speed, *other);
            }
            torques
        })
    }

    /// The limits of the axes, with the speeds that motors reach at most.
    fn reached<E>(
        &self,
        limits: &<D::Axes as Axes>::Of<AxisLimits>,
    ) -> Result<Reciprocals<D::Axes>, PlanError<E>> {
        Reciprocals::<D::Axes>::checked::<E>(limits)?;
        let mut reached = *limits;
        let motors = D::Axes::each(&self.motors);
        for (limits, motor) in D::Axes::each_mut(&mut reached).iter_mut().zip(motors) {
            limits.speed = limits.speed.min(motor.max_speed());
        }
        Ok(Reciprocals::new(&reached))
    }

    /// Whether the torques between two knots are known, whatever the speeds there: axes turn
    /// farthest where one of them is a rest.
    fn is_known(&self, from: &Knot<D::Axes>, to: &Knot<D::Axes>) -> bool {
        [0.0, 2.0].iter().all(|start| {
            let span = span_in_a_second([from, to], *start);
            let bend = self.dynamics.bend(&span);
            bend.as_slice().iter().all(|bend| bend.is_finite())
        })
    }
}

/// By how much more than inertia asks for a motion is slowed: enough at once where friction and
/// gravity take up to a fifth of a torque, and in each further round of what they take more.
const MORE: f64 = 1.25;

/// Rounds of slowing a motion by the little that its cubics ask for between the ends of segments.
const ROUNDS: u32 = 40;

/// Why no part of a speed was found that asks for no more than a motor has.
enum Lack {
    /// Nothing is known of the torques between the ends of segments: they are too long.
    Unknown,
    /// There is none.
    Torque,
}

/// A speed, as a part of the planned one, at which no more than 1 is `asked` of a motor, where at
/// the planned one it is `most`.
fn slowed(mut most: f64, asked: impl Fn(f64) -> f64) -> Result<f64, Lack> {
    let (mut speed, mut more) = (1.0, MORE);
    for _ in 0..ROUNDS {
        if most <= 1.0 {
            return Ok(speed);
        }
        if most == f64::INFINITY {
            return Err(Lack::Unknown);
        }
        // Inertia asks for the square of the speed; friction and gravity do not.
        speed /= sqrt(1.0 + (most - 1.0) * more + f64::EPSILON);
        more *= MORE;
        most = asked(speed);
    }
    Err(Lack::Torque)
}

/// The sign of a speed, or at rest that of the speed at the other end of a segment.
fn heading(speed: f64, other: f64) -> f64 {
    if speed == 0.0 {
        sign(other)
    } else {
        sign(speed)
    }
}

/// -1, 0 or 1.
fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}
