//! Looking at all of a curve before it is a path.

use path_timing::{Curve, CurveMotion, Path};

use super::corridor::Beside;
use super::stretch::{ROUNDING, Stretch};
use super::turns::{MAX_TURN, Turns, at_turns};
use super::{MachinePath, PathError};
use crate::matrix::{Enclosure, norm};
use crate::{Axis, Interval, Machine, Number};

/// Shortest piece of a curve, as a fraction of it: what is undecided then is refused.
const MIN_PIECE: f64 = 1e-9;

/// Longest piece, as a part of the path's size.
const MAX_PIECE: f64 = 1.0 / 16.0;

/// Pieces that are longer are halved where it is not known what is beside them, as well.
const WELL: f64 = 1.0 / 256.0;

/// Nearest to the end of the branch and to singular poses that a path may come, in each coordinate,
/// as a fraction of its size.
const EDGE: f64 = 1e-6;

/// A place within this many times [`EDGE`] of the end of the branch is reported as that end.
const NEXT: f64 = 100.0;

impl<M: Machine<N>, const N: usize> MachinePath<M, N> {
    pub(crate) fn new(
        machine: M,
        curve: Curve<N>,
        branch: M::Branch,
        previous: [f64; N],
    ) -> Result<Self, PathError<N>> {
        let axes = machine.axes();
        check_ranges(&axes)?;
        let size = curve.length() + norm(&curve.start()).max(norm(&curve.end()));
        let mut path = Self {
            machine,
            axes,
            curve,
            branch,
            turns: Turns::new(previous),
            corner: Path::corner(&curve).of_other_axes(),
            rounding: size * ROUNDING,
            beside: None,
        };
        let mut survey = Survey {
            size,
            least: curve.length() * MIN_PIECE,
            beside: Some(Beside::NONE),
        };
        let start = survey.positions(&path, 0.0, &previous)?;
        path.turns = Turns::new(start);
        let (mut s, mut positions, mut step) = (0.0, start, curve.length());
        while s < curve.length() {
            (s, positions, step) = survey.advance(&path, s, &positions, step)?;
            if !path.turns.add(s, &axes, &positions) {
                return Err(PathError::Turns { s });
            }
        }
        path.beside = survey.beside;
        Ok(path)
    }
}

/// Refuses ranges of axes that are none.
fn check_ranges<const N: usize>(axes: &[Axis; N]) -> Result<(), PathError<N>> {
    for axis in axes {
        // Written so that NaN is refused too.
        let is_range = axis.min <= axis.max;
        if !is_range {
            let Axis { name, min, max, .. } = *axis;
            let axis = name;
            return Err(PathError::Range { axis, min, max });
        }
    }
    Ok(())
}

/// Walks along a curve before it is a path.
struct Survey<const N: usize> {
    /// Of the path.
    size: f64,
    /// Shortest piece.
    least: f64,
    /// What is known beside the path so far.
    beside: Option<Beside<N>>,
}

impl<const N: usize> Survey<N> {
    /// The positions at a place, each angle at the turn nearest to `near`.
    fn positions<M: Machine<N>>(
        &self,
        path: &MachinePath<M, N>,
        s: f64,
        near: &[f64; N],
    ) -> Result<[f64; N], PathError<N>> {
        let point = path.curve.at(s).point;
        let found = path.slopes_at(point);
        let (positions, _) = found.map_err(|reason| PathError::Unreachable { s, point, reason })?;
        Ok(at_turns(&path.axes, positions, near))
    }

    /// The next place of the survey, the positions there, and the length of the piece to try next.
    /// Shorter pieces lead up to the first place that is refused.
    fn advance<M: Machine<N>>(
        &mut self,
        path: &MachinePath<M, N>,
        s: f64,
        positions: &[f64; N],
        mut step: f64,
    ) -> Result<(f64, [f64; N], f64), PathError<N>> {
        step = step.min(self.size * MAX_PIECE);
        loop {
            let next = (s + step).min(path.curve.length());
            let there = self.piece(path, [s, next], positions).and_then(|beside| {
                let positions = self.positions(path, next, positions)?;
                Ok((beside, positions))
            });
            match there {
                Ok((beside, there)) => {
                    self.beside = beside;
                    return Ok((next, there, step * 2.0));
                }
                Err(error) if step <= self.least => return Err(self.named(path, error)),
                Err(_) => step *= 0.5,
            }
        }
    }

    /// What is singular next to the end of the branch, as that.
    fn named<M: Machine<N>>(&self, path: &MachinePath<M, N>, error: PathError<N>) -> PathError<N> {
        let PathError::Singular { s, point } = error else {
            return error;
        };
        let mut around = point.map(Interval::from);
        let beside = Interval::around(0.0, self.size * EDGE * NEXT);
        for place in &mut around {
            *place = *place + beside;
        }
        let axes = path.machine.inverse(around, path.branch);
        axes.map_or_else(
            |reason| PathError::BranchEnds { s, point, reason },
            |_| error,
        )
    }

    /// What is known beside the path with another piece of it, of which nothing is out of reach,
    /// singular, or beyond a range.
    fn piece<M: Machine<N>>(
        &self,
        path: &MachinePath<M, N>,
        s: [f64; 2],
        near: &[f64; N],
    ) -> Result<Option<Beside<N>>, PathError<N>> {
        let [from, to] = s;
        let motion = CurveMotion::evenly(&path.curve, s);
        let stretch = Stretch::new(&motion, [0.0, 1.0], path.rounding);
        if let Some(beyond) = path.beyond_area(&stretch.places(), &[0.0; N], s) {
            return Err(beyond);
        }
        let (point, s_from) = (path.curve.at(from).point, from);
        let refused = |reason| PathError::BranchEnds {
            s: s_from,
            point,
            reason,
        };
        let beside = self.beside.and_then(|before| {
            let next = path.look_beside(&stretch, self.size)?;
            Some(before.and(&next))
        });
        let edge = self.size * EDGE;
        if beside.is_none_or(|beside| beside.corridor.radius < edge) {
            let around = path.around(&stretch, &[edge; N]).map_err(refused)?;
            let is_regular = Enclosure::new(around.jacobian()).is_some();
            // Of shorter pieces more is known.
            let is_long = self.beside.is_some() && to - from > self.size * WELL;
            if !is_regular || is_long {
                return Err(PathError::Singular { s: from, point });
            }
        }
        let positions = path.axes(&stretch).map_err(refused)?;
        let axes = path.axes.iter().zip(near);
        for (position, (axis, near)) in positions.into_iter().zip(axes) {
            let position = position.range();
            let apart = position.middle() - near;
            let position = position + (axis.difference(apart) - apart);
            let way = position.width();
            if axis.is_angle && way > MAX_TURN {
                return Err(PathError::Singular { s: from, point });
            }
            if let Some(position) = axis.beyond(position.low(), position.high()) {
                return Err(PathError::Limit {
                    s,
                    axis: axis.name,
                    position,
                    min: axis.min,
                    max: axis.max,
                });
            }
        }
        Ok(beside)
    }
}
