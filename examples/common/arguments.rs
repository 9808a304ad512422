//! Reads the command line.

use core::error::Error;

use clap::Parser;

/// The options, or one line that says what is wrong with them. `--help` prints and exits.
pub(crate) fn read<O: Parser>() -> Result<O, Box<dyn Error>> {
    O::try_parse().map_err(|error| {
        if error.use_stderr() {
            one_line(&error.to_string()).into()
        } else {
            error.exit()
        }
    })
}

/// The first paragraph of clap's message, without its `error: `.
fn one_line(message: &str) -> String {
    let paragraph: Vec<_> = message
        .lines()
        .map(str::trim)
        .take_while(|line| !line.is_empty())
        .collect();
    let line = paragraph.join(" ");
    line.strip_prefix("error: ").unwrap_or(&line).to_owned()
}
