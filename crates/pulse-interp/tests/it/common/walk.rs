//! Lines and arcs walked point by point, and how far the points are off.

use pulse_interp::{Arc, Line, Move, Rule};

pub(crate) type Path = Vec<[i32; 2]>;

pub(crate) fn after(at: [i32; 2], step: Move) -> [i32; 2] {
    [at[0] + step.dx(), at[1] + step.dy()]
}

/// The start and the point after each move.
pub(crate) fn path(from: [i32; 2], moves: impl IntoIterator<Item = Move>) -> Path {
    let along = moves.into_iter().scan(from, |at, step| {
        *at = after(*at, step);
        Some(*at)
    });
    core::iter::once(from).chain(along).collect()
}

/// The paths by the published rule, by the nearest one and of moves to eight neighbours; and how
/// many steps each of them tells.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Walked {
    pub(crate) paths: [Path; 3],
    pub(crate) told: [u64; 3],
}

impl Walked {
    pub(crate) fn line(line: &Line) -> Self {
        let (published, nearest) = (line.steps(Rule::Published), line.steps(Rule::Nearest));
        let moves = line.moves();
        Self {
            told: [
                published.remaining(),
                nearest.remaining(),
                moves.remaining(),
            ],
            paths: [
                path([0, 0], published),
                path([0, 0], nearest),
                path([0, 0], moves),
            ],
        }
    }

    pub(crate) fn arc(arc: &Arc) -> Self {
        let (published, nearest) = (arc.steps(Rule::Published), arc.steps(Rule::Nearest));
        let (moves, start) = (arc.moves(), arc.start());
        Self {
            told: [
                published.remaining(),
                nearest.remaining(),
                moves.remaining(),
            ],
            paths: [
                path(start, published),
                path(start, nearest),
                path(start, moves),
            ],
        }
    }

    /// Such paths, which tell as many steps as they have.
    pub(crate) fn telling(paths: [Path; 3]) -> Self {
        let told = [0, 1, 2].map(|of| paths[of].len() as u64 - 1);
        Self { paths, told }
    }
}

fn largest(of: impl Iterator<Item = f64>) -> f64 {
    of.fold(0.0, f64::max)
}

/// The largest distance from the line from (0, 0) to `to`.
pub(crate) fn off_line(path: &Path, to: [i32; 2]) -> f64 {
    let [xe, ye] = to.map(f64::from);
    let length = xe.hypot(ye).max(1.0);
    largest(
        path.iter()
            .map(|[x, y]| (f64::from(*y) * xe - f64::from(*x) * ye).abs() / length),
    )
}

/// The largest distance from the circle through `start`.
pub(crate) fn off_circle(path: &[[i32; 2]], start: [i32; 2]) -> f64 {
    let radius = |[x, y]: [i32; 2]| f64::from(x).hypot(f64::from(y));
    largest(path.iter().map(|at| (radius(*at) - radius(start)).abs()))
}
