//! The torques at both ends of a segment, as forms of the speeds of the parameter there.

use super::{Dynamics, TorqueCurve, TorqueLimits, heading, sign};
use crate::number::{LARGEST, larger, larger_or_nan, smaller, sqrt};
use crate::segment::End;
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

    /// Coefficients of w², w and 1 of the speed w at one end, with the speed `other` at the other;
    /// `is_own` where the torque is that at this end.
    fn beside(&self, end: End, other: f64, is_own: bool) -> [f64; 3] {
        let d = if end == End::From { -self.d } else { self.d };
        let [mut a, mut b] = [0.25 * (self.c + d), 0.5 * self.c * other];
        let mut c = 0.25 * (self.c - d) * other * other + self.g;
        if is_own {
            a += self.h;
            b += self.f;
        } else {
            c += (self.h * other + self.f) * other;
        }
        [a, b, c]
    }

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
    /// The share of their torques that is planned with.
    share: f64,
}

impl<'a, A: Axes> Load<'a, A> {
    pub(super) fn new<D: Dynamics<Axes = A>>(
        limits: &'a TorqueLimits<D>,
        share: f64,
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
            share,
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
                torque / (motor.at(form.slope * part * sum) * self.share)
            } else {
                0.0
            };
            larger_or_nan(most, used)
        })
    }

    /// The largest W on the ray of r, up to which all motors have what it takes.
    pub(super) fn widest(&self, r: f64) -> f64 {
        self.each(r).fold(LARGEST, |widest, (form, motor, part)| {
            let speed = [0.0, form.slope.abs() * part];
            first_lack(
                form.on_ray(r, part),
                speed,
                form.either,
                self.motor(motor),
                widest,
            )
        })
    }

    /// The speed at one end that is nearest to `wanted` and up to which, from `known` on, all
    /// motors have what it takes, with the speed `other` at the other end.
    pub(super) fn farthest(&self, end: End, other: f64, [known, wanted]: [f64; 2]) -> f64 {
        let toward = 1.0_f64.copysign(wanted - known);
        let [from, to] = &self.ends;
        let (own, others) = if end == End::From {
            (from, to)
        } else {
            (to, from)
        };
        let mut way = (wanted - known).abs();
        for (forms, is_own) in [(own, true), (others, false)] {
            for (form, motor) in A::each(forms).iter().zip(A::each(self.motors)) {
                let [a, b, c] = form.beside(end, other, is_own);
                let from_known = [
                    a,
                    (2.0 * a * known + b) * toward,
                    (a * known + b) * known + c,
                ];
                let slope = form.slope.abs();
                let speed = if is_own {
                    [slope * known, slope * toward]
                } else {
                    [slope * other, 0.0]
                };
                way = first_lack(from_known, speed, form.either, self.motor(motor), way);
            }
        }
        known + way * toward
    }

    /// A motor, and the share of its torque up to which a limit is looked for.
    const fn motor<'m>(&self, motor: &'m TorqueCurve) -> (&'m TorqueCurve, f64) {
        (motor, self.share * (1.0 - ROUNDING))
    }
}

/// What is left of a torque, for rounding.
const ROUNDING: f64 = 1e-12;

/// The part of a `way` up to which |a u² + b u + c| is within what a share of a motor's torque has
/// left at the speed v + rate u.
fn first_lack(
    [a, b, c]: [f64; 3],
    [v, rate]: [f64; 2],
    taken: f64,
    (motor, share): (&TorqueCurve, f64),
    way: f64,
) -> f64 {
    let mut lack = way;
    // Beyond the last piece there is no torque.
    let mut last = 0.0;
    motor.each_piece(|[v0, v1], [t0, t1]| {
        let [begin, end] = if rate > 0.0 {
            [(v0 - v) / rate, (v1 - v) / rate]
        } else if rate < 0.0 {
            [(v1 - v) / rate, (v0 - v) / rate]
        } else if (v0..=v1).contains(&v) {
            [0.0, way]
        } else {
            return false;
        };
        let begin = larger(begin, 0.0);
        last = larger(last, end);
        if begin < smaller(end, lack) {
            let fall = if v1 > v0 {
                (t0 - t1) / (v1 - v0) * share
            } else {
                0.0
            };
            let left = t0 * share - fall * (v + rate * begin - v0) - taken;
            let (fall, slope) = (fall * rate, 2.0 * a * begin + b);
            let torque = (a * begin + b) * begin + c;
            let upper = first_root([a, slope + fall, torque - left]);
            let lower = first_root([-a, fall - slope, -torque - left]);
            let here = begin + smaller(upper, lower);
            if here < end {
                lack = smaller(lack, here);
            }
        }
        false
    });
    smaller(lack, last)
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
    let motions = [[zeros, zeros], [zeros, c], [zeros, d], [*slope, zeros]];
    let [rest, c, d, h] = dynamics.torques_of(position, &motions);
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

#[cfg(test)]
mod tests {
    use test_support::Random;

    use super::*;

    /// Places on a way that are looked at.
    const SAMPLES: u32 = 4000;

    /// Rounding of a torque.
    const CLOSE: f64 = 1e-9;

    /// A place where a lack shows.
    const BEYOND: f64 = 1.0 + 1e-6;

    /// Up to the place that is found a motor has what is asked, from there on it has not.
    #[test]
    fn a_lack_is_found_at_any_speed() {
        let mut random = Random::new(1);
        let mut found = 0;
        for _ in 0..500 {
            let points = [[0.0, 3.0], [1.0, 2.5], [1.5, 1.0], [4.0, 0.5]];
            let motor = TorqueCurve::from_points(&points).unwrap();
            let torque = [(); 3].map(|()| random.within(-1.5, 1.5));
            let way = random.within(0.1, 3.0);
            let from = random.within(0.0, 3.5);
            let to = random.within(0.0, 4.5);
            let speed = [from, (to - from) / way];
            let over = |u: f64| {
                let [a, b, c] = torque;
                let has = motor.at(speed[0] + speed[1] * u);
                ((a * u + b) * u + c).abs() + 0.1 - has
            };
            if over(0.0) > -CLOSE {
                continue;
            }
            let lack = first_lack(torque, speed, 0.1, (&motor, 1.0), way);
            assert!(lack > 0.0 && lack <= way);
            let sample = |n: u32| lack * f64::from(n) / f64::from(SAMPLES);
            assert!((0..=SAMPLES).all(|n| over(sample(n)) <= CLOSE));
            if lack < way {
                found += 1;
                assert!(over(lack * BEYOND) > 0.0, "{torque:?} {speed:?}");
            }
        }
        assert!(found > 100, "{found}");
    }
}
