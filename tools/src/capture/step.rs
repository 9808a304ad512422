//! One step of the conversation, as text.

use core::time::Duration;

use monitor3964r::{Observation, Side};

/// One step of the conversation.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Step {
    /// When it became clear.
    pub at: Duration,
    /// Whose step it is; `None` for what both did.
    pub side: Option<Side>,
    /// How good it is.
    pub kind: Kind,
    /// Whether it is something that was sent; `false` for what did not come, or not in time.
    pub is_sent: bool,
    /// What happened, beginning with the side.
    pub text: String,
}

/// How good a step is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::exhaustive_enums, reason = "from good to bad")]
pub enum Kind {
    /// A good block, an acknowledgement.
    Good,
    /// A step on the way to it.
    Neutral,
    /// Happens on lines that work.
    Unusual,
    /// Should not happen.
    Fault,
}

impl Step {
    pub(super) fn new(at: Duration, observation: &Observation<'_>) -> Self {
        let kind = match observation {
            Observation::Block { .. } | Observation::Accepted { .. } => Kind::Good,
            Observation::Request { .. } | Observation::Connected { .. } => Kind::Neutral,
            Observation::Conflict | Observation::Reset { .. } => Kind::Unusual,
            _ => Kind::Fault,
        };
        let is_sent = !matches!(
            observation,
            Observation::RequestUnanswered { .. }
                | Observation::BothGaveWay
                | Observation::NoBlock { .. }
                | Observation::BrokenOff { .. }
                | Observation::NoAnswer { .. }
                | Observation::Gap { .. }
        );
        Self {
            at,
            side: observation.side(),
            kind,
            is_sent,
            text: observation.to_string(),
        }
    }
}
