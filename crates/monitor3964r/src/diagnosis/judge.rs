//! From the evidence to a verdict: the rules, in the order in which one fault shows as another.

mod also;
mod blocks;
mod symptoms;

use core::time::Duration;

use proto3964r::{Priority, frame::Check};

use super::{
    conduct::Conduct,
    delay::{repeats_of, tolerance},
    echo::Echo,
    evidence::Evidence,
    setting::Setting,
    verdict::Verdict,
};
use crate::monitor::{Character, PerSide, Side, since};

/// So many characters that nobody can read are no accident.
const GARBAGE: u32 = 3;

/// STX in a row without an answer, at the end of a record in which the line had worked.
const SILENT_AT_THE_END: u32 = 3;

/// How long a side takes to answer, and how long the other waits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Late {
    pub(super) delay: Duration,
    pub(super) qvz: Duration,
    /// Most answers come after the next question.
    pub(super) is_overtaken: bool,
}

/// What the rules look at.
#[derive(Debug)]
pub(super) struct Case<'c> {
    pub(super) record: &'c [Character],
    pub(super) evidence: &'c Evidence,
    pub(super) echo: Echo,
    pub(super) delays: PerSide<Option<Late>>,
    /// What is expected.
    pub(super) qvz: Duration,
    pub(super) check: Check,
}

/// At least half of them, and one.
const fn most(part: u32, all: u32) -> bool {
    part > 0 && part.saturating_mul(2) >= all
}

/// Later than the other side waits, and not by what is measured wrong.
fn is_too_late(delay: Duration, qvz: Duration) -> bool {
    since(qvz, delay) > tolerance(delay)
}

/// A rule for one side.
type Rule<'c> = fn(&Case<'c>, Side) -> Option<Verdict>;

impl<'c> Case<'c> {
    /// What can be said of one side, after what concerns both.
    const RULES: [Rule<'c>; 15] = [
        Self::without_bcc,
        Self::late,
        Self::not_heard,
        Self::no_answer,
        Self::other_bcc,
        Self::no_receive_buffer,
        Self::long_blocks_rejected,
        Self::good_blocks_rejected,
        Self::bad_blocks_accepted,
        Self::request_for_answer,
        Self::no_acknowledgement,
        Self::gaps,
        Self::same_damage,
        Self::bad_blocks,
        Self::garbage,
    ];

    /// The verdict, and the other cause where the sentence alone cannot decide.
    pub(super) fn verdict(&self) -> (Verdict, Option<Verdict>) {
        let (a, b) = (self.side(Side::A), self.side(Side::B));
        if a.characters == 0 && b.characters == 0 {
            return (Verdict::Silent, None);
        }
        if self.echo.is_everywhere() && self.echo.has_data() {
            return (Verdict::Echo, None);
        }
        // What goes on after its end reads as characters outside the procedure.
        if let Some(verdict) = Side::BOTH
            .into_iter()
            .find_map(|side| self.not_doubled(side))
        {
            return (verdict, None);
        }
        match Side::BOTH.map(|side| self.unreadable(side)) {
            [Some(a), Some(b)] => return (self.both_unreadable(a, b), None),
            [Some(verdict), None] | [None, Some(verdict)] => return (verdict, None),
            [None, None] => {}
        }
        if let Some(verdict) = self.tap() {
            return (verdict, None);
        }
        if let Some(verdict) = Side::BOTH.into_iter().find_map(|side| self.own_echo(side)) {
            return (verdict, None);
        }
        // A side that died in a conflict leaves it open.
        if let Some(verdict) = Side::BOTH
            .into_iter()
            .find_map(|side| self.no_longer_answers(side))
        {
            return (verdict, None);
        }
        if let Some(priority) = self.same_priority() {
            let verdict = Verdict::SamePriority { priority };
            return (verdict, self.other_cause(verdict));
        }
        if Side::BOTH.into_iter().all(|side| self.is_deaf(side)) {
            return (Verdict::NeitherHears, None);
        }
        if let Some(verdict) = self.same_setting() {
            return (verdict, None);
        }
        for rule in Self::RULES {
            for side in Side::BOTH {
                if let Some(verdict) = rule(self, side) {
                    return (verdict, self.other_cause(verdict));
                }
            }
        }
        (self.works(), None)
    }

    fn side(&self, side: Side) -> &Conduct {
        &self.evidence.sides[side]
    }

    /// What else a capture may show that looks like this.
    fn other_cause(&self, verdict: Verdict) -> Option<Verdict> {
        let never_reacted = |side: &Side| self.side(*side).reacted == 0;
        match verdict {
            Verdict::SamePriority {
                priority: Priority::Low,
            } => self.echo.is_everywhere().then_some(Verdict::Echo),
            // Two that insist, and two that do not hear, do the same.
            Verdict::SamePriority { .. } if Side::BOTH.iter().all(never_reacted) => {
                Some(Verdict::NeitherHears)
            }
            Verdict::SamePriority { .. } => {
                Side::BOTH
                    .into_iter()
                    .find(never_reacted)
                    .map(|listener| Verdict::NotHeard {
                        speaker: listener.other(),
                        listener,
                    })
            }
            Verdict::NoAnswer { silent } if self.side(silent).characters > 0 => {
                Some(Verdict::NotHeard {
                    speaker: silent.other(),
                    listener: silent,
                })
            }
            // Long blocks have more places for an error.
            Verdict::LongBlocksRejected { refuser, .. } => {
                let sender = self.side(refuser.other());
                Some(Verdict::GoodBlocksRejected {
                    refuser,
                    rejected: sender.good_rejected,
                    blocks: sender.blocks(),
                })
            }
            // Whether the speaker hears it does not show either; a NAK may look like an answer.
            Verdict::NotHeard { speaker, listener }
                if self.side(speaker).reacted.saturating_mul(8) <= self.side(listener).requests =>
            {
                Some(Verdict::NeitherHears)
            }
            // One that is reset again and again, each time so much later, repeats its STX too.
            Verdict::NotHeard { listener, .. } => self.late_repeats(listener),
            _ => None,
        }
    }

    /// Nothing of what this side sends makes sense.
    fn unreadable(&self, side: Side) -> Option<Verdict> {
        let Conduct {
            good,
            bad,
            unfinished,
            garbage,
            control,
            in_blocks,
            unreadable,
            without_bcc,
            ..
        } = *self.side(side);
        let outside = garbage >= GARBAGE && garbage >= control;
        // Data may be full of 00h: then the blocks come to their end.
        let inside = unreadable >= GARBAGE && most(unreadable, in_blocks) && bad <= unfinished;
        if good > 0 || without_bcc > 0 || !(outside || inside) {
            return None;
        }
        // STX, DLE and NAK have an odd number of ones: a stop bit looks like their parity bit.
        if inside && control >= GARBAGE && control.saturating_mul(8) >= garbage {
            return Some(Verdict::NoParity { side });
        }
        Some(match Setting::of(self.record, &[side]) {
            Some(Setting::Parity) => Verdict::OtherParity { side },
            Some(Setting::Rate(ratio)) => Verdict::OtherRate { side, ratio },
            None => Verdict::Garbage { side },
        })
    }

    /// What both sides, of which nothing makes sense, have in common.
    fn both_unreadable(&self, a: Verdict, b: Verdict) -> Verdict {
        match (a, b, Setting::of(self.record, &Side::BOTH)) {
            (Verdict::NoParity { .. }, Verdict::NoParity { .. }, _)
            | (_, _, Some(Setting::Parity)) => Verdict::TapParity,
            (_, _, Some(Setting::Rate(ratio))) => Verdict::TapRate { ratio },
            _ => Verdict::BothGarbage,
        }
    }

    /// One side answers what the other, which is never heard, must have said.
    fn tap(&self) -> Option<Verdict> {
        Side::BOTH.into_iter().find_map(|speaker| {
            let unheard = speaker.other();
            if self.side(unheard).characters > 0 {
                return None;
            }
            let Conduct {
                answered_itself,
                did_not_wait,
                ..
            } = *self.side(speaker);
            if answered_itself > 0 {
                Some(Verdict::OneInput { side: speaker })
            } else if did_not_wait > 0 {
                Some(Verdict::TapDeaf { speaker, unheard })
            } else {
                None
            }
        })
    }

    /// It never reacts to the other, although it should have.
    fn is_deaf(&self, side: Side) -> bool {
        let Conduct {
            ignored, reacted, ..
        } = *self.side(side);
        ignored > reacted.saturating_mul(4)
    }

    fn same_priority(&self) -> Option<Priority> {
        if Side::BOTH.into_iter().any(|side| self.is_deaf(side)) {
            return None;
        }
        let Evidence {
            both_gave_way,
            stalemates,
            resolved,
            ..
        } = *self.evidence;
        let conflicts = self.side(Side::A).conflicts;
        // Whoever refuses the other is seldom in conflict with it.
        let refused = Side::BOTH.map(|side| self.side(side).refused);
        if both_gave_way > 0 && most(both_gave_way, conflicts / 2) {
            Some(Priority::Low)
        } else if stalemates > 1
            && most(stalemates, conflicts)
            && resolved.saturating_mul(4) <= stalemates
            && refused.into_iter().all(|refused| refused <= stalemates)
        {
            Some(Priority::High)
        } else {
            None
        }
    }

    /// Both sides agree, but not with what was expected of them.
    fn same_setting(&self) -> Option<Verdict> {
        let mut sides = Side::BOTH.into_iter().map(|side| self.side(side));
        if sides.all(|own| own.accepted == 0) {
            return None;
        }
        // Noise spoils some.
        let few = |part: u32, own: &Conduct| part.saturating_mul(4) <= own.blocks();
        let works = |own: &Conduct| few(own.blocks().saturating_sub(own.accepted), own);
        let verdict = match self.check {
            Check::Bcc => Verdict::BothWithoutBcc,
            Check::None => Verdict::BothWithBcc,
        };
        Side::BOTH
            .into_iter()
            .all(|side| {
                let (own, other) = (self.side(side), self.side(side.other()));
                let as_expected = match self.check {
                    Check::Bcc => own.good.saturating_add(own.bad),
                    Check::None => own.without_bcc,
                };
                // Who acknowledges at ETX takes the BCC of the other for noise.
                let noticed = other.bcc_not_awaited.max(other.nak_after_dle);
                works(own) && few(as_expected, own) && few(noticed, own)
            })
            .then_some(verdict)
    }

    pub(super) fn late(&self, side: Side) -> Option<Verdict> {
        let sender = self.side(side.other());
        let found @ Late { delay, qvz, .. } = self.delays[side]?;
        let works = sender.accepted > sender.rejected && sender.unanswered < sender.accepted;
        if works && !found.is_overtaken {
            return None;
        }
        // Twice as long, it is the wait for an answer of the other side that is late itself.
        if let Some(other) = self.delays[side.other()]
            && is_too_late(other.delay, other.qvz)
            && delay >= other.delay.saturating_mul(2)
        {
            return None;
        }
        is_too_late(delay, qvz).then_some(Verdict::Late { side, delay, qvz })
    }

    fn late_repeats(&self, side: Side) -> Option<Verdict> {
        let (delay, qvz) = (repeats_of(self.record, side)?, self.qvz);
        is_too_late(delay, qvz).then_some(Verdict::Late { side, delay, qvz })
    }

    fn not_heard(&self, listener: Side) -> Option<Verdict> {
        self.is_deaf(listener).then_some(Verdict::NotHeard {
            speaker: listener.other(),
            listener,
        })
    }

    fn no_answer(&self, silent: Side) -> Option<Verdict> {
        let requests = self.side(silent.other()).requests;
        let Conduct {
            unanswered,
            reacted,
            ..
        } = *self.side(silent);
        (reacted == 0 && most(unanswered, requests)).then_some(Verdict::NoAnswer { silent })
    }

    fn no_longer_answers(&self, silent: Side) -> Option<Verdict> {
        let Conduct {
            unanswered_at_end,
            reacted,
            last,
            ..
        } = *self.side(silent);
        let has_died = reacted > 0 && unanswered_at_end >= SILENT_AT_THE_END;
        has_died.then_some(Verdict::NoLongerAnswers { silent, last })
    }

    /// Less than would make it unreadable, and nothing else is known.
    fn garbage(&self, side: Side) -> Option<Verdict> {
        let nothing = Side::BOTH
            .into_iter()
            .all(|side| self.side(side).blocks() == 0 && self.side(side).requests == 0);
        let own = self.side(side);
        (nothing && own.garbage > 0).then_some(Verdict::Garbage { side })
    }

    /// Nothing is wrong for good.
    fn works(&self) -> Verdict {
        let repeated = |side| {
            let own = self.side(side);
            own.blocks().saturating_sub(own.accepted)
        };
        let sender = if repeated(Side::A) >= repeated(Side::B) {
            Side::A
        } else {
            Side::B
        };
        let Conduct { bad: damaged, .. } = *self.side(sender);
        let mut accepted = Side::BOTH.into_iter().map(|side| self.side(side).accepted);
        match repeated(sender) {
            _ if accepted.all(|accepted| accepted == 0) => Verdict::Open,
            0 => Verdict::Works,
            repeated => Verdict::WorksWithRepeats {
                sender,
                repeated,
                damaged,
                blocks: self.side(sender).blocks(),
            },
        }
    }
}
