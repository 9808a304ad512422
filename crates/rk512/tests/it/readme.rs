//! The README shows the examples as they are.

#[test]
fn the_programs_in_the_readme_are_the_examples() {
    for example in [
        include_str!("../../examples/data_block.rs"),
        include_str!("../../examples/plc_over_tcp.rs"),
    ] {
        let (_, program) = example.split_once("\n\n").unwrap();
        let shown = include_str!("../../README.md").contains(&format!("\n{program}```\n"));
        assert!(shown, "not in the README:\n{program}");
    }
}
