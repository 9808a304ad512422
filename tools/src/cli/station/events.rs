//! Events of a station as it prints them.

use proto3964r::{Abandoned, Cause, Event, Failure, Rejection, frame::FrameError};
use serde_json::{Value, json};

/// The line of output for an event.
pub(in crate::cli) fn describe(event: Event<'_>) -> String {
    match event {
        Event::Received(telegram) => {
            let space = if telegram.is_empty() { "" } else { " " };
            format!("received{space}{}", hex(telegram))
        }
        Event::Sent { len } => format!("sent {len}"),
        Event::Failed(Failure {
            phase,
            cause,
            attempts,
            ..
        }) => format!("failed {phase} {} {attempts}", cause_word(cause)),
        Event::Rejected(rejection) => format!("error {}", rejection_word(rejection)),
        Event::Abandoned(abandoned) => format!("receive-failed {}", abandoned_word(abandoned)),
        Event::Conflict { in_a_row } => format!("conflict {in_a_row}"),
        Event::SamePriority => "same-priority".to_owned(),
        Event::Break => "break".to_owned(),
        other => format!("{other:?}"),
    }
}

/// The same as an object.
pub(super) fn json(event: Event<'_>) -> Value {
    match event {
        Event::Received(telegram) => json!({ "event": "received", "hex": hex(telegram) }),
        Event::Sent { len } => json!({ "event": "sent", "length": len }),
        Event::Failed(Failure {
            phase,
            cause,
            attempts,
            ..
        }) => json!({
            "event": "failed",
            "phase": phase.to_string(),
            "cause": cause_word(cause),
            "attempts": attempts,
        }),
        Event::Rejected(rejection) => {
            json!({ "event": "error", "cause": rejection_word(rejection) })
        }
        Event::Abandoned(abandoned) => {
            json!({ "event": "receive-failed", "cause": abandoned_word(abandoned) })
        }
        Event::Conflict { in_a_row } => json!({ "event": "conflict", "count": in_a_row }),
        other => json!({ "event": describe(other) }),
    }
}

/// `41 42`.
fn hex(bytes: &[u8]) -> String {
    let words: Vec<_> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    words.join(" ")
}

fn abandoned_word(abandoned: Abandoned) -> String {
    match abandoned {
        Abandoned::NoRepeat => "bwz".to_owned(),
        Abandoned::TooMany(_) => "attempts".to_owned(),
        Abandoned::ByPartner => "nak".to_owned(),
        other => format!("{other:?}"),
    }
}

fn cause_word(cause: Cause) -> String {
    match cause {
        Cause::Unexpected(_) => "char".to_owned(),
        Cause::Line(_) => "line".to_owned(),
        Cause::Conflict => "conflict".to_owned(),
        Cause::TooSoon => "too-soon".to_owned(),
        other => other.to_string(),
    }
}

fn rejection_word(rejection: Rejection) -> String {
    match rejection {
        Rejection::Frame(FrameError::Bcc { .. }) => "bcc".to_owned(),
        Rejection::Frame(FrameError::IllegalDle { .. }) => "dle".to_owned(),
        Rejection::Frame(FrameError::TooLong { .. }) => "overflow".to_owned(),
        Rejection::Line(_) => "line".to_owned(),
        Rejection::CharacterDelay => "zvz".to_owned(),
        Rejection::Endless => "endless".to_owned(),
        Rejection::NoBuffer => "nobuf".to_owned(),
        Rejection::Noise { .. } => "noise".to_owned(),
        other => other.to_string(),
    }
}
