//! The rules about blocks and the answers to them.

use super::{Case, most};
use crate::{
    diagnosis::{conduct::Conduct, verdict::Verdict},
    monitor::Side,
};

impl Case<'_> {
    pub(super) fn without_bcc(&self, side: Side) -> Option<Verdict> {
        let own = self.side(side);
        let as_sender = most(self.without_bcc_for_sure(side), own.blocks());
        let noticed = own.bcc_not_awaited.max(own.nak_after_dle);
        // An answer that is too late says nothing of the block before it.
        let as_receiver =
            self.late(side.other()).is_none() && most(noticed, self.side(side.other()).blocks());
        (as_sender || as_receiver).then_some(Verdict::WithoutBcc { side })
    }

    /// Blocks of this side without a BCC; none where the other is late and may do without one as
    /// well: that shows in its own blocks alone.
    pub(super) fn without_bcc_for_sure(&self, side: Side) -> u32 {
        let is_known = self.late(side.other()).is_none() || self.side(side.other()).good > 0;
        if is_known {
            self.side(side).without_bcc
        } else {
            0
        }
    }

    pub(super) fn other_bcc(&self, sender: Side) -> Option<Verdict> {
        let formula = self.side(sender).formulas.rule()?;
        Some(Verdict::OtherBcc { sender, formula })
    }

    pub(super) fn not_doubled(&self, sender: Side) -> Option<Verdict> {
        let own = self.side(sender);
        let blocks = own.frames.undoubled;
        let bad = own.bad.saturating_add(own.unfinished);
        // Noise takes one half of a pair now and then.
        let is_rule = blocks > 1 && blocks > own.frames.doubled;
        (is_rule && most(blocks, bad)).then_some(Verdict::NotDoubled { sender, blocks })
    }

    pub(super) fn same_damage(&self, sender: Side) -> Option<Verdict> {
        let own = self.side(sender);
        let (bad, blocks) = (own.bad, own.blocks());
        (own.frames.same > 1 && most(own.frames.same, bad)).then_some(Verdict::SameDamage {
            sender,
            bad,
            blocks,
        })
    }

    pub(super) fn no_receive_buffer(&self, refuser: Side) -> Option<Verdict> {
        let Conduct {
            refused, requests, ..
        } = *self.side(refuser.other());
        most(refused, requests).then_some(Verdict::NoReceiveBuffer { refuser })
    }

    pub(super) fn own_echo(&self, side: Side) -> Option<Verdict> {
        // A late side answers what was given up long ago; and where the other pauses, this one may
        // do so too.
        if self.late(side).is_some() || self.mostly_gaps(side.other()).is_some() {
            return None;
        }
        let own = self.side(side);
        let alone = own.broken_off.saturating_add(own.answered_itself);
        most(alone, own.blocks()).then_some(Verdict::OwnEcho { side })
    }

    pub(super) fn long_blocks_rejected(&self, refuser: Side) -> Option<Verdict> {
        let Conduct {
            good_rejected,
            longest_accepted: accepted,
            shortest_rejected,
            ..
        } = *self.side(refuser.other());
        let rejected = shortest_rejected?;
        (good_rejected > 1 && accepted > 0 && rejected > accepted).then_some(
            Verdict::LongBlocksRejected {
                refuser,
                accepted,
                rejected,
            },
        )
    }

    pub(super) fn good_blocks_rejected(&self, refuser: Side) -> Option<Verdict> {
        let sender = self.side(refuser.other());
        let (rejected, blocks) = (sender.good_rejected, sender.blocks());
        most(rejected, blocks).then_some(Verdict::GoodBlocksRejected {
            refuser,
            rejected,
            blocks,
        })
    }

    pub(super) fn bad_blocks_accepted(&self, receiver: Side) -> Option<Verdict> {
        let sender = self.side(receiver.other());
        // One among others may have begun before the record.
        let is_alone = sender.blocks() == 1;
        (most(sender.bad_accepted, sender.bad) && (is_alone || sender.bad_accepted > 1))
            .then_some(Verdict::BadBlocksAccepted { receiver })
    }

    pub(super) fn request_for_answer(&self, side: Side) -> Option<Verdict> {
        let Conduct {
            requests_for_answers,
            longest_request_for_answer: delay,
            ..
        } = *self.side(side);
        let (own, blocks) = (self.side(side), self.side(side.other()).blocks());
        // The STX of its own repeats, which come far more often.
        let repeats = own.blocks().saturating_sub(own.accepted);
        if most(repeats, own.blocks()) && repeats / 2 > blocks {
            return None;
        }
        most(requests_for_answers, blocks).then_some(Verdict::RequestForAnswer { side, delay })
    }

    pub(super) fn no_acknowledgement(&self, silent: Side) -> Option<Verdict> {
        let sender = self.side(silent.other());
        most(sender.unacknowledged, sender.blocks())
            .then_some(Verdict::NoAcknowledgement { silent })
    }

    pub(super) fn gaps(&self, sender: Side) -> Option<Verdict> {
        let own = self.side(sender);
        let blocks = own.blocks();
        let repeats = blocks.saturating_sub(own.accepted);
        // Also where the repeats get through.
        let is_cause =
            own.gaps > 1 && most(own.gaps, repeats) && own.gaps.saturating_mul(10) > blocks;
        (is_cause || most(own.gaps, blocks)).then_some(Verdict::Gaps {
            sender,
            longest: own.longest_gap,
        })
    }

    /// Also beside another fault, which may have it pause now and then.
    pub(super) fn mostly_gaps(&self, sender: Side) -> Option<Verdict> {
        let own = self.side(sender);
        self.gaps(sender).filter(|_| most(own.gaps, own.blocks()))
    }

    pub(super) fn bad_blocks(&self, sender: Side) -> Option<Verdict> {
        let own = self.side(sender);
        let bad = own.bad.saturating_add(own.unfinished);
        (bad > own.accepted).then_some(Verdict::BadBlocks {
            sender,
            bad,
            blocks: own.blocks(),
        })
    }
}
