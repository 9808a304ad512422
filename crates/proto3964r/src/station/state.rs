//! Where the procedure and the job stand.

use core::time::Duration;

use crate::{
    event::{Cause, JobPhase, Rejection},
    frame::{Encoder, Progress},
};

/// Where the procedure stands, with the times at which patience ends.
///
/// ```text
///         STX: DLE           character              end of a good block: DLE
/// Idle ------------> Invited ---------> Receiving ---------------------------> Idle
///  | | STX, no buffer   ^                   | error
///  | +-> AwaitBuffer ---+                   v            end: NAK
///  |        buffer free ^                Spoiled -----------------> AwaitRepeat
///  | noise              +------------------------------------------------ STX
///  |                       Receiving -- good, held --> Held -- accepted: DLE --> Idle
///  |                                                    | refused, too late: NAK
///  |                                                    +----> AwaitRepeat
///  +-----> Noise --- silence: NAK ---> Idle
///
///          STX             DLE            end of the block             DLE
/// Request -----> AwaitDle -----> Sending ------------------> AwaitAck -----> Idle
///  ^ ^ ^  NAK, QVZ  |              | NAK, other                 | NAK, QVZ
///  | | +------------+              v                            |
///  | +-- silence: NAK ------- Interrupted                       |
///  +------------------------------------------------------------+
///
/// any of these -- given up: NAK --> Settling -- silence --> Idle
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum State {
    /// Nothing is under way.
    Idle,
    /// A character that belongs to nothing came; NAK is sent when the line is silent.
    Noise {
        first: u8,
        silent_at: Duration,
        noise_end_at: Duration,
    },
    /// STX came, the receive buffer is in use.
    AwaitBuffer { refuse_at: Duration },
    /// DLE is queued or sent, no character of the block has come.
    Invited { gap_at: Duration },
    /// The block comes in, and nothing is wrong with it.
    Receiving { block: Progress, gap_at: Duration },
    /// The block is known to be bad; NAK follows at its end.
    Spoiled {
        block: Progress,
        rejection: Rejection,
        gap_at: Duration,
        noise_end_at: Duration,
    },
    /// The block came in and is good; the user has yet to accept or refuse it.
    Held { refuse_at: Duration },
    /// NAK is queued or sent, the STX of the repeat is awaited.
    AwaitRepeat {
        give_up_at: Duration,
        /// What came since is no repeat.
        goes_on: bool,
    },
    /// STX is next on the line.
    Request { stalled_at: Duration, burst: Burst },
    /// STX is sent, DLE is awaited.
    AwaitDle {
        answer_at: Duration,
        burst: Burst,
        /// The partner sent STX too.
        in_conflict: bool,
    },
    /// The block goes out. It has stalled QVZ after its begin and after the end of the output so
    /// far.
    Sending { block: Encoder, begun_at: Duration },
    /// The block was interrupted; it is repeated when the line is silent.
    Interrupted {
        silent_at: Duration,
        noise_end_at: Duration,
    },
    /// The job was given up while it had the line; what the partner still answers belongs to no
    /// other.
    Settling {
        silent_at: Duration,
        noise_end_at: Duration,
    },
    /// The block is out, its answer is awaited.
    AwaitAck { answer_at: Duration },
}

impl State {
    /// The block that comes in, and when a gap in it is too long.
    pub(super) const fn block_mut(&mut self) -> Option<(&mut Progress, &mut Duration)> {
        match self {
            Self::Receiving { block, gap_at } | Self::Spoiled { block, gap_at, .. } => {
                Some((block, gap_at))
            }
            _ => None,
        }
    }

    /// The phase of the job that is under way; `None` when the line is not the job's.
    pub(super) const fn phase(&self) -> Option<JobPhase> {
        match self {
            Self::Request { .. } | Self::AwaitDle { .. } => Some(JobPhase::Connection),
            Self::Sending { .. } | Self::Interrupted { .. } | Self::AwaitAck { .. } => {
                Some(JobPhase::Transmission)
            }
            Self::Idle
            | Self::Noise { .. }
            | Self::AwaitBuffer { .. }
            | Self::Invited { .. }
            | Self::Receiving { .. }
            | Self::Spoiled { .. }
            | Self::Held { .. }
            | Self::AwaitRepeat { .. }
            | Self::Settling { .. } => None,
        }
    }
}

/// Characters that belong to the wrong answer of the attempt before: any until `until`, NAK alone
/// if that answer was NAK.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Burst {
    pub(super) until: Duration,
    pub(super) of_nak: bool,
}

impl Burst {
    pub(super) const NONE: Self = Self {
        until: Duration::ZERO,
        of_nak: true,
    };

    pub(super) fn has(self, now: Duration, is_nak: bool) -> bool {
        now < self.until && (is_nak || !self.of_nak)
    }

    /// Goes on with one more character, or begins with it.
    pub(super) fn extend(&mut self, now: Duration, until: Duration, is_nak: bool) {
        let begins = now >= self.until;
        *self = Self {
            until,
            of_nak: is_nak && (self.of_nak || begins),
        };
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum JobState {
    None,
    /// Waiting or under way.
    Open,
    /// Waiting or under way, after it gave way to the partner, of which no telegram has come yet.
    Yielded,
    /// The outcome has not been polled.
    Ended,
}

/// The job: from its submission until its outcome has been polled.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Job {
    pub(super) state: JobState,
    /// STX in this transmission attempt.
    pub(super) connection_attempts: u8,
    pub(super) transmission_attempts: u8,
    pub(super) first_cause: Option<Cause>,
}

impl Job {
    pub(super) const NONE: Self = Self {
        state: JobState::None,
        connection_attempts: 0,
        transmission_attempts: 0,
        first_cause: None,
    };

    pub(super) fn is_open(&self) -> bool {
        matches!(self.state, JobState::Open | JobState::Yielded)
    }
}
