//! One path among several, and its joint to the next.

use crate::joint::Joint;
use crate::number::{LARGEST, SMALLEST, range};
use crate::reciprocals::Reciprocals;
use crate::{Axes, Corner, Path, PathPoint, PlanError, ToolLimits};

/// A leg: a path, which of all it is, and how the next one follows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Leg<P: Path> {
    /// From 0.
    pub(crate) number: usize,
    path: P,
    length: f64,
    tool: Option<ToolLimits>,
    joint: Joint<P::Axes>,
}

impl<P: Path> Leg<P> {
    /// The path with no other after it.
    pub(crate) fn last(number: usize, path: P) -> Self {
        Self {
            number,
            length: path.length(),
            tool: path.tool(),
            path,
            joint: Joint::Stop,
        }
    }

    /// The path with its joint to the `next`.
    pub(crate) fn new(
        number: usize,
        path: P,
        next: Option<&P>,
        limits: &Reciprocals<P::Axes>,
    ) -> Result<Self, P::Error> {
        let mut leg = Self::last(number, path);
        if let (corner @ (Corner::Smooth | Corner::Jump(_)), Some(next)) = (leg.path.corner(), next)
        {
            let (before, after) = (leg.path.point(leg.length)?, next.point(0.0)?);
            leg.joint = Joint::new(limits, &corner, &before.slope, &after.slope);
        }
        Ok(leg)
    }

    /// The same, refused by name where the path refuses one of the two ends at its joint.
    pub(crate) fn named(
        number: usize,
        path: P,
        next: Option<&P>,
        limits: &Reciprocals<P::Axes>,
    ) -> Result<Self, PlanError<P::Error>> {
        let s = path.length();
        Self::new(number, path, next, limits).map_err(|reason| PlanError::Path {
            leg: number,
            s,
            reason,
        })
    }

    pub(crate) const fn path(&self) -> &P {
        &self.path
    }

    pub(crate) const fn length(&self) -> f64 {
        self.length
    }

    pub(crate) const fn tool(&self) -> Option<&ToolLimits> {
        self.tool.as_ref()
    }

    pub(crate) const fn joint(&self) -> &Joint<P::Axes> {
        &self.joint
    }

    /// Whether its length, the limits of its tool and its corner have numbers that the crate
    /// computes with.
    pub(crate) fn check(&self) -> Result<(), PlanError<P::Error>> {
        let (leg, length) = (self.number, self.length);
        if !range().contains(&length) {
            return Err(PlanError::Length { leg, length });
        }
        if let Corner::Jump(speeds) = self.path.corner() {
            let mut speeds = speeds.as_slice().iter().enumerate();
            let outside = |speed: &f64| *speed != 0.0 && !range().contains(speed);
            if let Some((axis, speed)) = speeds.find(|(_, speed)| outside(speed)) {
                let speed = *speed;
                return Err(PlanError::StartStopSpeed { leg, axis, speed });
            }
        }
        match self.tool.and_then(|tool| tool.outside()) {
            Some((name, value)) => Err(PlanError::Tool {
                leg,
                name,
                value,
                min: SMALLEST,
                max: LARGEST,
            }),
            None => Ok(()),
        }
    }

    /// Positions and slopes at the parameter `s`; at the end those of the joint.
    pub(crate) fn point(&self, s: f64) -> Result<PathPoint<P::Axes>, P::Error> {
        let mut point = self.path.point(s)?;
        if let (Joint::Smooth(slope), true) = (&self.joint, s >= self.length) {
            point.slope = *slope;
        }
        Ok(point)
    }

    /// The same, refused by name where the machine cannot be there.
    pub(crate) fn checked_point(&self, s: f64) -> Result<PathPoint<P::Axes>, PlanError<P::Error>> {
        let leg = self.number;
        let point = self
            .point(s)
            .map_err(|reason| PlanError::Path { leg, s, reason })?;
        let mut numbers = (point.position.as_slice().iter()).chain(point.slope.as_slice());
        if numbers.all(|number| number.is_finite()) {
            return Ok(point);
        }
        Err(PlanError::NotFinite { leg, s })
    }
}
