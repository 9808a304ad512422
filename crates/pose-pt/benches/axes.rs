//! Nine axes from a pose.
fn main() {}
