//! What is drawn: between 10 and 110 mm across, 10 and 90 mm high.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

/// A part of a drawing, from where the one before has ended.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Part {
    /// Without drawing.
    Rapid([f64; 2]),
    Line([f64; 2]),
    Arc {
        to: [f64; 2],
        centre: [f64; 2],
        is_clockwise: bool,
    },
}

impl Part {
    pub(crate) const fn to(&self) -> [f64; 2] {
        match self {
            Self::Rapid(to) | Self::Line(to) | Self::Arc { to, .. } => *to,
        }
    }

    /// Of an arc, its word and where its centre is from its start.
    pub(crate) fn arc(&self, from: [f64; 2]) -> Option<(&'static str, [f64; 2])> {
        match self {
            Self::Arc {
                centre: [x, y],
                is_clockwise,
                ..
            } => Some((
                if *is_clockwise { "G2" } else { "G3" },
                [x - from[0], y - from[1]],
            )),
            _ => None,
        }
    }

    /// As the ends of lines, on an arc half a millimetre apart.
    pub(crate) fn points(&self, from: [f64; 2]) -> Vec<[f64; 2]> {
        let Self::Arc {
            to,
            centre,
            is_clockwise,
        } = self
        else {
            return vec![self.to()];
        };
        let angle = |of: [f64; 2]| (of[1] - centre[1]).atan2(of[0] - centre[0]);
        let radius = (from[0] - centre[0]).hypot(from[1] - centre[1]);
        let (start, turn) = (angle(from), angle(*to) - angle(from));
        let turn = if *is_clockwise {
            -((-turn).rem_euclid(TAU))
        } else {
            turn.rem_euclid(TAU)
        };
        let count = (turn.abs() * radius / 0.5).ceil().max(1.0);
        let places = (1..).map(f64::from).take_while(|n| *n < count);
        let mut points: Vec<_> = places
            .map(|n| {
                let (sin, cos) = (start + turn * n / count).sin_cos();
                [centre[0] + radius * cos, centre[1] + radius * sin]
            })
            .collect();
        points.push(*to);
        points
    }
}

/// Four drawings, each closed at its first point.
pub(crate) fn drawings() -> [(&'static str, Vec<Part>); 4] {
    [
        ("star", star()),
        ("slots", slots()),
        ("gear", gear()),
        ("pocket", pocket()),
    ]
}

fn polar(centre: [f64; 2], radius: f64, angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [centre[0] + radius * cos, centre[1] + radius * sin]
}

/// Long lines with sharp corners.
fn star() -> Vec<Part> {
    let point = |n: u32| {
        polar(
            [60.0, 50.0],
            35.0,
            FRAC_PI_2 + f64::from(n) * 2.0 * TAU / 5.0,
        )
    };
    let lines = (1..=5).map(|n| Part::Line(point(n)));
    core::iter::once(Part::Rapid(point(0)))
        .chain(lines)
        .collect()
}

/// Three slots of two lines and two arcs, from one to the next by a rapid move.
fn slots() -> Vec<Part> {
    let slot = |n: u32| {
        let y = 25.0 + 25.0 * f64::from(n);
        let (left, right, radius) = (30.0, 90.0, 8.0);
        let arc = |x: f64, to: f64| Part::Arc {
            to: [x, to],
            centre: [x, y],
            is_clockwise: n == 1,
        };
        let (low, high) = if n == 1 {
            (radius, -radius)
        } else {
            (-radius, radius)
        };
        [
            Part::Rapid([left, y + low]),
            Part::Line([right, y + low]),
            arc(right, y + high),
            Part::Line([left, y + high]),
            arc(left, y + low),
        ]
    };
    (0..3).flat_map(slot).collect()
}

/// The outline of a gear as points of a CAM program, a quarter to half a millimetre apart.
fn gear() -> Vec<Part> {
    let point = |n: u32| {
        let angle = f64::from(n) * TAU / 720.0;
        let tooth = (12.0 * angle).sin();
        polar([60.0, 50.0], 30.0 + 3.0 * (2.5 * tooth).tanh(), angle)
    };
    let lines = (1..=720).map(|n| Part::Line(point(n)));
    core::iter::once(Part::Rapid(point(0)))
        .chain(lines)
        .collect()
}

/// A pocket, cleared from side to side, and its wall with rounded corners.
fn pocket() -> Vec<Part> {
    let mut parts = vec![Part::Rapid([32.0, 32.0])];
    for row in 0..12_u32 {
        let y = 32.0 + 3.0 * f64::from(row);
        let ends = if row % 2 == 0 {
            [32.0, 88.0]
        } else {
            [88.0, 32.0]
        };
        parts.extend(ends.map(|x| Part::Line([x, y])));
    }
    parts.push(Part::Rapid([35.0, 30.0]));
    let corners = [[85.0, 35.0], [85.0, 65.0], [35.0, 65.0], [35.0, 35.0]];
    for (centre, quarter) in corners.into_iter().zip([3.0, 0.0, 1.0, 2.0]) {
        let [start, end] = [quarter, quarter + 1.0].map(|of| polar(centre, 5.0, of * PI * 0.5));
        parts.push(Part::Line(start));
        parts.push(Part::Arc {
            to: end,
            centre,
            is_clockwise: false,
        });
    }
    parts
}
