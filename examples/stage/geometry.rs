//! Programmed lines and arcs, in mm.

use core::f64::consts::{FRAC_PI_2, TAU};

use kurbo::{Point, Vec2};
use pose2pulse::pulse_interp::Turn;

/// A programmed motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    pub(crate) from: Point,
    pub(crate) to: Point,
    pub(crate) shape: Shape,
    pub(crate) feed_mm_s: f64,
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape {
    Line,
    Arc {
        centre: Point,
        turn: Turn,
        /// Way around the centre, above 0 to a full turn.
        sweep_rad: f64,
    },
}

/// The angle from `from` on to `to`, in 0..TAU.
pub(crate) fn angle_on(centre: Point, from: Point, to: Point, turn: Turn) -> f64 {
    let angle = |at: Point| (at - centre).atan2();
    let on = angle(to) - angle(from);
    match turn {
        Turn::CounterClockwise => on.rem_euclid(TAU),
        Turn::Clockwise => (-on).rem_euclid(TAU),
    }
}

impl Motion {
    /// How far a point is from the programmed curve, in mm.
    pub(crate) fn distance_mm(&self, at: Point) -> f64 {
        let to_ends = at.distance(self.from).min(at.distance(self.to));
        match self.shape {
            Shape::Line => {
                let way = self.to - self.from;
                let along = (at - self.from).dot(way) / way.hypot2();
                if (0.0..=1.0).contains(&along) {
                    at.distance(self.from + way * along)
                } else {
                    to_ends
                }
            }
            Shape::Arc {
                centre,
                turn,
                sweep_rad,
            } => {
                let off = (at.distance(centre) - self.from.distance(centre)).abs();
                if angle_on(centre, self.from, at, turn) <= sweep_rad {
                    off.min(to_ends)
                } else {
                    to_ends
                }
            }
        }
    }

    /// The curve as the data of an SVG path.
    pub(crate) fn svg(&self) -> String {
        let Self { from, to, .. } = self;
        let start = format!("M{:.4} {:.4}", from.x, from.y);
        let Shape::Arc {
            centre,
            turn,
            sweep_rad,
        } = self.shape
        else {
            return format!("{start}L{:.4} {:.4}", to.x, to.y);
        };
        // In pieces of at most a quarter: a full turn is no arc to SVG.
        let radius = from.distance(centre);
        let sign = match turn {
            Turn::CounterClockwise => 1.0,
            Turn::Clockwise => -1.0,
        };
        let begin = (*from - centre).atan2();
        let mut path = start;
        for piece in 1..=4_u8 {
            let share = f64::from(piece) / 4.0;
            let at = centre + Vec2::from_angle(begin + sign * sweep_rad * share) * radius;
            let flag = u8::from(sign > 0.0);
            path += &format!(
                "A{radius:.4} {radius:.4} 0 0 {flag} {:.4} {:.4}",
                at.x, at.y
            );
        }
        debug_assert!(sweep_rad / 4.0 <= FRAC_PI_2 + 1e-9, "a piece is too long");
        path
    }
}
