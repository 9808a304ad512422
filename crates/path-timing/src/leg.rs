//! One path among several, its parameter as a share of its length.

use crate::number::{LARGEST, SMALLEST, range};
use crate::{Axes as _, Path, Place, PlanError, ToolLimits};

/// A leg: a path, and which of all it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Leg<P> {
    /// From 0.
    pub(crate) number: usize,
    path: P,
    length: f64,
    /// By the share.
    tool: Option<ToolLimits>,
}

impl<P: Path> Leg<P> {
    pub(crate) fn new(number: usize, path: P) -> Self {
        let length = path.length();
        let tool = path.tool().map(|tool| ToolLimits {
            feed: tool.feed / length,
            acceleration: tool.acceleration.map(|limit| limit / length),
        });
        Self {
            number,
            path,
            length,
            tool,
        }
    }

    pub(crate) const fn path(&self) -> &P {
        &self.path
    }

    /// What the tool may do, by the share.
    pub(crate) const fn tool(&self) -> Option<&ToolLimits> {
        self.tool.as_ref()
    }

    /// The parameter at a share of the length.
    pub(crate) fn parameter(&self, share: f64) -> f64 {
        share * self.length
    }

    /// Whether its length and the limits of its tool are ones that the crate computes with.
    pub(crate) fn check(&self) -> Result<(), PlanError<P::Error>> {
        let (leg, length) = (self.number, self.length);
        if !range().contains(&length) {
            return Err(PlanError::Length { leg, length });
        }
        match self.path.tool().and_then(|tool| tool.outside()) {
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

    /// Positions, and slopes by the share, at a share 0..=1 of the length.
    pub(crate) fn place(&self, share: f64) -> Result<Place<P::Axes>, P::Error> {
        let Place { position, slope } = self.path.place(self.parameter(share))?;
        Ok(Place {
            position,
            slope: slope.scaled(self.length),
        })
    }

    /// The same, refused by name where the machine cannot be there.
    pub(crate) fn checked_place(&self, share: f64) -> Result<Place<P::Axes>, PlanError<P::Error>> {
        let (leg, s) = (self.number, self.parameter(share));
        let place = self
            .place(share)
            .map_err(|reason| PlanError::Path { leg, s, reason })?;
        let mut numbers = (place.position.as_slice().iter()).chain(place.slope.as_slice());
        if numbers.all(|number| number.is_finite()) {
            return Ok(place);
        }
        Err(PlanError::NotFinite { leg, s })
    }
}
