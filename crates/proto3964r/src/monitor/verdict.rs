//! What is wrong with a line, in one sentence.

use thiserror::Error;

use super::observation::Side;
use crate::config::Priority;

/// What a monitor concludes. Its `Display` is the sentence for the operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Verdict {
    /// No character so far.
    #[error("the line is silent")]
    Silent,
    /// Nothing was accepted so far, and nothing went wrong.
    #[error("nothing to complain of so far")]
    Open,
    /// The last telegram was accepted.
    #[error("the line works")]
    Works,
    /// STX stays without an answer.
    #[error("{silent} does not answer STX: off, not wired, or set to another baud rate")]
    NoAnswer {
        /// Who should answer.
        silent: Side,
    },
    /// STX is answered NAK.
    #[error("{refuser} answers NAK to STX: no receive buffer")]
    NoReceiveBuffer {
        /// Who refuses.
        refuser: Side,
    },
    /// Both sides have the same priority.
    #[error("both sides have {} priority: set one of them to the other", if *.priority == Priority::High { "high" } else { "low" })]
    SamePriority {
        /// The priority of both.
        priority: Priority,
    },
    /// Blocks with wrong checks.
    #[error("blocks of {sender} arrive damaged: noise on the line, or parity and data bits differ")]
    BadBlocks {
        /// Whose blocks they are.
        sender: Side,
    },
    /// Blocks without the check character.
    #[error("{sender} sends no BCC: it is set to 3964, the monitor expects 3964R")]
    NoBcc {
        /// Whose blocks they are.
        sender: Side,
    },
    /// Good blocks are answered NAK.
    #[error(
        "{refuser} rejects blocks that are good: set to 3964 without BCC, a shorter block length, or reception errors on its side"
    )]
    GoodBlocksRejected {
        /// Who rejects.
        refuser: Side,
    },
    /// Bad blocks are answered DLE.
    #[error("{receiver} accepts blocks whose BCC is wrong")]
    BadBlocksAccepted {
        /// Who accepts.
        receiver: Side,
    },
    /// Blocks stay without an answer.
    #[error("{silent} does not answer blocks: it still waits for their end, perhaps for a BCC")]
    NoAcknowledgement {
        /// Who should answer.
        silent: Side,
    },
    /// Pauses in blocks.
    #[error("{sender} pauses in its blocks for longer than ZVZ")]
    Gaps {
        /// Whose blocks they are.
        sender: Side,
    },
    /// Answers that come after QVZ.
    #[error("{side} answers later than QVZ")]
    Late {
        /// Who is late.
        side: Side,
    },
    /// Characters that belong to no procedure.
    #[error(
        "{side} sends characters outside the procedure: another baud rate, parity, or protocol"
    )]
    Garbage {
        /// Who sends them.
        side: Side,
    },
}

/// What goes wrong, in the order in which equal counts are judged. A late answer was missing
/// first: it stands before the missing one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trouble {
    BothHigh,
    BothLow,
    Refused,
    NoBcc,
    BadAccepted,
    BadBlock,
    GoodRejected,
    Late,
    NoAcknowledgement,
    NoAnswer,
    Gap,
    Garbage,
}

const TROUBLES: [Trouble; 12] = [
    Trouble::BothHigh,
    Trouble::BothLow,
    Trouble::Refused,
    Trouble::NoBcc,
    Trouble::BadAccepted,
    Trouble::BadBlock,
    Trouble::GoodRejected,
    Trouble::Late,
    Trouble::NoAcknowledgement,
    Trouble::NoAnswer,
    Trouble::Gap,
    Trouble::Garbage,
];

/// How often each trouble came since the last accepted telegram, per side.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    counts: [[u8; 2]; TROUBLES.len()],
    heard: bool,
    works: bool,
}

impl Tally {
    pub(super) fn heard(&mut self) {
        self.heard = true;
    }

    pub(super) fn note(&mut self, trouble: Trouble, side: Side) {
        let place = TROUBLES.iter().position(|&known| known == trouble);
        let row = place.and_then(|place| self.counts.get_mut(place));
        if let Some(count) = row.and_then(|row| row.get_mut(side.index())) {
            *count = count.saturating_add(1);
        }
    }

    pub(super) fn accepted(&mut self) {
        *self = Self {
            works: true,
            heard: true,
            ..Self::default()
        };
    }

    pub(super) fn verdict(&self) -> Verdict {
        let mut worst = (0, None);
        for (&trouble, counts) in TROUBLES.iter().zip(self.counts) {
            for (side, count) in [Side::A, Side::B].into_iter().zip(counts) {
                if count > worst.0 {
                    worst = (count, Some((trouble, side)));
                }
            }
        }
        match worst.1 {
            Some((trouble, side)) => of(trouble, side),
            None if self.works => Verdict::Works,
            None if self.heard => Verdict::Open,
            None => Verdict::Silent,
        }
    }
}

const fn of(trouble: Trouble, side: Side) -> Verdict {
    match trouble {
        Trouble::BothHigh => Verdict::SamePriority {
            priority: Priority::High,
        },
        Trouble::BothLow => Verdict::SamePriority {
            priority: Priority::Low,
        },
        Trouble::Refused => Verdict::NoReceiveBuffer { refuser: side },
        Trouble::NoBcc => Verdict::NoBcc { sender: side },
        Trouble::BadAccepted => Verdict::BadBlocksAccepted { receiver: side },
        Trouble::BadBlock => Verdict::BadBlocks { sender: side },
        Trouble::GoodRejected => Verdict::GoodBlocksRejected { refuser: side },
        Trouble::NoAcknowledgement => Verdict::NoAcknowledgement { silent: side },
        Trouble::NoAnswer => Verdict::NoAnswer { silent: side },
        Trouble::Late => Verdict::Late { side },
        Trouble::Gap => Verdict::Gaps { sender: side },
        Trouble::Garbage => Verdict::Garbage { side },
    }
}
