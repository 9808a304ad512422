//! What goes wrong on a line, counted by its cause.

use core::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use proto3964r::{Cause, CharacterError, Event, JobPhase, Rejection, frame::FrameError};
use serde::Serialize;

use super::time::now;

/// Names of what is counted.
const FAULTS: [&str; 21] = [
    "bcc",
    "illegal_dle",
    "too_long",
    "parity",
    "framing",
    "overrun",
    "collision",
    "zvz",
    "noise",
    "no_buffer",
    "not_accepted",
    "endless",
    "abandoned",
    "conflict",
    "same_priority",
    "break",
    "send_qvz",
    "send_nak",
    "send_block_nak",
    "send_too_soon",
    "send_other",
];

/// The counts of a line, and what was last.
#[derive(Default)]
pub(crate) struct Faults {
    counts: [AtomicU64; FAULTS.len()],
    last: Mutex<Option<LastFault>>,
}

#[derive(Clone, Serialize)]
pub(super) struct LastFault {
    fault: &'static str,
    text: String,
    time: String,
}

impl Faults {
    /// Takes an event of the station; what went well is counted elsewhere.
    pub(crate) fn take(&self, event: Event<'_>) {
        let Some(fault) = fault(event) else {
            return;
        };
        let counted = FAULTS.iter().zip(&self.counts);
        for (_, count) in counted.filter(|(name, _)| **name == fault) {
            count.fetch_add(1, Ordering::Relaxed);
        }
        let last = LastFault {
            fault,
            text: event.to_string(),
            time: now(),
        };
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some(last);
    }

    /// What was last.
    pub(super) fn last(&self) -> Option<LastFault> {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        last.clone()
    }

    /// All of them together.
    pub(super) fn total(&self) -> u64 {
        self.counts().map(|(_, count)| count).sum()
    }

    /// By name, all of them.
    pub(crate) fn counts(&self) -> impl Iterator<Item = (&'static str, u64)> {
        let counts = self
            .counts
            .iter()
            .map(|count| count.load(Ordering::Relaxed));
        FAULTS.into_iter().zip(counts)
    }
}

/// The name of what an event says; `None` where nothing went wrong.
fn fault(event: Event<'_>) -> Option<&'static str> {
    Some(match event {
        Event::Received(_) | Event::Sent { .. } => return None,
        Event::Failed(failure) => match (failure.cause, failure.phase) {
            (Cause::Timeout, _) => "send_qvz",
            (Cause::Nak, JobPhase::Connection) => "send_nak",
            (Cause::Nak, JobPhase::Transmission) => "send_block_nak",
            (Cause::TooSoon, _) => "send_too_soon",
            _ => "send_other",
        },
        Event::Rejected(rejection) => match rejection {
            Rejection::Frame(FrameError::Bcc { .. }) => "bcc",
            Rejection::Frame(FrameError::TooLong { .. }) => "too_long",
            Rejection::Frame(_) => "illegal_dle",
            Rejection::Line(CharacterError::Parity) => "parity",
            Rejection::Line(CharacterError::Overrun) => "overrun",
            Rejection::Line(CharacterError::Collision) => "collision",
            Rejection::Line(_) => "framing",
            Rejection::CharacterDelay => "zvz",
            Rejection::Noise { .. } => "noise",
            Rejection::NoBuffer => "no_buffer",
            Rejection::Endless => "endless",
            // Refused, or undecided for too long.
            _ => "not_accepted",
        },
        Event::Conflict { .. } => "conflict",
        Event::SamePriority => "same_priority",
        Event::Break => "break",
        // Of the events that there are, those that tell of a repeat that did not come.
        _ => "abandoned",
    })
}

#[cfg(test)]
mod tests {
    use core::time::Duration;

    use proto3964r::{Config, Line, Priority, Station};

    use super::*;

    const STX: u8 = 0x02;

    /// What the events of a station are counted as.
    fn counted(characters: &[u8], then: Duration) -> Vec<(&'static str, u64)> {
        let mut config = Config::siemens_3964r(Priority::Low, Line::Instant);
        config.nak_at_startup = false;
        let mut station = Station::<8>::new(config);
        let faults = Faults::default();
        for &byte in characters {
            station.handle_byte(Duration::ZERO, byte);
            while station.poll_transmit_byte(Duration::ZERO).is_some() {}
        }
        station.handle_timeout(then);
        while let Some(event) = station.poll_event() {
            faults.take(event);
        }
        faults.counts().filter(|(_, count)| *count > 0).collect()
    }

    #[test]
    fn each_cause_has_its_count() {
        const NOW: Duration = Duration::ZERO;
        let second = Duration::from_secs(1);
        for (characters, then, names) in [
            (&[STX, 0x41, 0x10, 0x03, 0x52][..], NOW, &[][..]),
            (&[STX, 0x41, 0x10, 0x03, 0x53], NOW, &["bcc"]),
            (&[STX, 0x41], second, &["zvz"]),
            (&[0x41], second, &["noise"]),
            (
                &[STX, 0x41, 0x10, 0x03, 0x53, 0x15],
                NOW,
                &["bcc", "abandoned"],
            ),
            (
                &[STX, 0x41, 0x10, 0x41, 0x10, 0x03, 0x42],
                NOW,
                &["illegal_dle"],
            ),
        ] {
            let expected: Vec<_> = names.iter().map(|name| (*name, 1)).collect();
            assert_eq!(counted(characters, then), expected, "{characters:02X?}");
        }
    }

    #[test]
    fn every_fault_has_a_name_of_its_own() {
        let mut names = FAULTS.to_vec();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), FAULTS.len());
    }
}
