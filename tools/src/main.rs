//! Programs that bring up a 3964 or 3964R line.

use std::process::ExitCode;

fn main() -> ExitCode {
    line3964r::cli::main()
}
