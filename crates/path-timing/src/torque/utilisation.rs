//! What part of its torque each motor gives on a cubic, proven.

use super::{Dynamics, TorqueLimits, heading, sign};
use crate::number::larger_or_nan;
use crate::{Axes, Cubic, Row, Span};

/// Parts that a segment is looked at in, and more where these leave much open.
const PARTS: [u32; 4] = [1, 4, 16, 64];

/// What may be left open: half of it in time.
const OPEN: f64 = 5e-5;

impl<D: Dynamics> TorqueLimits<D> {
    /// The largest part of what a motor has at its speed that is asked of any motor anywhere on a
    /// segment: at most 1 where all can follow. It does not depend on who planned the segment.
    ///
    /// Proof. Between two places that are τ apart in time, a torque is within τ²/8 of its largest
    /// second derivative of the straight line between its values there, and so is a speed; friction
    /// adds at most its largest value, and a motor has at least what it has at the largest speed, which
    /// is not above the cubic's.
    #[must_use]
    pub fn utilisation(&self, span: &Span<D::Axes>) -> f64 {
        let bend = self.dynamics.bend(span);
        let mut bound = f64::NAN;
        for parts in PARTS {
            let at_nodes;
            [bound, at_nodes] = self.bound(span, &bend, parts);
            if bound <= 1.0 || bound - at_nodes <= OPEN {
                break;
            }
        }
        bound
    }

    /// The bound, and the largest part at the ends of so many parts of a segment.
    fn bound(&self, span: &Span<D::Axes>, bend: &D::Axes, parts: u32) -> [f64; 2] {
        let [from, to] = &span.rows;
        let duration_s = to.duration_s;
        let part_s = duration_s / f64::from(parts);
        let eighth = part_s * part_s * 0.125;
        let friction = self.dynamics.friction();
        let [mut jerks, mut peaks] = [D::Axes::zeros(); 2];
        let numbers = (jerks.as_mut_slice().iter_mut()).zip(peaks.as_mut_slice());
        for ((jerk, peak), cubic) in numbers.zip(Cubic::between(from, to)) {
            let [a0, a1] = cubic.accelerations();
            *jerk = (a1 - a0).abs() / duration_s;
            *peak = cubic.peak_speed();
        }
        let [mut most, mut at_nodes] = [0.0; 2];
        let mut before = self.at(from, to, 0.0);
        for part in 1..=parts {
            let here = self.at(from, to, f64::from(part) / f64::from(parts));
            let motors = A::<D>::each(&self.motors).iter();
            let axes = motors.zip(A::<D>::each(&friction)).zip(bend.as_slice());
            let axes = axes.zip(jerks.as_slice().iter().zip(peaks.as_slice()));
            for (axis, (((motor, friction), bend), (jerk, peak))) in axes.enumerate() {
                let [(v0, t0), (v1, t1)] = [&before, &here].map(|(velocity, torque)| {
                    let of = |numbers: &D::Axes| numbers.as_slice().get(axis).copied();
                    (of(velocity).unwrap_or(0.0), of(torque).unwrap_or(0.0))
                });
                let speed = (v0.abs().max(v1.abs()) + eighth * jerk).min(*peak);
                let bent = eighth * (bend + friction.viscous * jerk);
                // The sign of a speed that may be 0 between both places is not known.
                let turns = sign(v0) * sign(v1) < 0.0;
                let with = |v: f64, t: f64, other: f64| {
                    let coulomb = if turns {
                        friction.coulomb
                    } else {
                        friction.coulomb * heading(v, other)
                    };
                    let torque = t + friction.viscous * v;
                    (torque + coulomb)
                        .abs()
                        .max(if turns { (torque - coulomb).abs() } else { 0.0 })
                };
                // Not a number where a motor has nothing and nothing is asked.
                let used = |torque: f64, speed: f64| {
                    if torque > 0.0 {
                        torque / motor.at(speed)
                    } else {
                        0.0
                    }
                };
                let ends = [(with(v0, t0, v1), v0), (with(v1, t1, v0), v1)];
                let torque = ends.into_iter().map(|(torque, _)| torque);
                let torque = torque.fold(0.0, larger_or_nan) + bent;
                most = larger_or_nan(most, used(torque, speed));
                for (torque, speed) in ends {
                    at_nodes = larger_or_nan(at_nodes, used(torque, speed));
                }
            }
            before = here;
        }
        [most, at_nodes]
    }

    /// Velocities, and torques without friction, at a fraction of a segment.
    fn at(&self, from: &Row<D::Axes>, to: &Row<D::Axes>, fraction: f64) -> (D::Axes, D::Axes) {
        let [mut position, mut velocity, mut acceleration] = [D::Axes::zeros(); 3];
        let numbers = (position.as_mut_slice().iter_mut()).zip(velocity.as_mut_slice());
        let numbers = numbers.zip(acceleration.as_mut_slice());
        for (((q, v), a), cubic) in numbers.zip(Cubic::between(from, to)) {
            let [a0, a1] = cubic.accelerations();
            let rise = (a1 - a0) * fraction;
            *q = cubic.position(fraction);
            *v = cubic.v0 + (a0 + rise * 0.5) * fraction * cubic.duration_s;
            *a = a0 + rise;
        }
        // At an end as it is: rounding would turn the friction round at rest.
        if fraction >= 1.0 {
            (position, velocity) = (to.position, to.velocity);
        }
        let torques = self.dynamics.torques(&position, &velocity, &acceleration);
        (velocity, torques)
    }
}

type A<D> = <D as Dynamics>::Axes;
