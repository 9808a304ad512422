//! By which rule a side computes its BCC.

use thiserror::Error;

use crate::monitor::BccSeen;

/// The rule that explains all check characters of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Formula {
    /// Over the data before each 10h is doubled.
    #[error("over the undoubled data (difference 10h where the data hold an odd number of 10h)")]
    Undoubled,
    /// As [`Undoubled`](Self::Undoubled), or without the DLE before ETX: all blocks so far had an
    /// odd number of 10h.
    #[error(
        "over the undoubled data, or without the DLE before ETX (constant difference 10h; all blocks hold an odd number of 10h)"
    )]
    UndoubledOrWithoutDle,
    /// With the STX.
    #[error("with the STX (constant difference 02h)")]
    WithStx,
    /// With the STX, and over the data before each 10h is doubled.
    #[error("with the STX and over the undoubled data (difference 02h or 12h)")]
    WithStxUndoubled,
    /// As [`WithStxUndoubled`](Self::WithStxUndoubled), or with the STX and without the DLE before
    /// ETX: all blocks so far had an odd number of 10h.
    #[error(
        "with the STX, and over the undoubled data or without the DLE before ETX (constant difference 12h; all blocks hold an odd number of 10h)"
    )]
    WithStxUndoubledOrWithoutDle,
    /// Without the DLE before ETX.
    #[error("without the DLE before ETX (constant difference 10h)")]
    WithoutDle,
    /// Without the ETX.
    #[error("without the ETX (constant difference 03h)")]
    WithoutEtx,
    /// Without DLE ETX.
    #[error("without DLE ETX (constant difference 13h)")]
    WithoutEnd,
    /// Another start value, or inverted.
    #[error("with another start value (constant difference {difference:02X}h)")]
    StartValue {
        /// XOR of the one received and the right one.
        difference: u8,
    },
}

impl Formula {
    pub(super) const fn measurement(self) -> Option<&'static str> {
        match self {
            Self::UndoubledOrWithoutDle | Self::WithStxUndoubledOrWithoutDle => Some(
                "let it send a telegram without 10h: if the difference has no 10h then, the data are taken undoubled",
            ),
            _ => None,
        }
    }
}

/// The difference that most blocks have in common: majority vote of Boyer and Moore.
#[derive(Clone, Copy, Debug, Default)]
struct Vote {
    winner: u8,
    lead: u32,
    total: u32,
}

impl Vote {
    fn cast(&mut self, difference: u8) {
        self.total = self.total.saturating_add(1);
        if self.lead == 0 {
            self.winner = difference;
        }
        if self.winner == difference {
            self.lead = self.lead.saturating_add(1);
        } else {
            self.lead = self.lead.saturating_sub(1);
        }
    }

    /// The difference of three quarters of the blocks at least.
    fn winner(self) -> Option<u8> {
        (self.total > 0 && self.lead >= self.total.div_ceil(2)).then_some(self.winner)
    }
}

/// The differences of one side's blocks, apart by the number of 10h in them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Formulas {
    odd: Vote,
    even: Vote,
}

/// Two damaged blocks seldom have the same difference.
const BLOCKS: u32 = 2;

impl Formulas {
    pub(super) fn note(&mut self, seen: BccSeen) {
        if seen.has_odd_dle {
            self.odd.cast(seen.difference);
        } else {
            self.even.cast(seen.difference);
        }
    }

    /// The rule, unless it is that of the procedure or cannot be decided.
    pub(super) fn rule(self) -> Option<Formula> {
        let wrong = |vote: Vote| vote.winner().is_some_and(|difference| difference != 0);
        let mut blocks = 0_u32;
        for vote in [self.odd, self.even] {
            if wrong(vote) {
                blocks = blocks.saturating_add(vote.total);
            }
        }
        if blocks < BLOCKS {
            return None;
        }
        match (self.odd.winner(), self.even.winner()) {
            (Some(0x10), Some(0)) => Some(Formula::Undoubled),
            (Some(0x12), Some(2)) => Some(Formula::WithStxUndoubled),
            (Some(0x10), None) if self.even.total == 0 => Some(Formula::UndoubledOrWithoutDle),
            (Some(0x12), None) if self.even.total == 0 => {
                Some(Formula::WithStxUndoubledOrWithoutDle)
            }
            (Some(odd), Some(even)) if odd == even => constant(odd),
            (Some(odd), None) if self.even.total == 0 => constant(odd),
            (None, Some(even)) if self.odd.total == 0 => constant(even),
            _ => None,
        }
    }
}

const fn constant(difference: u8) -> Option<Formula> {
    Some(match difference {
        0 => return None,
        0x02 => Formula::WithStx,
        0x03 => Formula::WithoutEtx,
        0x10 => Formula::WithoutDle,
        0x13 => Formula::WithoutEnd,
        difference => Formula::StartValue { difference },
    })
}
