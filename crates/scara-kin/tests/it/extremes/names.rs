//! No public function is forgotten here.

use std::path::Path;

const TESTS: [&str; 11] = [
    include_str!("curves.rs"),
    include_str!("dynamics.rs"),
    include_str!("inverse.rs"),
    include_str!("machine.rs"),
    include_str!("paths.rs"),
    include_str!("rates.rs"),
    include_str!("tools.rs"),
    include_str!("../calibration.rs"),
    include_str!("../each.rs"),
    include_str!("../paths/corners.rs"),
    include_str!("../paths/single.rs"),
];

fn sources(folder: &Path, texts: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, texts);
        } else {
            texts.push(std::fs::read_to_string(path).unwrap());
        }
    }
}

#[test]
fn every_public_function_is_called() {
    let mut texts = Vec::new();
    sources(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("src"),
        &mut texts,
    );
    let names: Vec<&str> = texts
        .iter()
        .flat_map(|text| text.lines())
        .filter_map(|line| {
            let line = line.trim_start().strip_prefix("pub ")?;
            let signature = line
                .strip_prefix("const ")
                .unwrap_or(line)
                .strip_prefix("fn ")?;
            signature.split(['(', '<']).next()
        })
        .collect();
    assert!(names.len() > 40, "{names:?}");
    for name in names {
        let called = [format!(".{name}("), format!("::{name}(")];
        let is_called = |test: &&str| called.iter().any(|call| test.contains(call));
        assert!(TESTS.iter().any(is_called), "{name}");
    }
}
