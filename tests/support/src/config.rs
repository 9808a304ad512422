//! How many cases a property is tried with.

use proptest::prelude::ProptestConfig;

/// At least so many cases; `PROPTEST_CASES` asks for more. Most of what is drawn may be rejected.
#[must_use]
pub fn at_least(cases: u32) -> ProptestConfig {
    let given = ProptestConfig::default();
    let cases = given.cases.max(cases);
    ProptestConfig {
        cases,
        max_global_rejects: cases.saturating_mul(64),
        ..given
    }
}
