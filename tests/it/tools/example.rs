//! The built examples.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::SystemTime;

/// An example, which lies beside the folder of this test.
pub(crate) fn example(name: &str) -> Command {
    let test = std::env::current_exe().unwrap();
    let example = test.ancestors().nth(2).unwrap().join("examples").join(name);
    assert!(
        is_built(&example),
        "{} is missing or older than its source: `cargo test` without `--test` builds it",
        example.display()
    );
    Command::new(example)
}

/// Whether the example is there, and none of the sources that cargo lists beside it is newer.
fn is_built(example: &Path) -> bool {
    let Some(built) = modified(example) else {
        return false;
    };
    let list = fs::read_to_string(example.with_extension("d")).unwrap_or_default();
    let sources = list.split_whitespace().skip(1);
    // A source that is not found, as one with a space in its name, says nothing.
    sources.filter_map(modified).all(|source| source <= built)
}

fn modified(file: impl AsRef<Path>) -> Option<SystemTime> {
    fs::metadata(file).ok()?.modified().ok()
}
