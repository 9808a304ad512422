//! A listener on both directions of a line.

mod observation;
#[cfg(test)]
mod tests;
mod verdict;

use core::time::Duration;

use crate::{
    ascii::{DLE, NAK, STX},
    config::Config,
    event::LineError,
    frame::{IllegalDle, Progress, Rules},
};

pub use observation::{Observation, Observations, Side};
pub use verdict::Verdict;

use observation::{Mark, Marks};
use verdict::{Tally, Trouble};

/// What is longer than a limit is so by this much at least.
const RESOLUTION: Duration = Duration::from_micros(1);

/// Listens to both directions of a line and tells what happens there and why it fails.
///
/// `N` is the longest payload that is kept. Feed it each character with its time, or the lines of
/// a capture; it sends nothing. Times and check come from a [`Config`]; the other settings do not
/// matter.
///
/// # Examples
/// ```
/// use core::time::Duration;
/// use proto3964r::{Config, Line, Monitor, Priority, Side, Verdict};
///
/// let mut monitor = Monitor::<64>::new(Config::siemens_3964r(Priority::Low, Line::Instant));
/// for (ms, side, byte) in [(0, Side::A, 0x02), (3, Side::B, 0x15), (6, Side::A, 0x02), (9, Side::B, 0x15)] {
///     for observation in monitor.handle_byte(Duration::from_millis(ms), side, byte) {
///         println!("{ms} {observation}");
///     }
/// }
/// assert_eq!(monitor.verdict(), Verdict::NoReceiveBuffer { refuser: Side::B });
/// assert_eq!(monitor.verdict().to_string(), "B answers NAK to STX: no receive buffer");
/// ```
#[derive(Clone, Debug)]
pub struct Monitor<const N: usize> {
    config: Config,
    phase: Phase,
    /// The last character that belonged to the phase.
    last: Duration,
    /// The deadline of this wait was reported.
    overdue: bool,
    /// The connection grew out of an initialization conflict.
    in_conflict: bool,
    /// STX in a row without a connection, per side.
    requests: [u8; 2],
    decoder: Progress,
    line_error: Option<LineError>,
    marks: Marks,
    tally: Tally,
    buffer: [u8; N],
}

/// Where the conversation stands. The side is the one that sends the telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Idle,
    Requested(Side),
    /// Both sent STX, this one first.
    Conflict(Side),
    Block(Side),
    /// The block is over; whether it was good.
    AwaitAck(Side, bool),
}

/// One character on the line.
#[derive(Clone, Copy)]
struct Heard {
    now: Duration,
    side: Side,
    byte: u8,
    error: Option<LineError>,
}

impl Heard {
    /// The character, unless it is damaged: then it answers nothing.
    fn intact(self) -> Option<u8> {
        self.error.is_none().then_some(self.byte)
    }
}

impl<const N: usize> Monitor<N> {
    /// A monitor for a line with these times and this check, before the first character.
    #[must_use]
    pub fn new(config: Config) -> Self {
        const {
            assert!(N <= 65535, "a block holds at most 65535 bytes");
        }
        Self {
            config,
            phase: Phase::Idle,
            last: Duration::ZERO,
            overdue: false,
            in_conflict: false,
            requests: [0; 2],
            decoder: Progress::START,
            line_error: None,
            marks: Marks::default(),
            tally: Tally::default(),
            buffer: [0; N],
        }
    }

    /// Takes a character that `side` sent; returns what it means.
    pub fn handle_byte(&mut self, now: Duration, side: Side, byte: u8) -> Observations<'_> {
        self.take(Heard {
            now,
            side,
            byte,
            error: None,
        })
    }

    /// Takes a character of `side` that came in damaged.
    pub fn handle_damaged(
        &mut self,
        now: Duration,
        side: Side,
        byte: u8,
        error: LineError,
    ) -> Observations<'_> {
        self.take(Heard {
            now,
            side,
            byte,
            error: Some(error),
        })
    }

    /// Reports a wait that has become too long by `now`.
    ///
    /// Needed on a live line only: the next character does the same.
    pub fn handle_timeout(&mut self, now: Duration) -> Observations<'_> {
        self.marks = Marks::default();
        self.check_wait(now);
        Observations::new(self.marks, &self.buffer)
    }

    /// When [`handle_timeout`](Self::handle_timeout) has something to report, unless a character
    /// comes first.
    #[must_use]
    pub fn poll_timeout(&self) -> Option<Duration> {
        let limit = self.limit()?.saturating_add(RESOLUTION);
        (!self.overdue).then(|| self.last.saturating_add(limit))
    }

    /// Why the line does not work, or that it does.
    ///
    /// Counts what went wrong since the last accepted telegram; the most frequent trouble wins.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.tally.verdict()
    }

    /// The longest wait in this phase.
    fn limit(&self) -> Option<Duration> {
        match self.phase {
            Phase::Idle => None,
            Phase::Block(_) => Some(self.config.zvz()),
            Phase::Requested(_) | Phase::Conflict(_) | Phase::AwaitAck(..) => {
                Some(self.config.qvz())
            }
        }
    }

    /// Reports, once per wait, that the limit has passed.
    fn check_wait(&mut self, now: Duration) {
        if self.poll_timeout().is_none_or(|due| due > now) {
            return;
        }
        self.overdue = true;
        let waited = self.since_last(now);
        match self.phase {
            Phase::Idle => {}
            Phase::Block(by) => {
                self.see(Observation::Gap { by, gap: waited });
                if self.in_conflict && self.decoder.is_lone_dle() {
                    self.trouble(Trouble::BothLow, by);
                } else {
                    self.trouble(Trouble::Gap, by);
                }
            }
            Phase::Requested(by) => {
                self.see(Observation::NoAnswer {
                    silent: by.other(),
                    waited,
                });
                self.trouble(Trouble::NoAnswer, by.other());
            }
            Phase::Conflict(_) => {}
            Phase::AwaitAck(by, _) => {
                self.see(Observation::NoAnswer {
                    silent: by.other(),
                    waited,
                });
                self.trouble(Trouble::NoAcknowledgement, by.other());
            }
        }
    }

    fn take(&mut self, heard: Heard) -> Observations<'_> {
        self.marks = Marks::default();
        self.tally.heard();
        self.check_wait(heard.now);
        if let Some(error) = heard.error {
            let Heard { side, byte, .. } = heard;
            self.see(Observation::Damaged { side, byte, error });
            self.trouble(Trouble::Garbage, side);
        }
        match self.phase {
            Phase::Idle => self.in_idle(heard),
            Phase::Requested(by) if heard.side == by => self.after_own_request(heard),
            Phase::Requested(_) => self.answer_to_request(heard),
            Phase::Conflict(_) => self.in_conflict(heard),
            Phase::Block(by) if heard.side == by => self.block_character(heard),
            Phase::Block(by) => self.interruption(heard, by),
            Phase::AwaitAck(by, good) if heard.side != by => self.answer_to_block(heard, good),
            Phase::AwaitAck(..) => self.in_idle(heard),
        }
        Observations::new(self.marks, &self.buffer)
    }

    fn see(&mut self, observation: Observation<'static>) {
        self.marks.push(Mark::Other(observation));
    }

    fn trouble(&mut self, trouble: Trouble, side: Side) {
        self.tally.note(trouble, side);
    }

    fn enter(&mut self, now: Duration, phase: Phase) {
        self.phase = phase;
        self.last = now;
        self.overdue = false;
    }

    /// Nothing under way, or the sender speaks again in place of the answer to its block.
    fn in_idle(&mut self, heard: Heard) {
        let Heard {
            now, side, byte, ..
        } = heard;
        match heard.intact() {
            Some(STX) => self.request(now, side),
            Some(NAK) => {
                self.see(Observation::Reset { side });
                self.enter(now, Phase::Idle);
            }
            _ => self.stray(side, byte),
        }
    }

    fn stray(&mut self, side: Side, byte: u8) {
        self.see(Observation::Stray { side, byte });
        self.trouble(Trouble::Garbage, side);
    }

    /// Time since the last step; `Duration`'s own subtraction has a way to a panic.
    fn since_last(&self, now: Duration) -> Duration {
        let nanos = now.as_nanos().saturating_sub(self.last.as_nanos());
        Duration::from_nanos(u64::try_from(nanos).unwrap_or(u64::MAX))
    }

    fn request(&mut self, now: Duration, side: Side) {
        let attempt = self.count_request(side);
        self.see(Observation::Request { side, attempt });
        self.in_conflict = false;
        self.enter(now, Phase::Requested(side));
    }

    fn count_request(&mut self, side: Side) -> u8 {
        self.requests.get_mut(side.index()).map_or(0, |count| {
            *count = count.saturating_add(1);
            *count
        })
    }

    /// The side that sent STX speaks on.
    fn after_own_request(&mut self, heard: Heard) {
        match heard.intact() {
            Some(STX | NAK) => self.in_idle(heard),
            _ => {
                // It did not wait for the answer.
                self.see(Observation::DidNotWait { side: heard.side });
                self.begin_block(heard.now, heard.side);
                self.block_character(heard);
            }
        }
    }

    fn answer_to_request(&mut self, heard: Heard) {
        let Heard {
            now, side, byte, ..
        } = heard;
        let delay = self.since_last(now);
        match heard.intact() {
            Some(DLE) => {
                self.see(Observation::Connected { by: side, delay });
                self.late(side);
                self.begin_block(now, side.other());
            }
            Some(NAK) => {
                self.see(Observation::Refused { by: side, delay });
                self.trouble(Trouble::Refused, side);
                self.enter(now, Phase::Idle);
            }
            Some(STX) => {
                self.see(Observation::Conflict);
                self.in_conflict = true;
                self.count_request(side);
                if self.requests.iter().all(|&count| count > 1) {
                    self.trouble(Trouble::BothHigh, side);
                }
                self.enter(now, Phase::Conflict(side.other()));
            }
            _ => self.stray(side, byte),
        }
    }

    /// Both sent STX: who answers DLE has given way.
    fn in_conflict(&mut self, heard: Heard) {
        let Heard {
            now, side, byte, ..
        } = heard;
        match heard.intact() {
            Some(DLE) => {
                self.see(Observation::Connected {
                    by: side,
                    delay: self.since_last(now),
                });
                self.begin_block(now, side.other());
            }
            Some(STX | NAK) => self.in_idle(heard),
            _ => self.stray(side, byte),
        }
    }

    fn begin_block(&mut self, now: Duration, by: Side) {
        self.decoder = Progress::START;
        self.line_error = None;
        self.requests = [0; 2];
        self.enter(now, Phase::Block(by));
    }

    fn block_character(&mut self, heard: Heard) {
        self.line_error = self.line_error.or(heard.error);
        let rules = Rules {
            check: self.config.check,
            illegal_dle: IllegalDle::RejectAtEnd,
        };
        let end = self.decoder.push(rules, heard.byte, &mut self.buffer);
        self.enter(heard.now, self.phase);
        let Some(result) = end else { return };
        let by = heard.side;
        let good = result.is_ok() && self.line_error.is_none();
        match result {
            Ok(len) => {
                let len = usize::from(len);
                self.marks.push(Mark::Block { by, len });
            }
            Err(error) => {
                self.see(Observation::BadBlock { by, error });
                self.trouble(Trouble::BadBlock, by);
            }
        }
        self.enter(heard.now, Phase::AwaitAck(by, good));
    }

    /// The receiver speaks while the block goes on.
    fn interruption(&mut self, heard: Heard, by: Side) {
        let Heard {
            now, side, byte, ..
        } = heard;
        let answer = matches!(heard.intact(), Some(DLE | NAK));
        if answer && self.decoder.awaits_bcc() {
            let delay = self.since_last(now);
            self.see(Observation::NoBcc { by });
            self.see(if byte == DLE {
                Observation::Accepted { by: side, delay }
            } else {
                Observation::Rejected { by: side, delay }
            });
            self.trouble(Trouble::NoBcc, by);
            self.enter(now, Phase::Idle);
        } else if heard.intact() == Some(NAK) {
            self.see(Observation::Aborted { by: side });
            self.enter(now, Phase::Idle);
        } else if heard.intact() == Some(STX) && self.overdue {
            self.request(now, side);
        } else {
            self.stray(side, byte);
        }
    }

    fn answer_to_block(&mut self, heard: Heard, good: bool) {
        let Heard {
            now, side, byte, ..
        } = heard;
        let delay = self.since_last(now);
        match heard.intact() {
            Some(DLE) => {
                self.see(Observation::Accepted { by: side, delay });
                self.late(side);
                if good {
                    self.tally.accepted();
                } else {
                    self.trouble(Trouble::BadAccepted, side);
                }
                self.enter(now, Phase::Idle);
            }
            Some(NAK) => {
                self.see(Observation::Rejected { by: side, delay });
                if good {
                    self.trouble(Trouble::GoodRejected, side);
                }
                self.enter(now, Phase::Idle);
            }
            Some(STX) => {
                self.see(Observation::NoAnswer {
                    silent: side,
                    waited: delay,
                });
                self.trouble(Trouble::NoAcknowledgement, side);
                self.request(now, side);
            }
            _ => self.stray(side, byte),
        }
    }

    /// An answer that came after its time counts as trouble of its own.
    fn late(&mut self, side: Side) {
        if self.overdue {
            self.trouble(Trouble::Late, side);
        }
    }
}
