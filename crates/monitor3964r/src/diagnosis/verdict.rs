//! What is wrong with a line, in one sentence.

use core::{fmt, time::Duration};

use proto3964r::Priority;
use thiserror::Error;

use super::{formula::Formula, setting::BaudRatio};
use crate::monitor::{Millis, Side};

/// What a diagnosis concludes. Its `Display` is the sentence for the operator.
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
    /// Telegrams are accepted.
    #[error("the line works")]
    Works,
    /// Telegrams are accepted, some of them only when repeated.
    #[error(
        "the line works, but {repeated} of {blocks} blocks of {sender} had to be repeated; {damaged} arrived damaged"
    )]
    WorksWithRepeats {
        /// Whose blocks they are.
        sender: Side,
        /// Blocks that were not accepted.
        repeated: u32,
        /// Those of the repeated ones that were heard damaged.
        damaged: u32,
        /// All its blocks.
        blocks: u32,
    },
    /// STX stays without an answer.
    #[error("{silent} does not answer STX: off, not wired, or set to another baud rate")]
    NoAnswer {
        /// Who should answer.
        silent: Side,
    },
    /// STX stays without an answer after a time in which the line worked.
    #[error("{silent} does not answer STX any more: the last sign of it came at {}", Seconds(*.last))]
    NoLongerAnswers {
        /// Who should answer.
        silent: Side,
        /// The last character of it.
        last: Duration,
    },
    /// One side shows no reaction to the other.
    #[error(
        "{speaker} is not heard by {listener}: the wire from {speaker}'s transmit to {listener}'s receive line is open or crossed"
    )]
    NotHeard {
        /// Who speaks in vain.
        speaker: Side,
        /// Who does not react.
        listener: Side,
    },
    /// Neither side shows a reaction to the other.
    #[error("neither side hears the other: transmit and receive lines crossed, or both open")]
    NeitherHears,
    /// One side reacts to what the tap does not hear.
    #[error(
        "{speaker} goes on as if {unheard} had answered, but the tap hears nothing of {unheard}: its input for {unheard} is not connected"
    )]
    TapDeaf {
        /// Who is heard.
        speaker: Side,
        /// Who is not.
        unheard: Side,
    },
    /// Both directions come in on one input.
    #[error(
        "both directions come in on the tap's input for {side}: a two-wire line, or its inputs are joined"
    )]
    OneInput {
        /// The input.
        side: Side,
    },
    /// Both inputs hear the same.
    #[error("A and B hear their own characters: echo of a two-wire line, not suppressed")]
    Echo,
    /// A side breaks off its blocks although the other is silent.
    #[error(
        "{side} breaks off its own blocks while the other is silent: it hears its own characters (echo of a two-wire line), or noise"
    )]
    OwnEcho {
        /// Who breaks off.
        side: Side,
    },
    /// STX is answered NAK.
    #[error("{refuser} answers NAK to STX: no receive buffer")]
    NoReceiveBuffer {
        /// Who refuses.
        refuser: Side,
    },
    /// Both sides have the same priority.
    #[error("both sides have the same priority, {}: set one of them to {}", name(*.priority), name(opposite(*.priority)))]
    SamePriority {
        /// The priority of both.
        priority: Priority,
    },
    /// Blocks with wrong checks.
    #[error("{bad} of {blocks} blocks of {sender} arrive damaged: noise on the line")]
    BadBlocks {
        /// Whose blocks they are.
        sender: Side,
        /// Damaged ones.
        bad: u32,
        /// All its blocks.
        blocks: u32,
    },
    /// Blocks whose check character follows another rule.
    #[error("{sender} computes the BCC otherwise: {formula}")]
    OtherBcc {
        /// Whose blocks they are.
        sender: Side,
        /// Its rule.
        formula: Formula,
    },
    /// Blocks in which 10h stands alone.
    #[error(
        "{sender} does not double 10h in its data: {blocks} of its blocks go on after their end, or hold a single DLE that is in their BCC"
    )]
    NotDoubled {
        /// Whose blocks they are.
        sender: Side,
        /// Those that show it.
        blocks: u32,
    },
    /// Blocks that are damaged in the same way each time.
    #[error(
        "{bad} of {blocks} blocks of {sender} are wrong, and repeats in the same way: no noise; it checks or frames them by another rule"
    )]
    SameDamage {
        /// Whose blocks they are.
        sender: Side,
        /// Wrong ones.
        bad: u32,
        /// All its blocks.
        blocks: u32,
    },
    /// One side speaks 3964, the other 3964R.
    #[error(
        "{side} neither awaits a BCC nor sends one: it is set to 3964, {} to 3964R",
        side.other()
    )]
    WithoutBcc {
        /// Who is set to 3964.
        side: Side,
    },
    /// Both sides speak 3964, where 3964R was expected.
    #[error("both sides are set to 3964, without BCC; the monitor expects 3964R")]
    BothWithoutBcc,
    /// Both sides speak 3964R, where 3964 was expected.
    #[error("both sides are set to 3964R, with BCC; the monitor expects 3964")]
    BothWithBcc,
    /// Good blocks are answered NAK.
    #[error(
        "{refuser} rejects blocks of {} that are good ({rejected} of {blocks}): reception errors on its side, or it checks the BCC otherwise", refuser.other()
    )]
    GoodBlocksRejected {
        /// Who rejects.
        refuser: Side,
        /// Good blocks that were rejected.
        rejected: u32,
        /// All blocks of the other.
        blocks: u32,
    },
    /// Good blocks are answered NAK if they are long.
    #[error(
        "{refuser} rejects good blocks from {rejected} bytes upwards and accepts them up to {accepted}: its block length is set shorter"
    )]
    LongBlocksRejected {
        /// Who rejects.
        refuser: Side,
        /// Payload of the longest block that was accepted, in bytes.
        accepted: u32,
        /// Payload of the shortest one that was rejected, in bytes.
        rejected: u32,
    },
    /// Bad blocks are answered DLE.
    #[error("{receiver} accepts blocks whose BCC is wrong")]
    BadBlocksAccepted {
        /// Who accepts.
        receiver: Side,
    },
    /// Blocks stay without an answer.
    #[error("{silent} does not answer blocks: it still waits for their end, or its answer is lost")]
    NoAcknowledgement {
        /// Who should answer.
        silent: Side,
    },
    /// STX in place of the answer to a block.
    #[error(
        "{side} sends STX in place of the answer to a block, {} after its end: it lost the block, or does not wait for its end",
        Millis(*.delay)
    )]
    RequestForAnswer {
        /// Who should answer.
        side: Side,
        /// The longest time from the end of the block to the STX.
        delay: Duration,
    },
    /// Pauses in blocks.
    #[error("{sender} pauses in its blocks for longer than the character delay time (ZVZ): {}", Millis(*.longest))]
    Gaps {
        /// Whose blocks they are.
        sender: Side,
        /// The longest pause.
        longest: Duration,
    },
    /// Answers that come after QVZ.
    #[error(
        "{side} answers {} after the question, later than {} waits (QVZ, {}): too late by {}",
        Millis(*.delay), side.other(), Millis(*.qvz), Millis(crate::monitor::since(*.qvz, *.delay))
    )]
    Late {
        /// Who is late.
        side: Side,
        /// From the question to the answer.
        delay: Duration,
        /// How long the other waits.
        qvz: Duration,
    },
    /// Characters that belong to no procedure.
    #[error("{side} sends characters outside the procedure: another parity, baud rate or protocol")]
    Garbage {
        /// Who sends them.
        side: Side,
    },
    /// Blocks that cannot be read, where STX, DLE and NAK can.
    #[error(
        "{side} sends another parity, most likely none (8N1 in place of 8E1): its STX, DLE and NAK can be read, its blocks cannot"
    )]
    NoParity {
        /// Who sends them.
        side: Side,
    },
    /// All characters come in with a wrong parity bit.
    #[error("{side} sends another parity: its STX, DLE and NAK come in with a wrong parity bit")]
    OtherParity {
        /// Who sends them.
        side: Side,
    },
    /// Characters that STX, DLE and NAK of another baud rate read as.
    #[error(
        "{side} sends characters outside the procedure: another baud rate, {ratio} that of {}", side.other()
    )]
    OtherRate {
        /// Who sends them.
        side: Side,
        /// Its rate over that of the other side, which is that of the tap.
        ratio: BaudRatio,
    },
    /// Characters of both sides differ from what the tap is set to in the same way.
    #[error("neither side can be read: the tap is set to another parity than both of them")]
    TapParity,
    /// Characters of both sides read as STX, DLE and NAK of another baud rate.
    #[error("neither side can be read: the baud rate of the line is {ratio} that of the tap")]
    TapRate {
        /// The rate of both over that of the tap.
        ratio: BaudRatio,
    },
    /// Characters of both sides cannot be read.
    #[error("neither side can be read: parity or baud rate of the tap, or of the line, is another")]
    BothGarbage,
}

impl Verdict {
    /// Whether something is wrong with the line; repeats are, silence alone is not.
    #[must_use]
    pub const fn is_fault(&self) -> bool {
        !matches!(self, Self::Silent | Self::Open | Self::Works)
    }

    /// The measurement that separates the causes in the sentence, where it names more than one.
    #[must_use]
    pub const fn measurement(&self) -> Option<&'static str> {
        Some(match self {
            Self::NoAnswer { .. } => {
                "let it send: if its STX is heard, its receive line is at fault or it is set to another baud rate; if nothing is heard, it is off or its transmit line is open"
            }
            Self::NoLongerAnswers { .. } => {
                "restart it: if its NAK of start-up or an STX is heard, it lives and does not hear"
            }
            Self::NotHeard { .. } => {
                "measure at the receive pin of the one that does not react: idle is -3 V or less with RS-232; no voltage is an open wire, and characters there are a wrong baud rate or a defective receiver"
            }
            Self::NeitherHears => {
                "measure both receive pins in idle: no voltage is an open wire; -3 V or less on both transmit pins and none on the receive pins are crossed lines"
            }
            Self::TapDeaf { .. } | Self::OneInput { .. } => {
                "unplug one side: what is still heard on each input shows to whom it belongs"
            }
            Self::Echo | Self::OwnEcho { .. } => {
                "unplug the partner and let the side send: with an echo it goes on to hear its own STX"
            }
            Self::SamePriority { .. } => {
                "let one side alone send: with the same priority its telegrams get through, with an echo they do not"
            }
            Self::BadBlocks { .. } => {
                "halve the baud rate: noise becomes rare, a wrong setting stays"
            }
            Self::OtherBcc { formula, .. } => return formula.measurement(),
            Self::NotDoubled { .. } => "let it send a telegram without 10h: that gets through",
            Self::SameDamage { .. } => {
                "compare one of its blocks on the line with what it should send, byte by byte"
            }
            Self::GoodBlocksRejected { .. } => {
                "tap at the connector of the one that rejects: if the blocks are good there, its settings or its receiver are at fault"
            }
            Self::LongBlocksRejected { .. } => {
                "send the shortest rejected telegram ten times: a set length rejects all of them"
            }
            Self::NoAcknowledgement { .. } | Self::RequestForAnswer { .. } => {
                "send the shortest telegram: if it is answered, the block length or a character in the longer ones is the cause"
            }
            Self::Garbage { .. }
            | Self::BothGarbage
            | Self::OtherRate {
                ratio: BaudRatio::DoubleOrMore,
                ..
            }
            | Self::TapRate {
                ratio: BaudRatio::DoubleOrMore,
            } => {
                "measure the shortest pulse of its characters with an oscilloscope: it is one bit, 104 us at 9600 bit/s; if that fits, parity or data bits differ"
            }
            _ => return None,
        })
    }
}

const fn name(priority: Priority) -> &'static str {
    match priority {
        Priority::High => "high",
        Priority::Low => "low",
    }
}

const fn opposite(priority: Priority) -> Priority {
    match priority {
        Priority::High => Priority::Low,
        Priority::Low => Priority::High,
    }
}

/// `12.345678 s`.
struct Seconds(Duration);

impl fmt::Display for Seconds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{:06} s", self.0.as_secs(), self.0.subsec_micros())
    }
}
