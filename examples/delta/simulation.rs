//! The simulated machine: three steppers and the platform they carry. It gets steps and nothing
//! else; its way is then held against the lines that were asked for.

use std::io::BufRead;

use anyhow::{Context, Result};
use nalgebra::Point3;

use crate::machine::Machine;

/// A line that has been answered with `ok`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Asked {
    pub(crate) from: Point3<f64>,
    pub(crate) to: Point3<f64>,
    /// The steps that were answered.
    pub(crate) answer: [i32; 3],
}

/// What the simulated machine did.
#[derive(Default)]
pub(crate) struct Outcome {
    pub(crate) max_path_error_mm: f64,
    pub(crate) steps: u64,
    pub(crate) end: [i32; 3],
    /// The platform's way, thinned for the picture.
    pub(crate) way: Vec<Point3<f64>>,
}

/// Points of the picture's way are this far apart, in mm.
const SPACING_MM: f64 = 0.5;

pub(crate) fn run(
    machine: &Machine,
    asked: &[Asked],
    positions: impl Iterator<Item = Result<[i32; 3]>>,
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    outcome.way.push(machine.point([0; 3])?);
    let mut asked = asked.iter();
    let mut line = asked.next();
    for position in positions {
        let position = position?;
        let moved = position.iter().zip(outcome.end);
        outcome.steps += moved.map(|(a, b)| u64::from(a.abs_diff(b))).sum::<u64>();
        outcome.end = position;
        let point = machine.point(position)?;
        while let Some(now) = line {
            let off = distance(point, now.from, now.to);
            outcome.max_path_error_mm = outcome.max_path_error_mm.max(off);
            if position != now.answer {
                break;
            }
            line = asked.next();
            // A line that asks for no step ends where the one before did.
            if line.is_none_or(|next| next.answer != position) {
                break;
            }
        }
        if outcome
            .way
            .last()
            .is_none_or(|last| (point - last).norm() > SPACING_MM)
        {
            outcome.way.push(point);
        }
    }
    outcome.way.push(machine.point(outcome.end)?);
    Ok(outcome)
}

/// Distance of a point from the straight line between two others.
fn distance(point: Point3<f64>, from: Point3<f64>, to: Point3<f64>) -> f64 {
    let way = to - from;
    let square = way.norm_squared();
    let share = if square > 0.0 {
        ((point - from).dot(&way) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point - (from + way * share)).norm()
}

/// The positions of `steps.csv`, read again.
pub(crate) fn positions(file: impl BufRead) -> impl Iterator<Item = Result<[i32; 3]>> {
    file.lines().skip(1).map(|line| {
        let line = line?;
        let mut fields = line.split(',').skip(1).map(str::parse);
        let mut next = || fields.next().context("a column is missing");
        Ok([next()??, next()??, next()??])
    })
}
