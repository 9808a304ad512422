//! The README shows the examples as they are.

const README: &str = include_str!("../../README.md");

#[test]
fn the_programs_in_the_readme_are_the_examples() {
    for example in [
        include_str!("../../examples/one_telegram.rs"),
        include_str!("../../examples/two_links.rs"),
    ] {
        let (_, program) = example.split_once("\n\n").unwrap();
        let shown = README.contains(&format!("\n{program}```\n"));
        assert!(shown, "not in the README:\n{program}");
    }
}
