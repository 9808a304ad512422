//! A leg: one path among several, checked before it is planned.

use crate::number::{LARGEST, Real, SMALLEST, range};
use crate::reciprocals::Reciprocals;
use crate::{Axes, Corner, Path, PathPoint, PlanError, ToolLimits};

/// A path, and which of all it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Leg<P: Path> {
    /// From 0.
    pub(crate) number: usize,
    path: P,
    length: f64,
    tool: Option<ToolLimits>,
}

impl<P: Path> Leg<P> {
    /// The path, whose length, tool limits and corner have numbers that the crate computes with.
    pub(crate) fn new(number: usize, path: P) -> Result<Self, PlanError<P::Error>> {
        let leg = Self {
            number,
            length: path.length(),
            tool: path.tool(),
            path,
        };
        leg.check()?;
        Ok(leg)
    }

    /// The same leg, whose path is borrowed.
    pub(crate) const fn by_ref(&self) -> Leg<&P> {
        Leg {
            number: self.number,
            path: &self.path,
            length: self.length,
            tool: self.tool,
        }
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

    fn check(&self) -> Result<(), PlanError<P::Error>> {
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

    /// What a speed, an acceleration and a jerk of 1 of the parameter use of the limits, where the
    /// axes go as at a point.
    pub(crate) fn uses<R: Real>(
        &self,
        limits: &Reciprocals<P::Axes, R>,
        point: &PathPoint<P::Axes>,
    ) -> [f64; 3] {
        let axes = limits.axes().iter().zip(point.slope.as_slice());
        let of_axes = axes.map(|(limit, slope)| {
            [limit.speed, limit.acceleration, limit.jerk].map(|limit| limit.into() * slope.abs())
        });
        let of_tool = self.tool.map(|tool| {
            [
                1.0 / tool.feed,
                tool.acceleration.map_or(0.0, |a| 1.0 / a),
                0.0,
            ]
        });
        of_axes.chain(of_tool).fold([0.0; 3], |most, uses| {
            let [v, a, j] = most;
            [v.max(uses[0]), a.max(uses[1]), j.max(uses[2])]
        })
    }

    /// Positions and slopes at the parameter `s`, refused by name where the machine cannot be
    /// there.
    pub(crate) fn point(&self, s: f64) -> Result<PathPoint<P::Axes>, PlanError<P::Error>> {
        let point = self
            .path
            .point(s)
            .map_err(|reason| self.refused(s, reason))?;
        let mut numbers = (point.position.as_slice().iter()).chain(point.slope.as_slice());
        if numbers.all(|number| number.is_finite()) {
            return Ok(point);
        }
        Err(PlanError::NotFinite {
            leg: self.number,
            s,
        })
    }

    /// Why the path refuses a segment that begins at `s`.
    pub(crate) fn refused_segment(&self, s: f64, reason: P::Error) -> PlanError<P::Error> {
        if self.path.is_too_coarse(&reason) {
            let leg = self.number;
            return PlanError::TooCoarse { leg, s };
        }
        self.refused(s, reason)
    }

    /// What the path said of a place, with the number of the leg.
    pub(crate) const fn refused(&self, s: f64, reason: P::Error) -> PlanError<P::Error> {
        PlanError::Path {
            leg: self.number,
            s,
            reason,
        }
    }
}
