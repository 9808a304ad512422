//! The torques at both ends of a segment, as forms of the speeds of the parameter there.

use super::{Dynamics, TorqueCurve, TorqueLimits, heading, sign};
use crate::number::{larger_or_nan, sqrt};
use crate::{Axes, Knot};

/// The torque of an axis at an end of a segment.
///
/// With W = w₀ + w₁ and r = (w₁ - w₀) / W, w the speed at this end:
///
/// ```text
/// τ = W²/4 (c + d r) + h w² + f w + g        c, d, h through M and h(p, p); f, g with friction
/// ```
#[derive(Debug, Clone, Copy)]
struct Form {
    c: f64,
    d: f64,
    h: f64,
    /// Viscous friction.
    f: f64,
    /// Gravity and Coulomb friction.
    g: f64,
    /// Coulomb friction of either sign, on a segment on which the axis turns round.
    either: f64,
    /// Speed of the axis for each unit of the parameter's.
    slope: f64,
}

impl Form {
    const NONE: Self = Self {
        c: 0.0,
        d: 0.0,
        h: 0.0,
        f: 0.0,
        g: 0.0,
        either: 0.0,
        slope: 0.0,
    };

    /// Coefficients of W², W and 1 on the ray of r, where the speed here is the fraction `part` of
    /// W.
    fn on_ray(&self, r: f64, part: f64) -> [f64; 3] {
        [
            0.25 * (self.c + self.d * r) + self.h * part * part,
            self.f * part,
            self.g,
        ]
    }
}

/// The torques at both ends of a segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Load<'a, A: Axes> {
    ends: [A::Of<Form>; 2],
    motors: &'a A::Of<TorqueCurve>,
}

impl<'a, A: Axes> Load<'a, A> {
    pub(super) fn new<D: Dynamics<Axes = A>>(
        limits: &'a TorqueLimits<D>,
        from: &Knot<A>,
        to: &Knot<A>,
    ) -> Self {
        let inverse = 1.0 / to.ds;
        let [mut first, mut last] = [[A::zeros(); 2]; 2];
        // The accelerations of a cubic by y = W²/4 and z = r W²/4: as in `Segment`.
        let positions = (from.point.position.as_slice().iter()).zip(to.point.position.as_slice());
        let slopes = (from.point.slope.as_slice().iter()).zip(to.point.slope.as_slice());
        for (axis, ((q0, q1), (p0, p1))) in positions.zip(slopes).enumerate() {
            let mean = (q1 - q0) * inverse;
            let start = [6.0 * mean - 4.0 * p0 - 2.0 * p1, 4.0 * p0 - 2.0 * p1];
            let end = [2.0 * p0 + 4.0 * p1 - 6.0 * mean, 4.0 * p1 - 2.0 * p0];
            for (vectors, numbers) in [(&mut first, start), (&mut last, end)] {
                for (vector, number) in vectors.iter_mut().zip(numbers) {
                    if let Some(slot) = vector.as_mut_slice().get_mut(axis) {
                        *slot = number * inverse;
                    }
                }
            }
        }
        let ends = [(from, to, first), (to, from, last)];
        Self {
            ends: ends
                .map(|(here, there, vectors)| forms(&limits.dynamics, [here, there], vectors)),
            motors: &limits.motors,
        }
    }

    /// The forms of each axis at each end, with its motor, and the part of W that the speed there
    /// is.
    fn each(&self, r: f64) -> impl Iterator<Item = (&Form, &TorqueCurve, f64)> {
        let parts = [(1.0 - r) * 0.5, (1.0 + r) * 0.5];
        let ends = self.ends.iter().zip(parts);
        ends.flat_map(|(forms, part)| {
            let axes = A::each(forms).iter().zip(A::each(self.motors));
            axes.map(move |(form, motor)| (form, motor, part))
        })
    }

    /// The largest part of what a motor has that these speeds ask for.
    pub(super) fn used(&self, w0: f64, w1: f64) -> f64 {
        let sum = w0 + w1;
        let r = if sum > 0.0 { (w1 - w0) / sum } else { 0.0 };
        self.each(r).fold(0.0, |most, (form, motor, part)| {
            let [a, b, c] = form.on_ray(r, part);
            let torque = ((a * sum + b) * sum + c).abs() + form.either;
            // Not a number where a motor has nothing and nothing is asked.
            let used = if torque > 0.0 {
                torque / motor.at(form.slope * part * sum)
            } else {
                0.0
            };
            larger_or_nan(most, used)
        })
    }

    /// The largest W on the ray of r, up to which all motors have what it takes.
    pub(super) fn widest(&self, r: f64) -> f64 {
        self.each(r)
            .fold(f64::INFINITY, |widest, (form, motor, part)| {
                widest.min(first_lack(
                    form.on_ray(r, part),
                    form.slope * part,
                    form.either,
                    motor,
                ))
            })
    }
}

/// The smallest W at which |a W² + b W + c| is above what the motor has left at the speed v W; 0
/// where it is so at rest.
fn first_lack([a, b, c]: [f64; 3], v: f64, taken: f64, motor: &TorqueCurve) -> f64 {
    let v = v.abs();
    let mut lack = 0.0;
    motor.each_piece(|[v0, v1], [t0, t1]| {
        let fall = if v1 > v0 { (t0 - t1) / (v1 - v0) } else { 0.0 };
        // On this piece |a W² + b W + c| <= t0 + fall v0 - fall v W, less what is taken.
        let limit = t0 + fall * v0 - taken;
        let upper = first_root([a, b + fall * v, c - limit]);
        let lower = first_root([-a, -b + fall * v, -c - limit]);
        let root = upper.min(lower);
        let end = if v1 > v0 { v1 / v } else { lack };
        // Pieces begin where those before them hold.
        let is_within = root < end;
        lack = if is_within { root.max(lack) } else { end };
        is_within
    });
    lack
}

/// The smallest root above 0 of a W² + b W + c with c <= 0; 0 where c is above 0, infinite without
/// a root.
fn first_root([a, b, c]: [f64; 3]) -> f64 {
    if c > 0.0 {
        return 0.0;
    }
    let square = b * b - 4.0 * a * c;
    if square < 0.0 {
        return f64::INFINITY;
    }
    // -2c / (b + √(b² - 4ac)): of both roots the one that does not cancel, and the smaller above 0.
    let sum = b + sqrt(square);
    if sum > 0.0 {
        -2.0 * c / sum
    } else {
        f64::INFINITY
    }
}

fn forms<A: Axes, D: Dynamics<Axes = A>>(
    dynamics: &D,
    [knot, other]: [&Knot<A>; 2],
    [c, d]: [A; 2],
) -> A::Of<Form> {
    let (position, slope) = (&knot.point.position, &knot.point.slope);
    let zeros = A::zeros();
    let rest = dynamics.torques(position, &zeros, &zeros);
    let of = |velocity: &A, acceleration: &A| dynamics.torques(position, velocity, acceleration);
    let (c, d, h) = (of(&zeros, &c), of(&zeros, &d), of(slope, &zeros));
    let friction = dynamics.friction();
    let mut forms = A::filled(Form::NONE);
    let torques = c.as_slice().iter().zip(d.as_slice()).zip(h.as_slice());
    let torques = torques.zip(rest.as_slice());
    let axes = slope.as_slice().iter().zip(other.point.slope.as_slice());
    let axes = axes.zip(A::each(&friction));
    for ((form, (((c, d), h), rest)), ((slope, other), friction)) in
        A::each_mut(&mut forms).iter_mut().zip(torques).zip(axes)
    {
        let turns = sign(*slope) * sign(*other) < 0.0;
        let (coulomb, either) = if turns {
            (0.0, friction.coulomb)
        } else {
            (friction.coulomb * heading(*slope, *other), 0.0)
        };
        *form = Form {
            c: c - rest,
            d: d - rest,
            h: h - rest,
            f: friction.viscous * slope,
            g: rest + coulomb,
            either,
            slope: *slope,
        };
    }
    forms
}
