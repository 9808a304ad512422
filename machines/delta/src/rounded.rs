//! Lines with rounded corners, as fast as platform and motors may go: path-timing, then steps.

use anyhow::{Context, Result};
use delta_kin::DeltaPath;
use nalgebra::Point3;
use path_timing::{Curve, Path, Row, Smoothed, ToolLimits, Vertex, Waypoint};
use pvt_steps::{PvtQuantiser, PvtSteps};
use stepper_sync::{Direction, Rate, StepDirTiming};

use crate::machine::Machine;
use crate::plan::{TICKS_PER_S, ticks};
use crate::planned::Planned;
use crate::record::{Move, Record, TimedRow};

/// Vertices of the lines in sight at a time.
const VERTICES: usize = 32;
/// Room for the knots of a leg: so many, and one more for each of so many mm.
const KNOTS: f64 = 130.0;
const KNOT_MM: f64 = 0.25;

/// The paths along the lines.
#[derive(Debug, Default)]
struct Legs {
    paths: Vec<DeltaPath>,
    /// For each the indices of the moves on whose lines it begins and ends.
    moves: Vec<[usize; 2]>,
    /// How far they are from the lines at most.
    departure_mm: f64,
}

impl Legs {
    /// The moves on whose lines a leg begins, passes and ends.
    fn moves<'m>(&self, moves: &'m mut [Move], leg: usize) -> impl Iterator<Item = &'m mut Move> {
        let ends = self.moves.get(leg);
        let moves = ends.and_then(|[begin, end]| moves.get_mut(*begin..=*end));
        moves.into_iter().flatten()
    }

    /// The move on whose line a place is: those of a leg share its length.
    fn at(&self, leg: usize, s: f64) -> Option<usize> {
        let (path, [begin, end]) = (self.paths.get(leg)?, self.moves.get(leg)?);
        let length = path.length();
        let later = (*begin..*end).zip(1_u32..);
        let lines = f64::from(u32::try_from(end.saturating_sub(*begin)).ok()?) + 1.0;
        let passed = later.take_while(|(_, n)| f64::from(*n) / lines * length < s);
        Some(begin.saturating_add(passed.count()))
    }
}

/// Whether the machine can go along a line with room to both sides.
pub(crate) fn check(machine: &Machine, from: Point3<f64>, to: Point3<f64>) -> Result<()> {
    if from != to {
        machine.delta.path(Curve::line(from.into(), to.into())?)?;
    }
    Ok(())
}

/// Runs the lines of moves, from rest to rest: calls `step` with the time and the position after
/// each step, and records the rows, the times at which the moves end, or round their corners, and
/// what is proven of the motion.
pub(crate) fn run(
    machine: &Machine,
    record: &mut Record,
    mut step: impl FnMut(u64, [i32; 3]) -> Result<()>,
) -> Result<()> {
    let Record {
        moves,
        rows: run,
        departure_bound_mm,
        smoothed_bound_mm,
        shaped_bound_mm,
        delay_s,
        torque,
        ..
    } = record;
    let legs = legs(machine, moves)?;
    let knots = legs.paths.iter();
    let knots = knots.map(|path| KNOTS + path.length() / KNOT_MM);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates"
    )]
    let knots = knots.sum::<f64>() as usize;
    let planned = Planned::new(machine, &legs.paths, knots)?;
    *departure_bound_mm = Some(planned.departure_mm);
    *smoothed_bound_mm = Some(legs.departure_mm);
    *shaped_bound_mm = planned.shaped_mm;
    *delay_s = planned.delay_s;
    *torque = planned.torque;
    let mut rows = planned.rows.iter().copied();
    let Some(first) = rows.next() else {
        return Ok(());
    };
    let tick_rate = Rate::from_hz(TICKS_PER_S)?;
    let timing = StepDirTiming::DRV8825.min_intervals(tick_rate);
    let mut quantiser = PvtQuantiser::new(tick_rate, [machine.scale; 3], first.position)?;
    let mut steps = PvtSteps::new(quantiser.knots(), timing);
    let mut position = machine.steps(first.position.into())?;
    run.extend(moves.first().map(|begun| timed(&first, begun.line, None)));
    for row in rows {
        let begin_ticks = steps.end_ticks();
        steps.push(&quantiser.row(row.time_s, row.position, row.velocity)?)?;
        for edge in &mut steps {
            if let Some(position) = position.get_mut(edge.axis) {
                *position += match edge.direction {
                    Direction::Positive => 1,
                    Direction::Negative => -1,
                };
            }
            step(edge.ticks, position)?;
        }
        for it in legs.moves(moves, row.leg) {
            let [begin_ticks, _] = it.curves_ticks.unwrap_or([begin_ticks; 2]);
            it.curves_ticks = Some([begin_ticks, steps.end_ticks()]);
        }
        // The last row on a move is the latest.
        let ended = legs.at(row.leg, row.s);
        if let Some(ended) = ended.and_then(|it| moves.get_mut(it)) {
            ended.end_ticks = steps.end_ticks();
            let tool = legs.paths.get(row.leg).and_then(DeltaPath::tool);
            run.push(timed(&row, ended.line, tool));
        }
    }
    // A move that goes nowhere ends with the one before.
    let delay_ticks = ticks(planned.delay_s);
    let mut last = 0;
    for it in moves {
        it.end_ticks = it.end_ticks.max(last);
        last = it.end_ticks;
        if let Some([_, end_ticks]) = &mut it.curves_ticks {
            *end_ticks += delay_ticks;
        }
    }
    Ok(())
}

/// A row as it is recorded.
fn timed(row: &Row<[f64; 3]>, line: usize, tool: Option<ToolLimits>) -> TimedRow {
    TimedRow {
        time_s: row.time_s,
        position_rad: row.position,
        velocity_rad_s: row.velocity,
        line,
        feed_mm_s: tool.map_or(f64::INFINITY, |tool| tool.feed),
        acceleration_mm_s2: tool.and_then(|tool| tool.acceleration),
    }
}

/// The curves along the lines, each at the feed of its move.
fn legs(machine: &Machine, moves: &[Move]) -> Result<Legs> {
    let start = moves
        .iter()
        .take(1)
        .map(|first| Waypoint::from(<[f64; 3]>::from(first.from)));
    let points = start.chain(moves.iter().map(|it| Waypoint {
        point: it.to.into(),
        tool: Some(ToolLimits {
            feed: it.feed_mm_s,
            acceleration: Some(machine.acceleration_mm_s2),
        }),
    }));
    let mut memory = [Vertex::default(); VERTICES];
    let mut curves = Smoothed::new(points, machine.rounded_mm()?, &mut memory)?;
    let mut legs = Legs::default();
    for curve in curves.by_ref() {
        let curve: Curve<3> = curve?;
        let [begin, end] = curve.between().context("a curve of no points")?;
        let path = machine.delta.path(curve);
        legs.paths
            .push(path.with_context(|| format!("move {end}"))?);
        // Point 0 is the start, point 1 the end of the first move.
        legs.moves.push([begin, end.saturating_sub(1)]);
    }
    legs.departure_mm = curves.departure();
    Ok(legs)
}
