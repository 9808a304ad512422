//! The figures of the book's chapter on how it works, from the crates themselves: the time law of
//! an arm's line, its departure between rows, and what a shaper does to a machine that rings.
//!
//! `cargo run --example how_it_works -- [FOLDER]`

mod between;
mod line;
mod shaping;

use core::error::Error;
use std::path::PathBuf;

type Result<T, E = Box<dyn Error>> = core::result::Result<T, E>;

fn main() -> Result<()> {
    let folder = std::env::args_os().nth(1).map(PathBuf::from);
    let folder = folder.unwrap_or_else(|| "target/how_it_works".into());
    std::fs::create_dir_all(&folder)?;
    for (name, figure) in [
        ("time-law.svg", line::time_law()?),
        ("departure.svg", line::departure()?),
        ("shaping.svg", shaping::figure()?),
    ] {
        std::fs::write(folder.join(name), figure.to_string())?;
    }
    println!(
        "in {}: time-law.svg, departure.svg, shaping.svg",
        folder.display()
    );
    Ok(())
}
