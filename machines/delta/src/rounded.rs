//! Lines with rounded corners, as fast as platform and motors may go: path-timing, then steps.

use anyhow::{Context, Result};
use delta_kin::DeltaPath;
use nalgebra::Point3;
use path_timing::{Accuracy, Curve, Knot, Path, Rounded, Table, ToolLimits};
use stepper_sync::{Direction, PvtQuantiser, PvtSteps, Rate, StepDirTiming};

use crate::machine::Machine;
use crate::plan::TICKS_PER_S;
use crate::record::Move;
use crate::simulation::distance;

/// Segments of a leg at the least: a change of speed takes some of them.
const LEAST_SEGMENTS: u32 = 64;
/// Room for the knots of a leg: so many, and one more for each of so many mm.
const KNOTS: f64 = 130.0;
const KNOT_MM: f64 = 0.25;

/// What a point of a line may be off it, in roundings of the machine's lengths.
const ROUNDING: f64 = 100.0;

/// The paths of the lines and of the rounded corners between them.
#[derive(Debug, Default)]
struct Legs {
    paths: Vec<DeltaPath>,
    /// For each the index of the move whose line it is, or with whose end it begins.
    lines: Vec<usize>,
}

/// Whether the machine can go along a line with room to both sides.
pub(crate) fn check(machine: &Machine, from: Point3<f64>, to: Point3<f64>) -> Result<()> {
    if from != to {
        machine.delta.path(Curve::line(from.into(), to.into())?)?;
    }
    Ok(())
}

/// Runs the lines of moves, from rest to rest: calls `step` with the time and the position after
/// each step, and sets the times at which the moves end, or round their corners. Returns a proven bound
/// on how far the platform leaves its lines and their rounded corners between steps, in mm.
pub(crate) fn run(
    machine: &Machine,
    moves: &mut [Move],
    mut step: impl FnMut(u64, [i32; 3]) -> Result<()>,
) -> Result<f64> {
    let legs = legs(machine, moves)?;
    let knots = legs.paths.iter();
    let knots = knots.map(|path| KNOTS + path.length() / KNOT_MM);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates"
    )]
    let knots = knots.sum::<f64>() as usize;
    let mut knots = vec![Knot::default(); knots];
    let table = Table::plan_within(
        legs.paths.iter(),
        machine.axis_limits(),
        Accuracy {
            min_segments: LEAST_SEGMENTS,
            max_departure: machine.tolerance_mm,
            max_time_ratio: f64::INFINITY,
        },
        |path, span| path.departure(span),
        &mut knots,
    )?;

    let mut rows = table.rows();
    let Some(first) = rows.next() else {
        return Ok(0.0);
    };
    let tick_rate = Rate::from_hz(TICKS_PER_S)?;
    let timing = StepDirTiming::DRV8825.min_intervals(tick_rate);
    let mut quantiser = PvtQuantiser::new(tick_rate, [machine.scale; 3], first.position)?;
    let mut steps = PvtSteps::new(quantiser.knots(), timing);
    let mut position = machine.steps(first.position.into())?;
    for row in rows {
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
        // The last row of a leg is the latest.
        let ended = legs.lines.get(row.leg).copied();
        if let Some(ended) = ended.and_then(|line| moves.get_mut(line)) {
            ended.end_ticks = steps.end_ticks();
        }
    }
    // A move that goes nowhere ends with the one before.
    let mut last = 0;
    for it in moves {
        it.end_ticks = it.end_ticks.max(last);
        last = it.end_ticks;
    }
    let departures = table.spans().filter_map(|span| {
        let [_, to] = &span.rows;
        Some(legs.paths.get(to.leg)?.departure(&span))
    });
    Ok(departures.fold(0.0, f64::max))
}

/// The lines and the rounded corners between them, each at the feed of its move; a corner at the
/// lower one of both.
fn legs(machine: &Machine, moves: &[Move]) -> Result<Legs> {
    let start = moves.iter().take(1).map(|first| first.from);
    let points = start.chain(moves.iter().map(|it| it.to));
    let mut lines = moves.iter().enumerate().filter(|(_, it)| it.from != it.to);
    let mut line = lines.next();
    let mut legs = Legs::default();
    for curve in Rounded::new(points.map(Into::into), machine.corner_mm)? {
        let curve: Curve<3> = curve?;
        let (index, now) = line.context("a curve behind the last line")?;
        let end = Point3::from(curve.end());
        let mut feed_mm_s = now.feed_mm_s;
        if distance(end, now.from, now.to) > ROUNDING * machine.delta.tolerance() {
            line = lines.next();
            let (_, next) = line.context("a corner behind the last line")?;
            feed_mm_s = feed_mm_s.min(next.feed_mm_s);
        } else if end == now.to {
            line = lines.next();
        }
        let tool = ToolLimits {
            feed: feed_mm_s,
            acceleration: Some(machine.acceleration_mm_s2),
        };
        let path = machine.delta.path(curve.with_tool(tool));
        legs.paths
            .push(path.with_context(|| format!("the corner at the end of move {}", index + 1))?);
        legs.lines.push(index);
    }
    Ok(legs)
}
