//! The README shows the example as it is.

#[test]
fn the_program_in_the_readme_is_the_example() {
    let readme = include_str!("../../README.md");
    let (_, program) = include_str!("../../examples/why.rs")
        .split_once("\n\n")
        .unwrap();
    assert!(readme.contains(&format!("\n{program}```\n")), "{program}");
}
