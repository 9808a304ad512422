//! What is stored comes back.

use monitor3964r::Verdict;
use test_support::stored;

#[test]
fn verdicts() {
    stored(&Verdict::Works);
}
