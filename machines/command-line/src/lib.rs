//! What the machines' command lines share: options, input files and ports, artefacts that appear
//! together, progress, and how a run ends.

mod arguments;
mod artefacts;
mod input;
mod port;
mod progress;

pub use arguments::{arguments, fraction, print_notes, print_summary, run};
pub use artefacts::{Artefacts, write_json};
pub use input::{read, read_bytes};
pub use port::Port;
pub use progress::Progress;
