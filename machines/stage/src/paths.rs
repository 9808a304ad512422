//! From programmed motions to paths of whole steps.

use core::f64::consts::{PI, TAU};

use anyhow::{Context, Result};
use kurbo::Point;
use pulse_interp::{
    Arc, ArcMoves, ArcSteps, Factor, Line, LineMoves, LineSteps, Move, Rule, StepIntervals,
};

use crate::gcode::ARC_TOLERANCE_MM;
use crate::grid::{STEPS_PER_MM, TICKS_PER_S, to_mm, to_steps};
use crate::motion::{Motion, Shape, angle_on};

/// Which axis steps next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum PathRule {
    /// One axis at a time, as published.
    Published,
    /// One axis at a time, with half the deviation.
    #[default]
    Nearest,
    /// Both axes where due: Bresenham's line, the midpoint arc.
    Bresenham,
}

impl PathRule {
    /// Its name on a command line.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Published => "published",
            Self::Nearest => "nearest",
            Self::Bresenham => "bresenham",
        }
    }
}

/// A path of steps with the factor of each interval.
pub(crate) enum Path {
    LineSteps(LineSteps, Factor),
    LineMoves(LineMoves, Factor),
    ArcSteps(ArcSteps),
    ArcMoves(ArcMoves),
}

impl Iterator for Path {
    type Item = (Move, Factor);

    fn next(&mut self) -> Option<(Move, Factor)> {
        // The factor is that of the step to come.
        let (factor, step) = match self {
            Self::LineSteps(steps, factor) => (*factor, steps.next()),
            Self::LineMoves(moves, factor) => (*factor, moves.next()),
            Self::ArcSteps(steps) => (steps.factor(), steps.next()),
            Self::ArcMoves(moves) => (moves.factor(), moves.next()),
        };
        step.map(|step| (step, factor))
    }
}

/// The paths of a motion from where the stage was last commanded to.
///
/// Ends are rounded from absolute positions, so that rounding never adds up. Centres are rounded
/// too, and the end, which is then near the circle only, is met axis by axis.
pub(crate) fn paths(motion: &Motion, from: [i32; 2], rule: PathRule) -> Result<Vec<Path>> {
    let to = to_steps(motion.to);
    let Shape::Arc {
        centre,
        turn,
        sweep_rad,
    } = motion.shape
    else {
        return Ok(vec![line(from, to, rule)?]);
    };
    let radius = motion.from.distance(centre);
    let centre = grid_centre(centre, radius, from);
    if centre == from || centre == to {
        // Less than two steps across.
        return Ok(vec![line(from, to, rule)?]);
    }
    let rounded_rad = match angle_on(to_mm(centre), to_mm(from), to_mm(to), turn) {
        _ if from == to => TAU,
        angle => angle,
    };
    // Ends that pass each other when they are rounded make a turn of a dot, and a dot of a turn.
    let end = if rounded_rad - sweep_rad > PI {
        return Ok(vec![line(from, to, rule)?]);
    } else if sweep_rad - rounded_rad > PI {
        from
    } else {
        to
    };
    let about = |[x, y]: [i32; 2]| [x - centre[0], y - centre[1]];
    // Start and end are rounded by up to 0.7071 steps each, the centre counts for both, and may be
    // another than the nearest: less than 6 in all. The program has a tolerance of its own.
    const ROUNDED_MILLISTEPS: f64 = 6000.0;
    let tolerance = ROUNDED_MILLISTEPS + ARC_TOLERANCE_MM * STEPS_PER_MM * 1000.0;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "8000"
    )]
    let arc = Arc::near(about(from), about(end), turn, tolerance as u32);
    let arc = arc.with_context(|| format!("an arc of radius {radius:.4} mm"))?;
    let path = match rule {
        PathRule::Published => Path::ArcSteps(arc.steps(Rule::Published)),
        PathRule::Nearest => Path::ArcSteps(arc.steps(Rule::Nearest)),
        PathRule::Bresenham => Path::ArcMoves(arc.moves()),
    };
    Ok(vec![path, line(end, to, rule)?])
}

/// The steps of a motion at its feed from the first to the last, as published: the ticks before
/// each.
pub(crate) fn at_feed(
    motion: &Motion,
    from: [i32; 2],
    rule: PathRule,
) -> Result<impl Iterator<Item = Result<(u64, Move)>>> {
    // Rates are bounded by the parser: 100 to 60 million ticks.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "bounded"
    )]
    let unit = (f64::from(TICKS_PER_S) / (motion.feed_mm_s * STEPS_PER_MM)).round() as u32;
    let mut intervals = StepIntervals::new(unit);
    let steps = paths(motion, from, rule)?.into_iter().flatten();
    Ok(steps.map(move |(step, factor)| {
        let ticks = intervals.next(factor).context("intervals have no end")?;
        Ok((ticks, step))
    }))
}

/// The grid point about which the circle through the grid point `from` is nearest to that
/// programmed, of those around the centre. In mm, but for `from`.
fn grid_centre(centre: Point, radius: f64, from: [i32; 2]) -> [i32; 2] {
    let off = |at: &[i32; 2]| {
        let at = to_mm(*at);
        at.distance(centre) + (at.distance(to_mm(from)) - radius).abs()
    };
    let [x, y] = to_steps(centre);
    let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
    around
        .min_by(|a, b| off(a).total_cmp(&off(b)))
        .unwrap_or([x, y])
}

fn line(from: [i32; 2], to: [i32; 2], rule: PathRule) -> Result<Path> {
    let line = Line::new([to[0] - from[0], to[1] - from[1]])?;
    Ok(match rule {
        PathRule::Published => Path::LineSteps(line.steps(Rule::Published), line.step_factor()),
        PathRule::Nearest => Path::LineSteps(line.steps(Rule::Nearest), line.step_factor()),
        PathRule::Bresenham => Path::LineMoves(line.moves(), line.move_factor()),
    })
}
