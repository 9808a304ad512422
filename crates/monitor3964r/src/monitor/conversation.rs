//! What each character on a line is by the rules of the procedure, whoever breaks them.

use core::time::Duration;

mod waits;

use proto3964r::{
    Config,
    ascii::{DLE, NAK, STX},
    frame::Check,
};

use super::{
    character::{Character, since},
    observation::{Mark, Marks, Observation},
    scan::Scan,
    side::{PerSide, Side},
};
/// Two STX cross if they come within this time: several characters at any baud rate from 1200
/// upwards, and the latency of a USB adapter.
const CROSSING: Duration = Duration::from_millis(50);

/// Where a line stands, without the payloads.
#[derive(Clone, Debug)]
pub(crate) struct Conversation {
    qvz: Duration,
    zvz: Duration,
    check: Check,
    phase: Phase,
    /// The last character that belonged to the phase.
    last: Duration,
    /// The deadline of this wait was reported.
    overdue: bool,
    /// When each side sent STX, until something comes of it.
    waiting: PerSide<Option<Duration>>,
    /// The last STX of each side.
    asked: PerSide<Option<Duration>>,
    /// The other side's STX that each side has not answered, although nothing kept it from it.
    owing: PerSide<Option<Duration>>,
    /// STX in a row without a connection.
    attempts: PerSide<u8>,
    scan: Scan,
    /// The last character was part of a block.
    in_block: bool,
    marks: Marks,
}

/// What the line waits for. `by` is the side that sends the telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Idle,
    Requested {
        by: Side,
    },
    /// Both wait for DLE.
    Conflict,
    Block {
        by: Side,
        in_conflict: bool,
    },
    AwaitAck {
        by: Side,
    },
    /// The answer to a block came where its BCC was due.
    AnsweredEarly {
        by: Side,
        bcc: u8,
    },
}

impl Conversation {
    pub(crate) fn new(config: &Config, check: Check) -> Self {
        Self {
            qvz: config.qvz(),
            zvz: config.zvz(),
            check,
            phase: Phase::Idle,
            last: Duration::ZERO,
            overdue: false,
            waiting: PerSide::both(None),
            asked: PerSide::both(None),
            owing: PerSide::both(None),
            attempts: PerSide::both(0),
            scan: Scan::new(check),
            in_block: false,
            marks: Marks::default(),
        }
    }

    /// What the last character or timeout meant.
    pub(crate) const fn marks(&self) -> Marks {
        self.marks
    }

    /// The block under way, or the last one.
    pub(crate) const fn scan(&self) -> &Scan {
        &self.scan
    }

    /// Whether the last character was part of a block.
    pub(crate) const fn took_for_block(&self) -> bool {
        self.in_block
    }

    pub(crate) fn take(&mut self, heard: Character) {
        self.marks = Marks::default();
        self.in_block = false;
        self.check_wait(heard.at);
        if let Some(error) = heard.error {
            let Character { side, byte, .. } = heard;
            self.see(Observation::Damaged { side, byte, error });
        }
        match self.phase {
            Phase::Idle => self.in_idle(heard),
            Phase::Requested { by } if heard.side == by => self.after_own_request(heard),
            Phase::Requested { .. } => self.answer_to_request(heard),
            Phase::Conflict => self.in_conflict(heard),
            Phase::Block { by, in_conflict } if heard.side == by => {
                self.block_character(heard, in_conflict);
            }
            Phase::Block { in_conflict, .. } => self.interruption(heard, in_conflict),
            Phase::AwaitAck { by } if heard.side == by => self.after_own_block(heard),
            Phase::AwaitAck { .. } => self.answer_to_block(heard),
            Phase::AnsweredEarly { by, bcc } => self.after_early_answer(heard, by, bcc),
        }
    }

    fn see(&mut self, observation: Observation<'static>) {
        self.marks.push(Mark::Other(observation));
    }

    fn no_answer(&mut self, silent: Side, waited: Duration) {
        self.see(Observation::NoAnswer { silent, waited });
    }

    /// The waiting side goes on. Its own limit may be shorter than the one known here; a burst of
    /// STX waits for nothing.
    fn gave_up_waiting(&mut self, heard: Character) {
        let waited = self.since_last(heard.at);
        if !self.overdue && waited > CROSSING {
            self.no_answer(heard.side.other(), waited);
        }
    }

    fn stray(&mut self, heard: Character) {
        let Character { side, byte, .. } = heard;
        self.see(Observation::Stray { side, byte });
    }

    fn enter(&mut self, now: Duration, phase: Phase) {
        self.phase = phase;
        self.last = now;
        self.overdue = false;
    }

    /// Time since the last step.
    fn since_last(&self, now: Duration) -> Duration {
        since(self.last, now)
    }

    /// Nothing under way, or the sender speaks again in place of the answer to its block.
    fn in_idle(&mut self, heard: Character) {
        match heard.intact() {
            Some(STX) => self.request(heard.at, heard.side),
            Some(NAK) => self.reset(heard),
            _ => self.stray(heard),
        }
    }

    /// NAK of a side that gives up or begins.
    fn reset(&mut self, heard: Character) {
        let side = heard.side;
        self.see(Observation::Reset { side });
        self.waiting[side] = None;
        self.owing = PerSide::both(None);
        self.attempts[side] = 0;
        match self.waiting[side.other()] {
            Some(since) => self.enter(since, Phase::Requested { by: side.other() }),
            None => self.enter(heard.at, Phase::Idle),
        }
    }

    fn request(&mut self, now: Duration, side: Side) {
        self.attempts[side] = self.attempts[side].saturating_add(1);
        let attempt = self.attempts[side];
        self.see(Observation::Request { side, attempt });
        self.waiting[side] = Some(now);
        self.asked[side] = Some(now);
        // A side that gave up without a NAK waits no more.
        let patience = self.qvz.saturating_mul(2);
        let other = self.waiting[side.other()].map(|other| since(other, now));
        if other.is_none_or(|delay| delay > patience) {
            self.waiting[side.other()] = None;
            self.owing[side.other()] = Some(now);
            self.enter(now, Phase::Requested { by: side });
            return;
        }
        let owing = self.owing[side].take().map(|asked| since(asked, now));
        self.see(match owing {
            Some(delay) if delay > CROSSING => Observation::RequestUnanswered { side, delay },
            _ => Observation::Conflict,
        });
        self.enter(now, Phase::Conflict);
    }

    /// The side that sent STX speaks on.
    fn after_own_request(&mut self, heard: Character) {
        let by = heard.side;
        let crossing = self.asked[by.other()].map(|asked| since(asked, heard.at));
        match (heard.intact(), crossing.filter(|&delay| delay <= CROSSING)) {
            (Some(STX | NAK), _) => {}
            // The other's STX came while this side gave up its job and began the next.
            (Some(DLE), Some(delay)) => {
                self.see(Observation::Connected { by, delay });
                self.begin_block(heard.at, by.other(), true);
                return;
            }
            _ => {
                // It did not wait for the answer.
                self.see(Observation::DidNotWait { side: by });
                self.begin_block(heard.at, by, false);
                self.block_character(heard, false);
                return;
            }
        }
        self.gave_up_waiting(heard);
        self.in_idle(heard);
    }

    fn answer_to_request(&mut self, heard: Character) {
        let (by, delay) = (heard.side, self.since_last(heard.at));
        match heard.intact() {
            Some(DLE) => {
                self.see(Observation::Connected { by, delay });
                self.begin_block(heard.at, by.other(), false);
            }
            Some(NAK) => {
                self.see(Observation::Refused { by, delay });
                self.waiting[by.other()] = None;
                self.owing[by] = None;
                self.enter(heard.at, Phase::Idle);
            }
            Some(STX) => self.request(heard.at, by),
            _ => self.stray(heard),
        }
    }

    /// Both sent STX: who answers DLE has given way.
    fn in_conflict(&mut self, heard: Character) {
        let by = heard.side;
        match heard.intact() {
            Some(DLE) => {
                let asked = self.waiting[by.other()];
                let delay = asked.map_or(Duration::ZERO, |asked| since(asked, heard.at));
                self.see(Observation::Connected { by, delay });
                self.begin_block(heard.at, by.other(), true);
            }
            _ => self.in_idle(heard),
        }
    }

    fn begin_block(&mut self, now: Duration, by: Side, in_conflict: bool) {
        self.scan = Scan::new(self.check);
        // Until its block comes, the sender may not have heard the answer, and wait on.
        self.waiting[by.other()] = None;
        self.owing = PerSide::both(None);
        self.attempts = PerSide::both(0);
        self.enter(now, Phase::Block { by, in_conflict });
    }

    /// A character of the block; after a pause, STX and NAK leave it.
    fn block_character(&mut self, heard: Character, in_conflict: bool) {
        let by = heard.side;
        if self.overdue && matches!(heard.intact(), Some(STX | NAK)) {
            let gave_way = in_conflict && self.scan.is_lone_dle();
            if !(gave_way || self.scan.is_empty()) {
                self.see(Observation::BrokenOff { by });
            }
            self.in_idle(heard);
            return;
        }
        if self.overdue && self.scan.is_empty() {
            let gap = self.since_last(heard.at);
            self.see(Observation::Gap { by, gap });
        }
        self.in_block = true;
        self.waiting[by] = None;
        let end = self.scan.push(heard.byte);
        self.enter(heard.at, self.phase);
        match end {
            None => return,
            Some(Ok(())) => {
                let len = self.scan.len();
                self.marks.push(Mark::Block { by, len });
            }
            Some(Err(error)) => self.see(Observation::BadBlock { by, error }),
        }
        self.enter(heard.at, Phase::AwaitAck { by });
    }

    /// The receiver speaks while the block goes on.
    fn interruption(&mut self, heard: Character, in_conflict: bool) {
        let by = heard.side.other();
        match heard.intact() {
            Some(DLE | NAK) if self.scan.awaits_bcc() => {
                let bcc = self.scan.expected_bcc();
                self.acknowledge(heard);
                self.enter(heard.at, Phase::AnsweredEarly { by, bcc });
            }
            Some(NAK) => {
                if self.scan.is_empty() || in_conflict && self.scan.is_lone_dle() {
                    if !self.overdue {
                        self.pause(by, in_conflict, self.since_last(heard.at));
                    }
                    self.reset(heard);
                } else {
                    self.see(Observation::Aborted { by: heard.side });
                    self.enter(heard.at, Phase::Idle);
                }
            }
            Some(STX) if self.overdue => self.request(heard.at, heard.side),
            _ => self.stray(heard),
        }
    }

    /// DLE or NAK to a block.
    fn acknowledge(&mut self, heard: Character) {
        let (by, delay) = (heard.side, self.since_last(heard.at));
        self.see(if heard.byte == DLE {
            Observation::Accepted { by, delay }
        } else {
            Observation::Rejected { by, delay }
        });
        self.enter(heard.at, Phase::Idle);
    }

    /// The character after an answer that came too early: the BCC, if there is one.
    fn after_early_answer(&mut self, heard: Character, by: Side, bcc: u8) {
        self.enter(heard.at, Phase::Idle);
        let control = matches!(heard.byte, STX | DLE | NAK);
        if heard.side == by && (heard.byte == bcc || !control) {
            self.scan.push(heard.byte);
            self.see(Observation::BccNotAwaited { by: by.other() });
        } else {
            self.see(Observation::NoBcc { by });
            self.in_idle(heard);
        }
    }

    /// The sender speaks in place of the answer to its block.
    fn after_own_block(&mut self, heard: Character) {
        if matches!(heard.intact(), Some(STX | NAK)) {
            self.gave_up_waiting(heard);
        }
        self.in_idle(heard);
    }

    fn answer_to_block(&mut self, heard: Character) {
        match heard.intact() {
            Some(DLE | NAK) => self.acknowledge(heard),
            Some(STX) => {
                let (by, delay) = (heard.side, self.since_last(heard.at));
                self.see(Observation::RequestForAnswer { by, delay });
                self.request(heard.at, by);
            }
            _ => self.stray(heard),
        }
    }
}
