//! What goes wrong at each side, whatever its cause, and which of it a verdict explains: what is left
//! is a second fault, or that there is more.

use super::Case;
use crate::{diagnosis::verdict::Verdict, monitor::Side};

/// How much of the blocks or requests of a side: one of so many.
type Share = u32;

/// What shows, and up to which share.
type Shown = [(Symptom, Share)];

/// Whatever shows is explained.
const ALL: Share = 0;
const HALF: Share = 2;
const THIRD: Share = 3;
const EIGHTH: Share = 8;
const TENTH: Share = 10;
const LITTLE: Share = 25;

/// As often, it is no accident: twice where it is a third of them, else three times.
const fn often(share: Share) -> u32 {
    if share <= THIRD { 2 } else { 3 }
}

/// What goes wrong at a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symptom {
    /// Its blocks arrive damaged, or with another BCC.
    Bad,
    /// Of its bad blocks, those in which 10h stands alone.
    Undoubled,
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
    /// It goes on as if it had not heard an STX or an answer.
    Ignores,
    /// Its answers come too late.
    Late,
}

impl Case<'_> {
    /// Something else goes wrong besides what these verdicts explain.
    pub(in crate::diagnosis) fn has_more(&self, verdicts: [Option<Verdict>; 3]) -> bool {
        Side::BOTH.into_iter().any(|side| {
            self.symptoms(side)
                .into_iter()
                .any(|(symptom, count, all, share)| {
                    let shows = |share| {
                        let is_part = count.saturating_mul(share) >= all;
                        share != ALL && count >= often(share) && is_part
                    };
                    let mut explained = verdicts
                        .iter()
                        .flatten()
                        .filter_map(|&verdict| explained(verdict, symptom, side));
                    shows(share) && explained.all(shows)
                })
        })
    }

    /// How often each shows at this side, of how many blocks or requests, and the share of them that
    /// no other fault brings about, nor noise.
    fn symptoms(&self, side: Side) -> [(Symptom, u32, u32, Share); 12] {
        let (own, other) = (self.side(side), self.side(side.other()));
        let (blocks, heard, requests) = (own.blocks(), other.blocks(), other.requests);
        let answers = own.reacted;
        let early = own.bcc_not_awaited.max(own.nak_after_dle);
        let ignored = own.ignored.saturating_add(own.unanswered);
        let late = if self.late(side).is_some() {
            answers
        } else {
            0
        };
        [
            (Symptom::Bad, own.bad, blocks, THIRD),
            (Symptom::Undoubled, own.frames.undoubled, own.bad, EIGHTH),
            (
                Symptom::WithoutBcc,
                self.without_bcc_for_sure(side),
                blocks,
                THIRD,
            ),
            (Symptom::Unfinished, own.unfinished, blocks, TENTH),
            (Symptom::Pauses, own.gaps, blocks, TENTH),
            (Symptom::Rejects, other.good_rejected, heard, LITTLE),
            (
                Symptom::NoAcknowledgement,
                other.unacknowledged,
                heard,
                EIGHTH,
            ),
            (Symptom::AcknowledgesEarly, early, heard, EIGHTH),
            (Symptom::Refuses, other.refused, requests, THIRD),
            (Symptom::NoAnswer, own.unanswered, requests, LITTLE),
            (Symptom::Ignores, ignored, answers, LITTLE),
            (Symptom::Late, late, answers, HALF),
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
    explained(verdict, symptom, side).is_some()
}

/// Up to which share a symptom at a side may come of what a verdict says, if it may: as
/// measured on simulated lines with this fault alone, and somewhat more.
fn explained(verdict: Verdict, symptom: Symptom, side: Side) -> Option<Share> {
    use Symptom::{
        AcknowledgesEarly, Bad, Ignores, Late, NoAcknowledgement, NoAnswer, Pauses, Refuses,
        Rejects, Undoubled, Unfinished, WithoutBcc,
    };
    // Where the fault is, what shows there, and what shows at the partner.
    let (at, own, partner): (Side, &Shown, &Shown) = match verdict {
        Verdict::Gaps { sender, .. } => (
            sender,
            &[(Pauses, ALL), (Unfinished, ALL)],
            &[(NoAcknowledgement, ALL)],
        ),
        // What it does not hear of the answers has it break off.
        Verdict::GoodBlocksRejected { refuser, .. } => (
            refuser,
            &[
                (Rejects, ALL),
                (Unfinished, HALF),
                (Pauses, HALF),
                (NoAnswer, THIRD),
                (Ignores, THIRD),
            ],
            &[(NoAnswer, THIRD), (Ignores, THIRD)],
        ),
        Verdict::LongBlocksRejected { refuser, .. } => (refuser, &[(Rejects, ALL)], &[]),
        // Its answers, and the NAK at the end of a block that it gives up, meet the next question or
        // block, which cuts off its own; and the times of the other side are counted from them.
        Verdict::Late { side, .. } => (
            side,
            &[
                (Late, ALL),
                (Pauses, ALL),
                (Unfinished, ALL),
                (Rejects, ALL),
                (Refuses, ALL),
                (NoAnswer, ALL),
                (NoAcknowledgement, ALL),
                (Ignores, ALL),
            ],
            &[
                (Late, ALL),
                (Rejects, ALL),
                (Unfinished, ALL),
                (NoAnswer, HALF),
                (Ignores, HALF),
            ],
        ),
        Verdict::NoReceiveBuffer { refuser } => (
            refuser,
            &[(Refuses, ALL), (NoAnswer, EIGHTH), (Ignores, EIGHTH)],
            &[],
        ),
        Verdict::NotDoubled { sender, .. } => (
            sender,
            &[
                (Bad, ALL),
                (Undoubled, ALL),
                (Unfinished, ALL),
                (Pauses, THIRD),
                (Ignores, EIGHTH),
                (NoAnswer, EIGHTH),
            ],
            &[
                (NoAnswer, TENTH),
                (Ignores, TENTH),
                (NoAcknowledgement, ALL),
            ],
        ),
        Verdict::OtherBcc { sender, .. } | Verdict::SameDamage { sender, .. } => {
            (sender, &[(Bad, ALL)], &[])
        }
        Verdict::WithoutBcc { side } => (
            side,
            &[
                (WithoutBcc, ALL),
                (AcknowledgesEarly, ALL),
                (Unfinished, ALL),
            ],
            // An STX in place of its answer to a block is refused.
            &[(NoAcknowledgement, ALL), (Rejects, ALL), (Refuses, ALL)],
        ),
        Verdict::RequestForAnswer { side, .. } => (
            side,
            &[(NoAcknowledgement, ALL)],
            &[(NoAnswer, ALL), (Ignores, ALL)],
        ),
        Verdict::NoAcknowledgement { silent } => (silent, &[(NoAcknowledgement, ALL)], &[]),
        Verdict::BadBlocks { sender, .. } => (
            sender,
            &[(Bad, ALL), (Unfinished, ALL), (Pauses, ALL)],
            &[(NoAcknowledgement, ALL)],
        ),
        Verdict::BadBlocksAccepted { receiver } => (receiver, &[], &[(Bad, ALL)]),
        // These leave nothing of the line to look at, or say that nothing is wrong for good.
        _ => return Some(ALL),
    };
    let shown = if side == at { own } else { partner };
    let found = shown.iter().find(|(shown, _)| *shown == symptom);
    found.map(|&(_, share)| share)
}
