//! Arcs as G-code programs them, in the plane of the table or upright.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use anyhow::{Result, bail, ensure};
use kurbo::Point;
use pulse_interp::Turn;

use crate::motion::angle_on;

/// How far the end of an arc may be from its circle, in mm.
pub(crate) const ARC_TOLERANCE_MM: f64 = 0.02;
/// Start and end of a full circle, which may come from inches.
pub(crate) const SAME_MM: f64 = 1e-6;

/// How a program says where the centre is, in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Centre {
    /// In each coordinate from the start; 0 where nothing is said.
    FromStart([Option<f64>; 2]),
    At(Point),
    Radius(f64),
}

/// An arc in the two coordinates of its plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arc {
    from: Point,
    to: Point,
    turn: Turn,
    pub(crate) centre: Point,
    /// Angle around the centre, above 0 to a full turn.
    pub(crate) sweep_rad: f64,
}

impl Arc {
    pub(crate) fn new(from: Point, to: Point, turn: Turn, centre: Centre) -> Result<Self> {
        let centre = match centre {
            Centre::Radius(radius) => centre_of(from, to, turn, radius)?,
            Centre::At(centre) => centre,
            Centre::FromStart([None, None]) => bail!("an arc without I, J or R"),
            Centre::FromStart([i, j]) => {
                // What is not said is 0 by definition.
                Point::new(from.x + i.unwrap_or(0.0), from.y + j.unwrap_or(0.0))
            }
        };
        let (radius, end) = (from.distance(centre), to.distance(centre));
        ensure!(radius > 0.0, "an arc about its own start");
        let off = end - radius;
        ensure!(
            off.abs() <= ARC_TOLERANCE_MM,
            "the end ({:.3}, {:.3}) is {:.3} mm {} the circle of radius {radius:.3} mm about \
             ({:.3}, {:.3}); {ARC_TOLERANCE_MM} mm are allowed",
            to.x,
            to.y,
            off.abs(),
            if off > 0.0 { "outside" } else { "inside" },
            centre.x,
            centre.y
        );
        let sweep = angle_on(centre, from, to, turn);
        Ok(Self {
            from,
            to,
            turn,
            centre,
            sweep_rad: if from.distance(to) < SAME_MM {
                TAU
            } else {
                sweep
            },
        })
    }

    /// By how much the arc goes beyond both its ends in a coordinate, 0 or 1.
    pub(crate) fn overshoot_mm(&self, coordinate: usize) -> f64 {
        let along = |at: Point| if coordinate == 0 { at.x } else { at.y };
        let middle = along(self.centre);
        let ends = [self.from, self.to].map(|at| along(at) - middle);
        let radius = self.from.distance(self.centre);
        let begin = (self.from - self.centre).atan2();
        // Where the circle turns back, and on which side of the centre that is.
        let first = if coordinate == 0 { 0.0 } else { FRAC_PI_2 };
        let beyond = [(first, 1.0), (first + PI, -1.0)].map(|(extreme, sign)| {
            let on = match self.turn {
                Turn::CounterClockwise => extreme - begin,
                Turn::Clockwise => begin - extreme,
            };
            if on.rem_euclid(TAU) < self.sweep_rad {
                let [a, b] = ends.map(|end| sign * end);
                radius - a.max(b)
            } else {
                0.0
            }
        });
        beyond.into_iter().fold(0.0, f64::max)
    }
}

/// The centre of an arc given by its radius: the shorter arc, the longer if it is negative.
fn centre_of(from: Point, to: Point, turn: Turn, radius: f64) -> Result<Point> {
    let (chord, half) = (to - from, from.distance(to) / 2.0);
    ensure!(half > 0.0, "a full circle by R: its centre can be anywhere");
    ensure!(
        half <= radius.abs() + ARC_TOLERANCE_MM / 2.0,
        "R{radius:.3} is too short: start and end are {:.3} mm apart",
        2.0 * half
    );
    let height = (radius * radius - half * half).max(0.0).sqrt();
    // To the left of the chord for the shorter arc counter-clockwise.
    let left = (turn == Turn::CounterClockwise) == (radius > 0.0);
    let aside = chord.turn_90() / chord.hypot() * if left { height } else { -height };
    Ok(from.midpoint(to) + aside)
}
