//! Two faults at once: the second one, where the first does not explain it.

use super::{
    Case, Rule,
    symptoms::{explains, shown_by},
};
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
        Self::mostly_gaps,
    ];

    /// A second fault besides this one, which does not explain it.
    pub(in crate::diagnosis) fn also(&self, first: Verdict) -> Option<Verdict> {
        shown_by(first)?;
        let mut found = Self::OWN.into_iter().flat_map(|rule| {
            Side::BOTH
                .into_iter()
                .filter_map(move |side| rule(self, side))
        });
        found.find(|&second| {
            shown_by(second).is_some_and(|(symptom, side)| !explains(first, symptom, side))
        })
    }
}
