//! Two faults at once: the second one, where the first does not explain it.

use super::{Case, Rule};
use crate::{diagnosis::verdict::Verdict, monitor::Side};

impl<'c> Case<'c> {
    /// Rules whose evidence is in what one side itself sends or answers.
    const OWN: [Rule<'c>; 7] = [
        Self::not_doubled,
        Self::without_bcc,
        Self::late,
        Self::other_bcc,
        Self::no_receive_buffer,
        Self::good_blocks_rejected,
        Self::gaps,
    ];

    /// A second fault besides this one.
    pub(in crate::diagnosis) fn also(&self, first: Verdict) -> Option<Verdict> {
        let at = place(first)?;
        let mut found = Self::OWN.into_iter().flat_map(|rule| {
            Side::BOTH
                .into_iter()
                .filter_map(move |side| rule(self, side))
        });
        found.find(|&second| place(second).is_some_and(|place| is_another(at, place)))
    }
}

/// What kind of fault it is, and at which side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    NotDoubled,
    WithoutBcc,
    Late,
    OtherBcc,
    NoReceiveBuffer,
    Rejects,
    Gaps,
}

const fn place(verdict: Verdict) -> Option<(Kind, Side)> {
    Some(match verdict {
        Verdict::NotDoubled { sender, .. } => (Kind::NotDoubled, sender),
        Verdict::WithoutBcc { side } => (Kind::WithoutBcc, side),
        Verdict::Late { side, .. } => (Kind::Late, side),
        Verdict::OtherBcc { sender, .. } => (Kind::OtherBcc, sender),
        Verdict::NoReceiveBuffer { refuser } => (Kind::NoReceiveBuffer, refuser),
        Verdict::GoodBlocksRejected { refuser, .. } => (Kind::Rejects, refuser),
        Verdict::Gaps { sender, .. } => (Kind::Gaps, sender),
        _ => return None,
    })
}

/// Whether the second is none that comes of the first.
fn is_another(first: (Kind, Side), second: (Kind, Side)) -> bool {
    if first == second {
        return false;
    }
    match (first.0, second.0) {
        // Late answers meet the next block, and the times of the other side are counted from them.
        (Kind::Late, Kind::Rejects | Kind::Late) => false,
        // Its NAK at the end of a block that it gives up meets the next STX.
        (Kind::Late, Kind::NoReceiveBuffer) => first.1 != second.1,
        // What it does not hear of the answers to its own blocks has it break them off.
        (Kind::Rejects, Kind::Gaps) => first.1 != second.1,
        _ => true,
    }
}
