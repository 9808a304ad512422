//! What one direction carried.

use core::{fmt, time::Duration};

use super::evidence::Evidence;
use crate::monitor::{Millis, Side};

/// Counts and worst times of the telegrams of one side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Totals {
    /// Characters of the side, its answers included.
    pub characters: u32,
    /// STX with which it asked to send.
    pub requests: u32,
    /// Initialization conflicts.
    pub conflicts: u32,
    /// Blocks that it began.
    pub blocks: u32,
    /// Blocks that were acknowledged: the telegrams.
    pub telegrams: u32,
    /// Blocks that were not, and had to be repeated.
    pub repeats: u32,
    /// Repeats that were answered NAK.
    pub rejected: u32,
    /// Longest time from its STX to DLE.
    pub worst_answer: Option<Duration>,
    /// Longest time from the end of its block to DLE.
    pub worst_acknowledgement: Option<Duration>,
    /// Longest time between two characters of a block.
    pub longest_gap: Duration,
}

impl Totals {
    pub(super) fn of(evidence: &Evidence, sender: Side) -> Self {
        let (own, partner) = (&evidence.sides[sender], &evidence.sides[sender.other()]);
        Self {
            characters: own.characters,
            requests: own.requests,
            conflicts: own.conflicts,
            blocks: own.blocks(),
            telegrams: own.accepted,
            repeats: own.blocks().saturating_sub(own.accepted),
            rejected: own.rejected,
            worst_answer: partner.worst_answer,
            worst_acknowledgement: partner.worst_acknowledgement,
            longest_gap: own.longest_gap,
        }
    }
}

impl fmt::Display for Totals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} telegrams", self.telegrams)?;
        for (count, of, name) in [
            (self.repeats, self.blocks, "repeats"),
            (self.rejected, self.blocks, "rejected"),
            (self.conflicts, self.requests, "conflicts"),
        ] {
            write!(f, ", {count} {name}{}", Share(count, of))?;
        }
        for (time, name) in [
            (self.worst_answer, "worst answer to STX"),
            (self.worst_acknowledgement, "worst acknowledgement"),
        ] {
            if let Some(time) = time {
                write!(f, ", {name} {}", Millis(time))?;
            }
        }
        if !self.longest_gap.is_zero() {
            write!(f, ", longest gap {}", Millis(self.longest_gap))?;
        }
        Ok(())
    }
}

/// ` (12.5 %)`, nothing of nothing.
struct Share(u32, u32);

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(part, all) = *self;
        match (u64::from(part) * 1000).checked_div(u64::from(all)) {
            Some(per_mille) if part > 0 => {
                write!(f, " ({}.{} %)", per_mille / 10, per_mille % 10)
            }
            _ => Ok(()),
        }
    }
}
