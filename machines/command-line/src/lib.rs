//! What the machines' command lines share: options, input files and terminals, artefacts that
//! appear together, progress, and how a run ends.

mod arguments;
mod artefacts;
mod cable;
mod input;
mod progress;
mod pseudo_terminal;
mod terminal;

pub use arguments::{exit_code, fraction, print_notes, print_summary, run};
pub use artefacts::Artefacts;
pub use cable::{Cable, Port};
pub use input::{read, read_bytes};
pub use progress::Progress;
pub use pseudo_terminal::PseudoTerminal;
pub use terminal::Terminal;
