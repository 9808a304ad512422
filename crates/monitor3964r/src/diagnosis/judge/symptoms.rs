//! What goes wrong at each side, whatever its cause, and which of it a verdict explains: what is left
//! is a second fault, or that there is more.

use super::Case;
use crate::{diagnosis::verdict::Verdict, monitor::Side};

/// As often, it is no accident; of the blocks or requests it must be a third too.
const OFTEN: u32 = 2;

/// What goes wrong at a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symptom {
    /// Its blocks arrive damaged, or with another BCC.
    Bad,
    /// Its blocks have no BCC.
    WithoutBcc,
    /// Its blocks do not come to their end.
    Unfinished,
    /// It pauses in its blocks.
    Pauses,
    /// It answers good blocks with NAK.
    Rejects,
    /// It does not answer blocks.
    NoAcknowledgement,
    /// It answers blocks at their ETX.
    AcknowledgesEarly,
    /// It answers STX with NAK.
    Refuses,
    /// It does not answer STX.
    NoAnswer,
    /// Its answers come too late.
    Late,
}

impl Case<'_> {
    /// Something else goes wrong besides what these verdicts explain.
    pub(in crate::diagnosis) fn has_more(&self, verdicts: [Option<Verdict>; 3]) -> bool {
        Side::BOTH.into_iter().any(|side| {
            self.symptoms(side)
                .into_iter()
                .any(|(symptom, count, all)| {
                    let is_rule = count >= OFTEN && count.saturating_mul(3) >= all;
                    let mut verdicts = verdicts.iter().flatten();
                    is_rule && !verdicts.any(|&verdict| explains(verdict, symptom, side))
                })
        })
    }

    /// How often each shows at this side, and of how many blocks or requests.
    fn symptoms(&self, side: Side) -> [(Symptom, u32, u32); 10] {
        let (own, other) = (self.side(side), self.side(side.other()));
        let (blocks, heard, requests) = (own.blocks(), other.blocks(), other.requests);
        let early = own.bcc_not_awaited.max(own.nak_after_dle);
        let late = if self.late(side).is_some() { OFTEN } else { 0 };
        [
            (Symptom::Bad, own.bad, blocks),
            (Symptom::WithoutBcc, own.without_bcc, blocks),
            (Symptom::Unfinished, own.unfinished, blocks),
            (Symptom::Pauses, own.gaps, blocks),
            (Symptom::Rejects, other.good_rejected, heard),
            (Symptom::NoAcknowledgement, other.unacknowledged, heard),
            (Symptom::AcknowledgesEarly, early, heard),
            (Symptom::Refuses, other.refused, requests),
            (Symptom::NoAnswer, own.unanswered, requests),
            (Symptom::Late, late, OFTEN),
        ]
    }
}

/// What a verdict that may be the second one is about, and at which side.
pub(super) const fn shown_by(verdict: Verdict) -> Option<(Symptom, Side)> {
    Some(match verdict {
        Verdict::NotDoubled { sender, .. } | Verdict::OtherBcc { sender, .. } => {
            (Symptom::Bad, sender)
        }
        Verdict::WithoutBcc { side } => (Symptom::WithoutBcc, side),
        Verdict::Late { side, .. } => (Symptom::Late, side),
        Verdict::NoReceiveBuffer { refuser } => (Symptom::Refuses, refuser),
        Verdict::GoodBlocksRejected { refuser, .. } => (Symptom::Rejects, refuser),
        Verdict::Gaps { sender, .. } => (Symptom::Pauses, sender),
        _ => return None,
    })
}

/// Whether a symptom at a side may come of what a verdict says.
pub(super) fn explains(verdict: Verdict, symptom: Symptom, side: Side) -> bool {
    use Symptom::{
        AcknowledgesEarly, Bad, Late, NoAcknowledgement, NoAnswer, Pauses, Refuses, Rejects,
        Unfinished, WithoutBcc,
    };
    // Where the fault is, what shows there, and what shows at the partner.
    let (at, own, partner): (Side, &[Symptom], &[Symptom]) = match verdict {
        Verdict::Gaps { sender, .. } => (sender, &[Pauses, Unfinished], &[NoAcknowledgement]),
        // What it does not hear of the answers has it break off.
        Verdict::GoodBlocksRejected { refuser, .. } => {
            (refuser, &[Rejects, Unfinished, Pauses], &[])
        }
        Verdict::LongBlocksRejected { refuser, .. } => (refuser, &[Rejects], &[]),
        // Its answers, and the NAK at the end of a block that it gives up, meet the next question or
        // block, which cuts off its own; and the times of the other side are counted from them.
        Verdict::Late { side, .. } => (
            side,
            &[
                Late,
                Pauses,
                Unfinished,
                Rejects,
                Refuses,
                NoAnswer,
                NoAcknowledgement,
            ],
            &[Late, Rejects, Unfinished, WithoutBcc],
        ),
        Verdict::NoReceiveBuffer { refuser } => (refuser, &[Refuses], &[]),
        Verdict::NotDoubled { sender, .. } => (
            sender,
            &[Bad, Unfinished],
            &[NoAnswer, NoAcknowledgement, Rejects],
        ),
        Verdict::OtherBcc { sender, .. } | Verdict::SameDamage { sender, .. } => {
            (sender, &[Bad], &[])
        }
        Verdict::WithoutBcc { side } => (
            side,
            &[WithoutBcc, AcknowledgesEarly, Unfinished],
            // An STX in place of its answer to a block is refused.
            &[NoAcknowledgement, Rejects, Refuses],
        ),
        Verdict::RequestForAnswer { side, .. } => (side, &[NoAcknowledgement], &[NoAnswer]),
        Verdict::NoAcknowledgement { silent } => (silent, &[NoAcknowledgement], &[]),
        Verdict::BadBlocks { sender, .. } => {
            (sender, &[Bad, Unfinished, Pauses], &[NoAcknowledgement])
        }
        Verdict::BadBlocksAccepted { receiver } => (receiver, &[], &[Bad]),
        // These leave nothing of the line to look at, or say that nothing is wrong for good.
        _ => return true,
    };
    if side == at { own } else { partner }.contains(&symptom)
}
