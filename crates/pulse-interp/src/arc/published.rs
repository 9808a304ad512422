//! The published walk along an arc.

use super::ArcSteps;
use crate::Move;
use crate::line::size_of_rest;
use core::iter::FusedIterator;

/// The single steps of [`Arc::published_steps`](super::Arc::published_steps), counted.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct PublishedSteps {
    steps: ArcSteps,
    left: u64,
}

impl PublishedSteps {
    pub(super) const fn new(steps: ArcSteps, left: u64) -> Self {
        Self { steps, left }
    }

    /// Steps still to come.
    #[must_use]
    pub const fn remaining(&self) -> u64 {
        self.left
    }
}

impl Iterator for PublishedSteps {
    type Item = Move;

    #[inline]
    fn next(&mut self) -> Option<Move> {
        self.left = self.left.checked_sub(1)?;
        self.steps.next()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.left)
    }
}

impl FusedIterator for PublishedSteps {}
