//! What stands in a timer's register for an interval.

use super::{Timer, TimerError};

/// What the register of a timer holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Register {
    /// The count from which the counter runs up to its overflow.
    Overflow,
    /// The last count before the counter starts again at 0.
    Compare,
    /// The count from which the counter runs down to 0.
    Down,
}

impl Register {
    /// Ticks of the shortest interval that no counter takes for a stop.
    pub(super) const fn min_ticks(self) -> u64 {
        match self {
            Self::Overflow => 1,
            Self::Compare | Self::Down => 2,
        }
    }
}

impl Timer {
    /// The register value of an interval, for a handler that writes it, or hardware that reloads
    /// itself.
    ///
    /// Where the interrupt writes the counter of a timer that runs on, the ticks since the overflow
    /// are lost and every interval is longer by that latency: the plain reload of
    /// [Engraver 2000]. Trains of n1 and n2 pulses then end 2 · latency · (n1 - n2) ticks apart,
    /// for a small C handler 16 ticks each time. [`compensated_reload`](Self::compensated_reload)
    /// keeps them together.
    ///
    /// # Errors
    /// [`TimerError::IntervalTooShort`], [`TimerError::IntervalTooLong`]; longer ones are cut by
    /// [`periods`](Self::periods).
    pub fn reload(&self, ticks: u64) -> Result<u32, TimerError> {
        self.check(ticks)?;
        Ok(self.value_of(ticks))
    }

    /// The interval of a register value, in ticks.
    ///
    /// # Errors
    /// [`TimerError::ReloadTooLarge`] when the value does not fit the counter;
    /// [`TimerError::IntervalTooShort`].
    pub fn ticks_of_reload(&self, reload: u32) -> Result<u64, TimerError> {
        let limit = self.width.max_value();
        let value = u64::from(reload);
        if value > limit {
            return Err(TimerError::ReloadTooLarge { reload, limit });
        }
        let ticks = match self.register {
            Register::Overflow => self.max_ticks().wrapping_sub(value),
            Register::Compare | Register::Down => value.wrapping_add(1),
        };
        self.check(ticks)?;
        Ok(ticks)
    }

    /// What to write into a counter that ran on after the end of its interval, so that the latency
    /// of the interrupt is not lost: stop, add, start.
    ///
    /// ```text
    /// up to overflow   count' = (count - T + stopped) mod 2^w
    /// down to zero     count' = (count + T - stopped) mod 2^w
    /// ```
    /// `count` is read from the stopped counter, which wrapped and went on counting, a down-counter
    /// from its largest count; `stopped_ticks` are the ticks from stop to start, a constant of the
    /// program. The mean interval is then exactly T, where [`reload`](Self::reload) gives T plus
    /// the latency.
    ///
    /// # Errors
    /// The errors of [`reload`](Self::reload); [`TimerError::CountTooLarge`];
    /// [`TimerError::TooLate`] when the interval is over already; [`TimerError::StartsAgain`] for a
    /// counter that does so at its compare register: no latency is lost there.
    pub fn compensated_reload(
        &self,
        count: u32,
        ticks: u64,
        stopped_ticks: u32,
    ) -> Result<u32, TimerError> {
        self.check(ticks)?;
        let limit = self.width.max_value();
        let value = u64::from(count);
        if value > limit {
            return Err(TimerError::CountTooLarge { count, limit });
        }
        let since_wrap = match self.register {
            Register::Overflow => value,
            Register::Down => limit.wrapping_sub(value),
            Register::Compare => return Err(TimerError::StartsAgain),
        };
        let elapsed = since_wrap.saturating_add(u64::from(stopped_ticks));
        match ticks.checked_sub(elapsed) {
            None | Some(0) => Err(TimerError::TooLate { elapsed, ticks }),
            Some(left) => Ok(self.value_of(left)),
        }
    }

    /// The register value from which the given number of ticks is left.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the register has the low bits"
    )]
    const fn value_of(&self, ticks: u64) -> u32 {
        let value = match self.register {
            Register::Overflow => ticks.wrapping_neg(),
            Register::Compare | Register::Down => ticks.wrapping_sub(1),
        };
        (value & self.width.max_value()) as u32
    }

    pub(super) const fn too_short(&self, ticks: u64) -> TimerError {
        TimerError::IntervalTooShort {
            ticks,
            limit: self.min_ticks,
        }
    }

    pub(super) fn check(&self, ticks: u64) -> Result<(), TimerError> {
        if ticks < self.min_ticks {
            return Err(self.too_short(ticks));
        }
        let limit = self.max_ticks();
        if ticks > limit {
            return Err(TimerError::IntervalTooLong { ticks, limit });
        }
        Ok(())
    }
}
