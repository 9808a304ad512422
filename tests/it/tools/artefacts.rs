//! Examples that leave artefacts: all of them, or none.

use std::fs;
use std::path::Path;
use std::process::Output;

use tempfile::TempDir;

use crate::tools::example::example;

/// Runs an example that leaves its artefacts in `out`.
pub(crate) fn run_into(out: &Path, name: &str, arguments: &[&str]) -> Output {
    example(name)
        .args(arguments)
        .arg("--out")
        .arg(out)
        .output()
        .unwrap()
}

/// Exit code 1, on standard error one line with `wanted` in it, and no artefact.
pub(crate) fn assert_refused(name: &str, arguments: &[&str], wanted: &str) {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let output = run_into(&out, name, arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{wanted}: {errors}");
    assert!(errors.contains(wanted), "{wanted}: {errors}");
    assert_eq!(errors.lines().count(), 1, "{errors}");
    let left = fs::read_dir(&out).map_or(0, Iterator::count);
    assert_eq!(left, 0, "{errors}");
}

/// A folder in the place of any artefact is refused, and none is written.
pub(crate) fn assert_all_or_none(name: &str, arguments: &[&str], artefacts: &[&str]) {
    for artefact in artefacts {
        let out = TempDir::new().unwrap();
        fs::create_dir(out.path().join(artefact)).unwrap();
        let output = run_into(out.path(), name, arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{errors}");
        let end = format!("{artefact}: is a folder\n");
        assert!(errors.ends_with(&end), "{errors}");
        assert_eq!(fs::read_dir(out.path()).unwrap().count(), 1, "{artefact}");
    }
}
