//! Legs one after the other.

use crate::leg::Leg;
use crate::reciprocals::Reciprocals;
use crate::{Legs, PlanError};

/// Consecutive legs: all of a table, or those between two stops.
#[derive(Debug, Clone)]
pub(crate) struct Chain<L> {
    legs: L,
    /// The number of the first one, and how many there are.
    first: usize,
    count: usize,
}

impl<L: Legs> Chain<L> {
    /// Legs numbered from `first`.
    pub(crate) fn new(legs: L, first: usize) -> Self {
        Self {
            count: legs.clone().count(),
            legs,
            first,
        }
    }

    pub(crate) const fn count(&self) -> usize {
        self.count
    }

    /// The legs in their order.
    pub(crate) fn forward<'a>(
        &self,
        limits: &'a Reciprocals<L::Axes>,
    ) -> impl Iterator<Item = Result<Leg<L::Leg>, PlanError<L::Error>>> + use<'a, L> {
        let mut later = self.legs.clone();
        later.next();
        let numbered = (self.first..).zip(self.legs.clone());
        numbered.map(move |(number, path)| {
            let next = later.next();
            Leg::named(number, path, next.as_ref(), limits)
        })
    }

    /// The legs from the last to the first.
    pub(crate) fn backward<'a>(
        &self,
        limits: &'a Reciprocals<L::Axes>,
    ) -> impl Iterator<Item = Result<Leg<L::Leg>, PlanError<L::Error>>> + use<'a, L> {
        let mut next: Option<L::Leg> = None;
        let numbers = self.first..self.first.saturating_add(self.count);
        let numbered = numbers.rev().zip(self.legs.clone().rev());
        numbered.map(move |(number, path)| {
            let leg = Leg::named(number, path.clone(), next.as_ref(), limits);
            next = Some(path);
            leg
        })
    }

    /// Takes off the legs up to the first stop.
    pub(crate) fn split_at_stop(
        &mut self,
        limits: &Reciprocals<L::Axes>,
    ) -> Result<Option<Self>, PlanError<L::Error>> {
        let mut count = 0_usize;
        for leg in self.forward(limits) {
            count = count.saturating_add(1);
            if leg?.joint().is_stop() {
                break;
            }
        }
        let mut legs = self.legs.clone();
        for _ in count..self.count {
            legs.next_back();
        }
        for _ in 0..count {
            self.legs.next();
        }
        let first = self.first;
        self.first = first.saturating_add(count);
        self.count = self.count.saturating_sub(count);
        Ok((count > 0).then_some(Self { legs, first, count }))
    }
}
