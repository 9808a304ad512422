//! A polyline, waypoint by waypoint, each step as long as the tolerance allows.

use nalgebra::{Point2, RealField};
use trig_kernels::Trig;

use super::bisect::Bisection;
use super::{FollowError, Waypoint};
use crate::{Arm, Elbow, InverseError, Joints};

/// Yields each waypoint or the reason why there is none; ends after an error.
#[derive(Debug, Clone)]
pub(super) struct Walk<I, T: RealField> {
    arm: Arm<T>,
    points: I,
    elbow: Elbow,
    tolerance: T,
    joints: Joints<T>,
    state: State<T>,
}

#[derive(Debug, Clone)]
enum State<T: RealField> {
    Start,
    /// At the point with which line number `line` begins.
    Corner {
        line: usize,
        point: Point2<T>,
    },
    On(Line<T>),
    End,
}

/// A point of the curve.
#[derive(Clone, Copy)]
struct PathPoint<T: RealField> {
    line: usize,
    fraction: T,
    point: Point2<T>,
}

impl<T: RealField + Copy> PathPoint<T> {
    fn unreachable(self, reason: InverseError<T>) -> FollowError<T> {
        FollowError::Unreachable {
            line: self.line,
            fraction: self.fraction,
            point: self.point,
            reason,
        }
    }
}

/// A line on which the walk stands.
#[derive(Debug, Clone, Copy)]
struct Line<T: RealField> {
    line: usize,
    from: Point2<T>,
    to: Point2<T>,
    /// Where the line is nearest to the base, if that is within the inner reach.
    dip: Option<T>,
    steps: Bisection,
}

impl<T: RealField + Trig> Line<T> {
    fn at(&self, fraction: T) -> PathPoint<T> {
        let point = if fraction == T::one() {
            self.to
        } else {
            self.from + (self.to - self.from) * fraction
        };
        PathPoint {
            line: self.line,
            fraction,
            point,
        }
    }

    /// The dip, if the next step would jump over it.
    fn dip_ahead(&self) -> Option<PathPoint<T>> {
        let dip = self.dip?;
        let ahead = self.steps.position::<T>() < dip && dip < self.steps.target();
        ahead.then(|| self.at(dip))
    }
}

type Step<T> = Result<Waypoint<T>, FollowError<T>>;

impl<I, T> Walk<I, T>
where
    I: Iterator<Item = Point2<T>>,
    T: RealField + Trig,
{
    pub(super) fn new(
        arm: Arm<T>,
        points: I,
        elbow: Elbow,
        tolerance: T,
        previous: Joints<T>,
    ) -> Self {
        Self {
            arm,
            points,
            elbow,
            tolerance,
            joints: previous,
            state: State::Start,
        }
    }

    fn start(&mut self) -> Option<Step<T>> {
        let point = self.points.next()?;
        let at = PathPoint {
            line: 0,
            fraction: T::zero(),
            point,
        };
        self.state = State::Corner { line: 0, point };
        let step = self.joints_at(at).map(|joints| self.arrive(joints, at));
        Some(step)
    }

    /// The next line that has a length.
    fn next_line(&mut self, mut line: usize, from: Point2<T>) -> Option<Line<T>> {
        loop {
            let to = self.points.next()?;
            if to != from {
                let dip = self.dip(from, to);
                let steps = Bisection::default();
                return Some(Line {
                    line,
                    from,
                    to,
                    dip,
                    steps,
                });
            }
            line += 1;
        }
    }

    /// Where a line comes nearest to the base, if that is within the inner reach:
    /// between two waypoints it could dip in there unseen.
    fn dip(&self, from: Point2<T>, to: Point2<T>) -> Option<T> {
        let centre = Point2::from(self.arm.base().translation.vector);
        let line = to - from;
        let fraction = (centre - from).dot(&line) / line.norm_squared();
        let distance = (from + line * fraction - centre).norm();
        let inside = distance < self.arm.inner_reach() - self.arm.tolerance();
        (inside && fraction > T::zero() && fraction < T::one()).then_some(fraction)
    }

    /// The longest next step on the line that keeps the tolerance and the workspace.
    fn step(&mut self, mut line: Line<T>) -> Step<T> {
        loop {
            let at = line.at(line.steps.target());
            let refused = match self.try_step(&line, at) {
                Ok(joints) => {
                    self.state = if line.steps.advance() {
                        State::On(line)
                    } else {
                        let point = line.to;
                        let line = line.line.saturating_add(1);
                        State::Corner { line, point }
                    };
                    return Ok(self.arrive(joints, at));
                }
                Err(refused) => refused,
            };
            // Shorter steps lead up to the first point that is out of reach.
            if !line.steps.halve() {
                return Err(refused);
            }
        }
    }

    fn try_step(&self, line: &Line<T>, at: PathPoint<T>) -> Result<Joints<T>, FollowError<T>> {
        if let Some(at) = line.dip_ahead() {
            let centre = Point2::from(self.arm.base().translation.vector);
            let reason = InverseError::TooNear {
                distance: (at.point - centre).norm(),
                reach: self.arm.inner_reach(),
            };
            return Err(at.unreachable(reason));
        }
        let joints = self.joints_at(at)?;
        let rounding = self
            .arm
            .rounding(self.joints)
            .max(self.arm.rounding(joints));
        if self.arm.chord_bound(self.joints, joints) + rounding <= self.tolerance {
            return Ok(joints);
        }
        if let Some(reason) = self.arm.forced_turn(self.elbow, self.joints, joints) {
            return Err(at.unreachable(reason));
        }
        Err(FollowError::Singular {
            line: at.line,
            fraction: at.fraction,
            point: at.point,
        })
    }

    /// Joint angles at a point of the path, at the whole turn nearest to those before.
    fn joints_at(&self, at: PathPoint<T>) -> Result<Joints<T>, FollowError<T>> {
        let joints = self
            .arm
            .inverse_elbow_near(at.point, self.elbow, self.joints)
            .map_err(|reason| at.unreachable(reason))?;
        let (tolerance, rounding) = (self.tolerance, self.arm.rounding(joints));
        // Written so that NaN is refused too.
        if tolerance > rounding && tolerance.is_finite() {
            Ok(joints)
        } else {
            Err(FollowError::Tolerance {
                tolerance,
                rounding,
            })
        }
    }

    fn arrive(&mut self, joints: Joints<T>, at: PathPoint<T>) -> Waypoint<T> {
        self.joints = joints;
        Waypoint {
            joints,
            point: at.point,
            line: at.line,
            fraction: at.fraction,
        }
    }
}

impl<I, T> Iterator for Walk<I, T>
where
    I: Iterator<Item = Point2<T>>,
    T: RealField + Trig,
{
    type Item = Step<T>;

    fn next(&mut self) -> Option<Step<T>> {
        let step = match core::mem::replace(&mut self.state, State::End) {
            State::Start => self.start()?,
            State::Corner { line, point } => {
                let line = self.next_line(line, point)?;
                self.step(line)
            }
            State::On(line) => self.step(line),
            State::End => return None,
        };
        if step.is_err() {
            self.state = State::End;
        }
        Some(step)
    }
}
