//! Parameter sets of known partners.

use super::{Config, Conflict, IdleNoise, Line, Priority, SilenceInBlock};
use crate::frame::{Check, IllegalDle};

impl Config {
    /// Siemens 3964R: QVZ 2000 ms, ZVZ 220 ms, BWZ 4 s, 6 and 6 attempts.
    ///
    /// Source: Siemens CP 341 and CP 440 manuals, S7-300/400 point-to-point help.
    #[must_use]
    pub const fn siemens_3964r(priority: Priority, line: Line) -> Self {
        Self {
            qvz_ms: 2000,
            zvz_ms: 220,
            bwz_ms: 4000,
            buffer_wait_ms: 400,
            acknowledge_wait_ms: 0,
            line,
            max_noise_s: 10,
            connection_attempts: 6,
            transmission_attempts: 6,
            priority,
            check: Check::Bcc,
            conflict: Conflict::Wait,
            idle_noise: IdleNoise::NakAfterSilence,
            illegal_dle: IllegalDle::RejectAtEnd,
            silence_in_block: SilenceInBlock::Idle,
            allow_empty: true,
            nak_at_startup: true,
        }
    }

    /// Siemens 3964 without BCC: QVZ 550 ms, the rest as [`siemens_3964r`](Self::siemens_3964r).
    #[must_use]
    pub const fn siemens_3964(priority: Priority, line: Line) -> Self {
        Self {
            check: Check::None,
            qvz_ms: 550,
            ..Self::siemens_3964r(priority, line)
        }
    }

    /// EUCHNER hand-held pendant HBLS: QVZ and ZVZ 128 ms, 3 and 3 attempts.
    ///
    /// The pendant is silent until its status is polled, so nothing is sent at start-up. Its
    /// priority is not in the manual; the control is taken as the high side.
    /// Source: EUCHNER manual 067018.
    #[must_use]
    pub const fn euchner_hbls(line: Line) -> Self {
        Self {
            qvz_ms: 128,
            zvz_ms: 128,
            connection_attempts: 3,
            transmission_attempts: 3,
            nak_at_startup: false,
            ..Self::siemens_3964r(Priority::High, line)
        }
    }

    /// EUCHNER hand-held pendant HBAS: QVZ 500 ms, ZVZ 128 ms, 3 and 3 attempts.
    ///
    /// Which side has the high priority is set in the pendant's menu; the control is taken as it.
    /// Source: EUCHNER HBAS manuals.
    #[must_use]
    pub const fn euchner_hbas(line: Line) -> Self {
        Self {
            qvz_ms: 500,
            ..Self::euchner_hbls(line)
        }
    }

    /// The former Linux line discipline `n_r3964`: QVZ 550 ms with and without BCC, noise in idle
    /// is dropped, DLE before anything else is dropped, and the high side gives way on a retry.
    ///
    /// Two of its habits are left out: there a DLE does not restart ZVZ, and connection and
    /// transmission attempts share one counter of six.
    #[must_use]
    pub const fn linux(priority: Priority, line: Line) -> Self {
        Self {
            qvz_ms: 550,
            conflict: Conflict::YieldOnRetry,
            idle_noise: IdleNoise::Ignore,
            illegal_dle: IllegalDle::Accept,
            silence_in_block: SilenceInBlock::ExpectRepeat,
            nak_at_startup: false,
            ..Self::siemens_3964r(priority, line)
        }
    }

    /// Buderus KM271 heating interface: Siemens times, 6 and 6 attempts; the client side repeats
    /// STX in an initialization conflict and drops noise.
    ///
    /// Source: the published KM271 clients.
    #[must_use]
    pub const fn km271(line: Line) -> Self {
        Self {
            conflict: Conflict::Repeat,
            idle_noise: IdleNoise::Ignore,
            nak_at_startup: false,
            ..Self::siemens_3964r(Priority::High, line)
        }
    }
}
