//! The built examples.

use std::process::Command;

/// An example, which lies beside the folder of this test.
pub(crate) fn example(name: &str) -> Command {
    let test = std::env::current_exe().unwrap();
    let example = test.ancestors().nth(2).unwrap().join("examples").join(name);
    assert!(
        example.exists(),
        "{} is missing: `cargo test` without a filter builds it",
        example.display()
    );
    Command::new(example)
}
