//! What speaks for and against each fault, counted over a record.

use core::time::Duration;

use proto3964r::{
    Config,
    ascii::{DLE, NAK, STX},
    frame::{Check, FrameError},
};

use super::conduct::Conduct;
use crate::monitor::{Character, Conversation, Mark, Observation, PerSide, Side, since};

/// Two timers of the same length end within this time.
const TOGETHER: Duration = Duration::from_millis(30);

/// The last block, as long as it waits for its answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Block {
    Good { len: u32 },
    Bad,
    WithoutBcc,
}

/// Counts of a record.
#[derive(Clone, Debug)]
pub(super) struct Evidence {
    pub(super) sides: PerSide<Conduct>,
    /// Conflicts that no DLE ended, and those that one did.
    pub(super) stalemates: u32,
    pub(super) resolved: u32,
    pub(super) both_gave_way: u32,
    conflict_is_open: bool,
    /// The one before has not ended.
    conflict_goes_on: bool,
    block: Option<Block>,
    /// A character of the block came in damaged.
    is_damaged: bool,
    /// Who may send, as long as nothing of the block has come.
    invited: Option<Side>,
    last_in_block: Option<Duration>,
    /// Who acknowledged the last block and when, until something else is said.
    accepted: Option<(Side, Duration)>,
    /// Whose block paused, and when the other answered that with NAK.
    paused: Option<(Side, Option<Duration>)>,
    zvz: Duration,
}

impl Evidence {
    pub(super) fn of(record: &[Character], config: &Config) -> Self {
        let mut evidence = Self {
            sides: PerSide::both(Conduct::default()),
            stalemates: 0,
            resolved: 0,
            both_gave_way: 0,
            conflict_is_open: false,
            conflict_goes_on: false,
            block: None,
            is_damaged: false,
            invited: None,
            last_in_block: None,
            accepted: None,
            paused: None,
            zvz: config.zvz(),
        };
        // With this rule a block without BCC shows as such; with the other a BCC shows as noise.
        let mut conversation = Conversation::new(config, Check::Bcc);
        for &heard in record {
            conversation.take(heard);
            for mark in conversation.marks().iter() {
                if let Mark::Other(Observation::Connected { .. } | Observation::DidNotWait { .. }) =
                    mark
                {
                    evidence.is_damaged = false;
                    evidence.last_in_block = None;
                    for side in Side::BOTH {
                        evidence.sides[side].frames.begin();
                    }
                }
            }
            evidence.character(heard, &conversation);
            for mark in conversation.marks().iter() {
                match mark {
                    Mark::Block { by, len } => evidence.end_of_block(by, Some(len), &conversation),
                    Mark::Other(Observation::BadBlock { by, error }) => {
                        evidence.end_of_block(by, None, &conversation);
                        evidence.bad_block(by, heard.at, error);
                    }
                    Mark::Other(Observation::BccNotAwaited { .. }) => {
                        evidence.late_bcc(heard, &conversation);
                    }
                    Mark::Other(observation) => evidence.observe(heard, observation),
                }
            }
        }
        evidence
    }

    fn character(&mut self, heard: Character, conversation: &Conversation) {
        let Character { at, side, byte, .. } = heard;
        let conduct = &mut self.sides[side];
        count(&mut conduct.characters);
        conduct.last = at;
        conduct.unanswered_at_end = 0;
        if conversation.took_for_block() {
            count(&mut conduct.in_blocks);
            if heard.error.is_some() || byte == 0 {
                count(&mut conduct.unreadable);
            }
            if let Some(before) = self.last_in_block.replace(at) {
                conduct.longest_gap = conduct.longest_gap.max(since(before, at));
            }
            conduct.frames.take(byte);
            self.is_damaged |= heard.error.is_some();
            if self.invited.take() == Some(side) {
                count(&mut conduct.reacted);
            }
        } else {
            conduct.frames.after_block(heard);
            if matches!(heard.intact(), Some(STX | DLE | NAK)) {
                count(&mut conduct.control);
            }
        }
    }

    fn bad_block(&mut self, by: Side, at: Duration, error: FrameError) {
        if !self.is_damaged {
            let has_illegal_dle = matches!(error, FrameError::IllegalDle { .. });
            self.sides[by].frames.is_bad(at, has_illegal_dle);
        }
    }

    fn end_of_block(&mut self, by: Side, len: Option<u32>, conversation: &Conversation) {
        let conduct = &mut self.sides[by];
        self.block = Some(match len {
            Some(len) if !self.is_damaged => {
                count(&mut conduct.good);
                conduct.frames.is_good();
                Block::Good { len }
            }
            _ => {
                count(&mut conduct.bad);
                Block::Bad
            }
        });
        if let Some(bcc) = conversation.scan().bcc().filter(|_| !self.is_damaged) {
            conduct.formulas.note(bcc);
        }
    }

    /// The BCC of a block that was answered before it.
    fn late_bcc(&mut self, heard: Character, conversation: &Conversation) {
        count(&mut self.sides[heard.side.other()].bcc_not_awaited);
        let conduct = &mut self.sides[heard.side];
        conduct.frames.take(heard.byte);
        if let Some(bcc) = conversation.scan().bcc() {
            count(&mut conduct.good);
            conduct.frames.is_good();
            conduct.formulas.note(bcc);
        } else {
            // Before it came a DLE with what may not follow one.
            count(&mut conduct.bad);
            conduct.frames.is_bad(heard.at, true);
        }
    }

    fn observe(&mut self, heard: Character, observation: Observation<'_>) {
        match observation {
            Observation::Request { side, .. } => self.request(side),
            Observation::Conflict => {
                count(&mut self.sides[heard.side].conflicts);
                if !self.conflict_goes_on {
                    count(&mut self.sides[heard.side.other()].conflicts);
                }
                self.conflict_is_open = true;
                self.conflict_goes_on = true;
            }
            Observation::RequestUnanswered { side, .. } => count(&mut self.sides[side].ignored),
            Observation::BothGaveWay => {
                count(&mut self.both_gave_way);
                self.resolved = self.resolved.saturating_sub(1);
                self.invited = None;
            }
            Observation::Connected { by, delay } => {
                self.answered(by);
                longest(&mut self.sides[by].worst_answer, delay);
                if core::mem::take(&mut self.conflict_is_open) {
                    count(&mut self.resolved);
                }
                self.conflict_goes_on = false;
                self.invited = Some(by.other());
                self.block = None;
            }
            Observation::Refused { by, .. } => {
                self.answered(by);
                count(&mut self.sides[by.other()].refused);
            }
            Observation::DidNotWait { side } => {
                let conduct = &mut self.sides[side];
                if heard.byte == DLE {
                    count(&mut conduct.answered_itself);
                } else {
                    count(&mut conduct.did_not_wait);
                }
            }
            Observation::Reset { side } => self.reset(heard.at, side),
            Observation::NoAnswer { silent, .. } => self.no_answer(silent),
            Observation::Stray { side, byte } => {
                if heard.error.is_some() || !matches!(byte, STX | DLE | NAK) {
                    count(&mut self.sides[side].garbage);
                }
            }
            _ => self.observe_block(heard, observation),
        }
    }

    fn observe_block(&mut self, heard: Character, observation: Observation<'_>) {
        match observation {
            Observation::NoBlock { by, .. } => count(&mut self.sides[by].ignored),
            Observation::NoBcc { by } => {
                count(&mut self.sides[by].without_bcc);
                self.block = Some(Block::WithoutBcc);
            }
            Observation::Accepted { by, delay } => self.accept(by, delay),
            Observation::Rejected { by, .. } => self.reject(by),
            Observation::Aborted { by } => {
                count(&mut self.sides[by.other()].unfinished);
                if let Some((_, answered)) = &mut self.paused {
                    *answered = Some(heard.at);
                }
                count(&mut self.sides[by].reacted);
            }
            Observation::BrokenOff { by } => {
                let conduct = &mut self.sides[by];
                count(&mut conduct.unfinished);
                count(&mut conduct.broken_off);
                conduct.gaps = conduct.gaps.saturating_sub(1);
                self.paused = None;
            }
            Observation::Gap { by, gap } => {
                let conduct = &mut self.sides[by];
                count(&mut conduct.gaps);
                conduct.longest_gap = conduct.longest_gap.max(gap);
                self.paused = Some((by, None));
            }
            Observation::RequestForAnswer { by, delay } => {
                let conduct = &mut self.sides[by];
                count(&mut conduct.requests_for_answers);
                conduct.longest_request_for_answer = conduct.longest_request_for_answer.max(delay);
            }
            _ => {}
        }
    }

    /// DLE to a block.
    fn accept(&mut self, by: Side, delay: Duration) {
        let receiver = &mut self.sides[by];
        count(&mut receiver.reacted);
        longest(&mut receiver.worst_acknowledgement, delay);
        let sender = &mut self.sides[by.other()];
        count(&mut sender.accepted);
        match self.block.take() {
            Some(Block::Good { len }) => sender.longest_accepted = sender.longest_accepted.max(len),
            Some(Block::Bad) => count(&mut sender.bad_accepted),
            Some(Block::WithoutBcc) | None => {}
        }
        self.accepted = Some((by, self.sides[by].last));
    }

    /// NAK to a block.
    fn reject(&mut self, by: Side) {
        count(&mut self.sides[by].reacted);
        let sender = &mut self.sides[by.other()];
        count(&mut sender.rejected);
        if let Some(Block::Good { len }) = self.block.take() {
            count(&mut sender.good_rejected);
            let shortest = sender
                .shortest_rejected
                .map_or(len, |shortest| shortest.min(len));
            sender.shortest_rejected = Some(shortest);
        }
    }

    fn request(&mut self, side: Side) {
        count(&mut self.sides[side].requests);
        self.accepted = None;
        self.block = None;
        self.paused = None;
        self.invited = None;
        if core::mem::take(&mut self.conflict_is_open) {
            count(&mut self.stalemates);
        }
    }

    /// DLE or NAK to STX.
    fn answered(&mut self, by: Side) {
        count(&mut self.sides[by].reacted);
    }

    fn no_answer(&mut self, silent: Side) {
        match self.block.take() {
            Some(_) => {
                let sender = &mut self.sides[silent.other()];
                count(&mut sender.unacknowledged);
            }
            None => {
                let conduct = &mut self.sides[silent];
                count(&mut conduct.unanswered);
                count(&mut conduct.unanswered_at_end);
            }
        }
    }

    /// A NAK that answers nothing.
    fn reset(&mut self, now: Duration, side: Side) {
        // Sender and receiver send NAK after the same silence: the sender has stopped for itself.
        if let Some((by, Some(answered))) = self.paused.take()
            && by == side
            && since(answered, now) <= TOGETHER
        {
            let conduct = &mut self.sides[side];
            count(&mut conduct.broken_off);
            conduct.gaps = conduct.gaps.saturating_sub(1);
        }
        // A BCC that came as noise is answered after ZVZ of silence; half of it, as the partner's
        // ZVZ may be shorter than the one given here.
        let after = |&(by, at): &(Side, Duration)| {
            by == side && since(at, now) >= self.zvz / 2 && since(at, now) <= self.zvz * 4
        };
        if self.accepted.take().filter(after).is_some() {
            count(&mut self.sides[side].nak_after_dle);
        }
    }
}

fn count(counter: &mut u32) {
    *counter = counter.saturating_add(1);
}

fn longest(worst: &mut Option<Duration>, time: Duration) {
    *worst = Some(worst.map_or(time, |worst| worst.max(time)));
}
