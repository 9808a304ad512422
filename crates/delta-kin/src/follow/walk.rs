//! A path, waypoint by waypoint, each step as long as the tolerance allows.

use nalgebra::{Point3, RealField};
use trig_kernels::Trig;

use super::bisect::Bisection;
use super::{FollowError, PlatformPath, SpeedLimits, Waypoint};
use crate::arm::zip;
use crate::{Arm, Delta};

/// Yields each waypoint or the reason why there is none; ends after an error.
#[derive(Debug, Clone)]
pub(super) struct Walk<T: RealField> {
    delta: Delta<T>,
    path: PlatformPath<T>,
    tolerance: T,
    limits: SpeedLimits<T>,
    state: State<T>,
}

#[derive(Debug, Clone, Copy)]
enum State<T: RealField> {
    Start,
    On { last: Waypoint<T>, steps: Bisection },
    End,
}

type Step<T> = Result<Waypoint<T>, FollowError<T>>;

impl<T: RealField + Trig> Walk<T> {
    pub(super) const fn new(
        delta: Delta<T>,
        path: PlatformPath<T>,
        tolerance: T,
        limits: SpeedLimits<T>,
    ) -> Self {
        Self {
            delta,
            path,
            tolerance,
            limits,
            state: State::Start,
        }
    }

    fn start(&mut self) -> Step<T> {
        let point = self.path.at(T::zero());
        let fraction = T::zero();
        let first = Waypoint {
            angles: self.inverse(fraction, point)?,
            point,
            fraction,
            length: T::zero(),
            duration_s: T::zero(),
        };
        if self.path.length() > T::zero() {
            let steps = Bisection::default();
            self.state = State::On { last: first, steps };
        }
        Ok(first)
    }

    fn inverse(
        &self,
        fraction: T,
        point: Point3<T>,
    ) -> Result<nalgebra::Vector3<T>, FollowError<T>> {
        self.delta
            .inverse(point)
            .map_err(|reason| FollowError::Unreachable {
                fraction,
                point,
                reason,
            })
    }

    /// The longest next step that keeps the tolerance and the workspace.
    fn step(&mut self, last: Waypoint<T>, mut steps: Bisection) -> Step<T> {
        loop {
            match self.try_step(&last, steps.target()) {
                Ok(next) => {
                    if steps.advance() {
                        self.state = State::On { last: next, steps };
                    }
                    return Ok(next);
                }
                // Shorter steps lead up to the first point that is out of reach.
                Err(refused) => {
                    if !steps.halve() {
                        return Err(refused);
                    }
                }
            }
        }
    }

    fn try_step(&self, last: &Waypoint<T>, fraction: T) -> Step<T> {
        let point = self.path.at(fraction);
        let angles = self.inverse(fraction, point)?;
        let turned = zip(Arm::ALL, (angles - last.angles).into());
        for (arm, turned) in turned {
            if turned.abs() > T::pi() {
                return Err(FollowError::Turn {
                    fraction,
                    point,
                    arm,
                });
            }
        }
        let step = fraction - last.fraction;
        let departure = self.path.height(step).and_then(|height| {
            let bound = self
                .delta
                .bound((last.angles, last.point), (angles, point))?;
            Some(height + bound)
        });
        if !departure.is_some_and(|departure| departure <= self.tolerance) {
            return Err(FollowError::Singular { fraction, point });
        }
        let length = self.path.length() * step;
        Ok(Waypoint {
            angles,
            point,
            fraction,
            length,
            duration_s: self.limits.duration_s(length, angles - last.angles),
        })
    }
}

impl<T: RealField + Trig> Iterator for Walk<T> {
    type Item = Step<T>;

    fn next(&mut self) -> Option<Step<T>> {
        match core::mem::replace(&mut self.state, State::End) {
            State::Start => Some(self.start()),
            State::On { last, steps } => Some(self.step(last, steps)),
            State::End => None,
        }
    }
}
