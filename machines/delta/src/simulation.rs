//! The simulated machine: three steppers and the platform they carry. It gets steps and nothing
//! else; its path is then compared with the lines that were asked for.

use std::io::BufRead;

use anyhow::Result;
use machine_sim::{Figure, MotionSampler};
use nalgebra::Point3;

use crate::control_tick;
use crate::machine::Machine;
use crate::picture;
use crate::plan::seconds;
use crate::record::{Move, Record};
use crate::report::Report;
use crate::step_log;

/// Between two points of a picture's path, in mm.
const SPACING_MM: f64 = 0.5;

/// What the simulated machine did, driven by the steps, and by the thesis' control tick.
#[derive(Debug, Clone)]
pub struct Run<'a> {
    pub(crate) machine: &'a Machine,
    pub(crate) record: &'a Record,
    pub(crate) trains: Driven,
    pub(crate) ticked: Driven,
    pub(crate) ticks: u32,
    pub(crate) motion: MotionSampler<3>,
}

/// What the simulated machine did in one of both.
#[derive(Debug, Clone, Default)]
pub(crate) struct Driven {
    pub(crate) max_path_error_mm: f64,
    /// Of all motors, either way.
    pub(crate) steps: u64,
    /// Steps from home at the end.
    pub(crate) end: [i32; 3],
    /// The platform's path, thinned for a picture.
    pub(crate) path: Vec<Point3<f64>>,
}

impl Run<'_> {
    /// The numbers.
    #[must_use]
    pub fn report(&self) -> Report {
        Report::new(self)
    }

    /// Workspace, mechanism and paths, and the platform's speed and acceleration, as an SVG figure.
    ///
    /// # Errors
    /// The machine has no workspace around its path.
    pub fn picture(&self) -> Result<Figure> {
        picture::picture(self)
    }
}

/// Moves a simulated machine by the steps of a [`StepLog`](crate::StepLog).
///
/// # Errors
/// The table cannot be read, or no platform is where its steps lead.
pub fn simulate<'a>(
    machine: &'a Machine,
    record: &'a Record,
    steps: impl BufRead,
) -> Result<Run<'a>> {
    let duration_s = seconds(record.duration_ticks());
    let mut motion = MotionSampler::new(machine.point([0; 3])?.into());
    let trains = follow(machine, &record.moves, step_log::read(steps), |t_s, at| {
        motion.add(t_s, at.into());
    })?;
    motion.end(duration_s);
    let mut ticks = 0;
    let ends = record.moves.iter().map(|it| it.end);
    let after_ticks = control_tick::positions(ends).inspect(|_| ticks += 1);
    let after_ticks = core::iter::once([0; 3]).chain(after_ticks);
    // The controller's time is the number of its ticks.
    let positions = after_ticks.map(|position| Ok((0.0, position)));
    let ticked = follow(machine, &record.moves, positions, |_, _| {})?;
    Ok(Run {
        machine,
        record,
        trains,
        ticked,
        ticks,
        motion,
    })
}

/// Follows times in s and positions from home on.
fn follow(
    machine: &Machine,
    moves: &[Move],
    positions: impl Iterator<Item = Result<(f64, [i32; 3])>>,
    mut observe: impl FnMut(f64, Point3<f64>),
) -> Result<Driven> {
    let mut driven = Driven::default();
    driven.path.push(machine.point([0; 3])?);
    let mut moves = moves.iter();
    let mut line = moves.next();
    for position in positions {
        let (t_s, position) = position?;
        let moved = position.iter().zip(driven.end);
        driven.steps += moved.map(|(a, b)| u64::from(a.abs_diff(b))).sum::<u64>();
        driven.end = position;
        let point = machine.point(position)?;
        observe(t_s, point);
        while let Some(now) = line {
            let off = distance(point, now.from, now.to);
            driven.max_path_error_mm = driven.max_path_error_mm.max(off);
            if position != now.end {
                break;
            }
            line = moves.next();
            // A line that asks for no step ends where the one before did.
            if line.is_none_or(|next| next.end != position) {
                break;
            }
        }
        let last = driven.path.last();
        if last.is_none_or(|last| (point - last).norm() > SPACING_MM) {
            driven.path.push(point);
        }
    }
    driven.path.push(machine.point(driven.end)?);
    Ok(driven)
}

/// Distance of a point from the straight line between two others.
fn distance(point: Point3<f64>, from: Point3<f64>, to: Point3<f64>) -> f64 {
    let line = to - from;
    let square = line.norm_squared();
    let fraction = if square > 0.0 {
        ((point - from).dot(&line) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point - (from + line * fraction)).norm()
}
