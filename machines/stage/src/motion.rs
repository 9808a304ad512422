//! Programmed motions, lines and arcs, in mm.

use core::f64::consts::TAU;

use kurbo::{Point, Vec2};
use pulse_interp::Turn;

/// A programmed motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    pub(crate) from: Point,
    pub(crate) to: Point,
    pub(crate) shape: Shape,
    pub(crate) feed_mm_s: f64,
    pub(crate) is_rapid: bool,
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape {
    Line,
    Arc {
        centre: Point,
        turn: Turn,
        /// Angle around the centre, above 0 to a full turn.
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

/// Of a move that does not work, in mm/s.
pub(crate) const RAPID_MM_S: f64 = 50.0;

impl Motion {
    /// A straight move that does not work.
    pub(crate) const fn rapid(from: Point, to: Point) -> Self {
        Self {
            from,
            to,
            shape: Shape::Line,
            feed_mm_s: RAPID_MM_S,
            is_rapid: true,
        }
    }

    /// The same elsewhere.
    pub(crate) fn moved(self, by: Vec2) -> Self {
        let shape = match self.shape {
            Shape::Line => Shape::Line,
            Shape::Arc {
                centre,
                turn,
                sweep_rad,
            } => Shape::Arc {
                centre: centre + by,
                turn,
                sweep_rad,
            },
        };
        Self {
            from: self.from + by,
            to: self.to + by,
            shape,
            ..self
        }
    }

    /// How far a point is from the programmed curve, in mm.
    pub(crate) fn distance_mm(&self, at: Point) -> f64 {
        let to_ends = at.distance(self.from).min(at.distance(self.to));
        match self.shape {
            Shape::Line => {
                let line = self.to - self.from;
                let along = (at - self.from).dot(line) / line.hypot2();
                if (0.0..=1.0).contains(&along) {
                    at.distance(self.from + line * along)
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

    /// Unit vectors along the curve at both ends.
    pub(crate) fn directions(&self) -> [Vec2; 2] {
        match self.shape {
            Shape::Line => [unit(self.to - self.from); 2],
            Shape::Arc { centre, turn, .. } => [self.from, self.to].map(|at| {
                let Vec2 { x, y } = unit(at - centre);
                match turn {
                    Turn::CounterClockwise => Vec2::new(-y, x),
                    Turn::Clockwise => Vec2::new(y, -x),
                }
            }),
        }
    }

    /// Points of the curve, near enough for a picture.
    pub(crate) fn points(&self) -> Vec<Point> {
        /// Between two points of an arc.
        const STEP_RAD: f64 = TAU / 480.0;
        let Shape::Arc {
            centre,
            turn,
            sweep_rad,
        } = self.shape
        else {
            return vec![self.from, self.to];
        };
        let sign = match turn {
            Turn::CounterClockwise => 1.0,
            Turn::Clockwise => -1.0,
        };
        let (radius, begin) = (self.from.distance(centre), (self.from - centre).atan2());
        let angles = (0_u32..)
            .map(|k| f64::from(k) * STEP_RAD)
            .take_while(|angle| *angle < sweep_rad);
        angles
            .map(|angle| centre + Vec2::from_angle(begin + sign * angle) * radius)
            .chain([self.to])
            .collect()
    }
}

/// A vector's direction; along X where it has none.
fn unit(vector: Vec2) -> Vec2 {
    let length = vector.hypot();
    if length > 0.0 {
        vector / length
    } else {
        Vec2::new(1.0, 0.0)
    }
}
