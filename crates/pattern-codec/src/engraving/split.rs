//! One motion cut into as few records as hold it, evenly.

use core::iter::FusedIterator;

use super::record::NEGATIVE;
use super::{Axis, Fast, JointPulses, Record, Slow};
use crate::size_hint::size_of_rest;

/// FAST records that together make one rapid motion: full records, then the rest.
#[derive(Debug, Clone)]
pub(super) struct FastRecords {
    axis: Axis,
    negative: bool,
    /// Pulses still to go.
    pulses: u32,
}

impl FastRecords {
    pub(super) const fn new(axis: Axis, negative: bool, magnitude: u32) -> Self {
        Self {
            axis,
            negative,
            pulses: magnitude,
        }
    }

    /// Records still to come.
    pub(super) fn remaining(&self) -> u64 {
        self.pulses.div_ceil(Fast::MAX.unsigned_abs()).into()
    }
}

impl Iterator for FastRecords {
    type Item = Record;

    fn next(&mut self) -> Option<Record> {
        if self.pulses == 0 {
            return None;
        }
        let full = u16::MAX;
        let count = u16::try_from(self.pulses).unwrap_or(full);
        self.pulses = self.pulses.saturating_sub(u32::from(count));
        Some(Fast::from_count(self.axis, self.negative, count).into())
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.remaining())
    }
}

impl FusedIterator for FastRecords {}

/// SLOW records that together make one cutting motion, split as
/// [`Builder::slow`](super::Builder::slow) says.
#[derive(Debug, Clone)]
pub(super) struct SlowRecords {
    elbow: Distribution,
    shoulder: Distribution,
    disc: Distribution,
    parts: u32,
    left: u32,
}

impl SlowRecords {
    pub(super) fn new(pulses: JointPulses) -> Self {
        let JointPulses {
            elbow,
            shoulder,
            disc,
        } = pulses;
        let max = elbow
            .unsigned_abs()
            .max(shoulder.unsigned_abs())
            .max(disc.unsigned_abs());
        let parts = max.div_ceil(Slow::MAX.unsigned_abs());
        Self {
            elbow: Distribution::new(elbow, parts),
            shoulder: Distribution::new(shoulder, parts),
            disc: Distribution::new(disc, parts),
            parts,
            left: parts,
        }
    }
}

impl Iterator for SlowRecords {
    type Item = Record;

    fn next(&mut self) -> Option<Record> {
        self.left = self.left.checked_sub(1)?;
        let disc = self.disc.next(self.parts);
        let elbow = self.elbow.next(self.parts);
        let shoulder = self.shoulder.next(self.parts);
        Some(Slow::from_bytes([disc, elbow, shoulder]).into())
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.left.into())
    }
}

impl FusedIterator for SlowRecords {}

/// The even distribution of one axis over the parts, without a division for each.
#[derive(Debug, Clone, Copy)]
struct Distribution {
    sign: u8,
    /// floor(|T|/n)
    quotient: u32,
    /// |T| mod n
    remainder: u32,
    /// (k |T| + floor(n/2)) mod n
    carry: u32,
}

impl Distribution {
    const fn new(pulses: i32, parts: u32) -> Self {
        let magnitude = pulses.unsigned_abs();
        let (quotient, remainder) =
            match (magnitude.checked_div(parts), magnitude.checked_rem(parts)) {
                (Some(quotient), Some(remainder)) => (quotient, remainder),
                // No parts, no pulses.
                _ => (0, 0),
            };
        Self {
            sign: if pulses < 0 { NEGATIVE } else { 0 },
            quotient,
            remainder,
            carry: parts >> 1,
        }
    }

    /// The next part as a SLOW byte.
    const fn next(&mut self, parts: u32) -> u8 {
        // carry and remainder are below n <= ceil(2^31/30), so nothing here overflows; the part is
        // at most ceil(|T|/n) <= 30, so its low byte is the whole of it.
        let carry = self.carry.saturating_add(self.remainder);
        let (carry, extra) = match carry.checked_sub(parts) {
            Some(carry) => (carry, 1),
            None => (carry, 0),
        };
        self.carry = carry;
        let [part, ..] = self.quotient.saturating_add(extra).to_le_bytes();
        self.sign | part
    }
}
