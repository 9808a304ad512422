//! What one axis does between two rows.

use super::passage::Passage;
use crate::{Axes, Row};

/// The cubic of an axis by itself: in units of its duration q = q₀ + v₀ τ + b τ² + c τ³.
pub(super) struct Motion {
    v0: f64,
    b: f64,
    c: f64,
    duration_s: f64,
}

impl Motion {
    pub(super) fn new([q0, q1]: [f64; 2], [v0, v1]: [f64; 2], duration_s: f64) -> Self {
        let (rise, v0, v1) = (q1 - q0, v0 * duration_s, v1 * duration_s);
        Self {
            v0,
            b: 3.0 * rise - 2.0 * v0 - v1,
            c: v0 + v1 - 2.0 * rise,
            duration_s,
        }
    }

    /// The largest speed, at an end or where 2b + 6c τ = 0.
    pub(super) fn speed(&self) -> f64 {
        let at = |tau: f64| (self.v0 + (2.0 * self.b + 3.0 * self.c * tau) * tau).abs();
        let ends = at(0.0).max(at(1.0));
        let vertex = -self.b / (3.0 * self.c);
        let inside = if vertex > 0.0 && vertex < 1.0 {
            at(vertex)
        } else {
            0.0
        };
        ends.max(inside) / self.duration_s
    }

    pub(super) fn accelerations(&self) -> [f64; 2] {
        let square = self.duration_s * self.duration_s;
        [
            2.0 * self.b / square,
            (2.0 * self.b + 6.0 * self.c) / square,
        ]
    }
}

/// The accelerations of an axis at both ends that passing each of them at its speed asks for, by
/// what the path bends there.
pub(super) fn bends<A: Axes>(
    axis: usize,
    [from, to]: [&Row<A>; 2],
    [start, end]: &[Passage<A>; 2],
) -> [f64; 2] {
    let of_axis = |values: &A| of_axis(values, axis);
    let positions = [of_axis(&from.position), of_axis(&to.position)];
    let slopes = [of_axis(&start.slope), of_axis(&end.slope)];
    let at_speed = |speed: f64| {
        if speed <= 0.0 {
            return [0.0; 2];
        }
        let duration_s = to.duration_s * 0.5 * (start.speed + end.speed) / speed;
        let velocities = slopes.map(|slope| slope * speed);
        Motion::new(positions, velocities, duration_s).accelerations()
    };
    let ([at_start, _], [_, at_end]) = (at_speed(start.speed), at_speed(end.speed));
    [at_start, at_end]
}

/// The value of an axis.
pub(super) fn of_axis<A: Axes>(values: &A, axis: usize) -> f64 {
    values.as_slice().get(axis).copied().unwrap_or(0.0)
}
