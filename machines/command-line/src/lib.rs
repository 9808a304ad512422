//! What the machines' command lines share: options, input files, artefacts that appear together,
//! progress, and how a run ends.

mod arguments;
mod artefacts;
mod input;
mod progress;

pub use arguments::{arguments, print_notes, print_summary, run};
pub use artefacts::{Artefacts, write_json};
pub use input::{read, read_bytes};
pub use progress::Progress;
