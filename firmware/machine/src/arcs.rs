//! Arcs as G-code has them: the end, and the centre from where they begin.

use core::f64::consts::TAU;

use path_timing::{Curve, CurveError};
use trig_kernels::{atan2, sqrt};

use crate::command::Turn;

/// Ends at most so far from where the arc begins are there, in mm: it goes all round.
const ALL_ROUND_MM: f64 = 0.002;

/// Why there is no such arc.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NoArc {
    #[error("the end is {off:.4} mm off the circle, {allowed:.4} are allowed")]
    OffCircle { off: f64, allowed: f64 },
    #[error(transparent)]
    Curve(#[from] CurveError),
}

/// The arc in the plane of the first two coordinates, on the circle through its begin.
pub(crate) fn arc<const N: usize>(
    turn: Turn,
    from: [f64; N],
    to: [f64; N],
    to_centre: [f64; 2],
    allowed: f64,
) -> Result<Curve<N>, NoArc> {
    let mut centre = from;
    let (mut out, mut end) = ([0.0; 2], [0.0; 2]);
    for (axis, by) in to_centre.into_iter().enumerate() {
        centre[axis] += by;
        out[axis] = -by;
        end[axis] = to[axis] - centre[axis];
    }
    let length = |[x, y]: [f64; 2]| sqrt(x * x + y * y);
    let off = (length(end) - length(out)).abs();
    // Written so that NaN is refused too.
    let is_on_circle = off <= allowed;
    if !is_on_circle {
        return Err(NoArc::OffCircle { off, allowed });
    }
    let [x, y] = out;
    let (left, [end_x, end_y]) = match turn {
        Turn::CounterClockwise => ([-y, x], end),
        // In a mirror.
        Turn::Clockwise => ([y, -x], [end[0], -end[1]]),
    };
    let begin_y = if turn == Turn::Clockwise { -y } else { y };
    let angle = atan2(end_y, end_x) - atan2(begin_y, x);
    let angle = if angle < 0.0 { angle + TAU } else { angle };
    let is_all_round = length([end[0] - x, end[1] - y]) <= ALL_ROUND_MM;
    let mut direction = [0.0; N];
    direction[..2].copy_from_slice(&left);
    let angle = if is_all_round { TAU } else { angle };
    Ok(Curve::arc(from, centre, direction, angle)?)
}
