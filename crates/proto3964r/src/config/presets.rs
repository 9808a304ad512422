//! Parameter sets of known partners.

use super::{Collision, Config, IdleNoise, Priority, SilenceInBlock};
use crate::frame::{Check, IllegalDle};

impl Config {
    /// Siemens 3964R: QVZ 2000 ms, ZVZ 220 ms, BWZ 4 s, 6 and 6 attempts.
    ///
    /// Source: Siemens CP 341 and CP 440 manuals, S7-300/400 point-to-point help.
    #[must_use]
    pub const fn siemens_3964r(priority: Priority) -> Self {
        Self {
            qvz_ms: 2000,
            zvz_ms: 220,
            bwz_ms: 4000,
            buffer_wait_ms: 400,
            character_us: 0,
            babble_s: 10,
            setup_attempts: 6,
            transfer_attempts: 6,
            priority,
            check: Check::Bcc,
            collision: Collision::Wait,
            idle_noise: IdleNoise::NakAfterSilence,
            illegal_dle: IllegalDle::RejectAtEnd,
            silence_in_block: SilenceInBlock::Idle,
            allow_empty: true,
            nak_at_startup: true,
            ignore_early_answers: false,
        }
    }

    /// Siemens 3964 without BCC: QVZ 550 ms, the rest as [`siemens_3964r`](Self::siemens_3964r).
    #[must_use]
    pub const fn siemens_3964(priority: Priority) -> Self {
        Self::siemens_3964r(priority)
            .with_check(Check::None)
            .with_qvz_ms(550)
    }

    /// EUCHNER hand-held unit HBLS: QVZ and ZVZ 128 ms, 3 and 3 attempts.
    ///
    /// The unit is silent until its status is polled, so nothing is sent at start-up. The priority
    /// of the unit is not in the manual; the control is taken as the high side.
    /// Source: EUCHNER manual 067018.
    #[must_use]
    pub const fn euchner_hbls() -> Self {
        Self::siemens_3964r(Priority::High)
            .with_qvz_ms(128)
            .with_zvz_ms(128)
            .with_setup_attempts(3)
            .with_transfer_attempts(3)
            .with_nak_at_startup(false)
    }

    /// EUCHNER hand-held unit HBAS: QVZ 500 ms, ZVZ 128 ms, 3 and 3 attempts.
    ///
    /// Which side has the high priority is set in the unit's menu; the control is taken as it.
    /// Source: EUCHNER HBAS manuals.
    #[must_use]
    pub const fn euchner_hbas() -> Self {
        Self::euchner_hbls().with_qvz_ms(500)
    }

    /// The former Linux line discipline `n_r3964`: QVZ 550 ms with and without BCC, noise in idle
    /// is dropped, DLE in front of anything else is dropped, and the high side gives way on a
    /// retry.
    ///
    /// Two of its habits are left out: there a DLE does not restart ZVZ, and setup and transfer
    /// share one counter of six.
    #[must_use]
    pub const fn linux(priority: Priority) -> Self {
        Self::siemens_3964r(priority)
            .with_qvz_ms(550)
            .with_collision(Collision::YieldOnRetry)
            .with_idle_noise(IdleNoise::Ignore)
            .with_illegal_dle(IllegalDle::Accept)
            .with_silence_in_block(SilenceInBlock::ExpectRepeat)
            .with_nak_at_startup(false)
    }

    /// Buderus KM271 heating interface: Siemens times, 6 and 6 attempts; the client side repeats
    /// STX in a collision and drops noise.
    ///
    /// Source: the published KM271 clients.
    #[must_use]
    pub const fn km271() -> Self {
        Self::siemens_3964r(Priority::High)
            .with_collision(Collision::Repeat)
            .with_idle_noise(IdleNoise::Ignore)
            .with_nak_at_startup(false)
    }
}
