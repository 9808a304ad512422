//! The README shows the example as it is.

#[test]
fn the_program_in_the_readme_is_the_example() {
    let example = include_str!("../../examples/display_block.rs");
    let (_, program) = example.split_once("\n\n").unwrap();
    assert!(include_str!("../../README.md").contains(&format!("\n{program}```\n")));
}
