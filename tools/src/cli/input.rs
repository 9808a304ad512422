//! Lines of standard input.

use std::{
    io::{self, BufRead as _},
    thread,
};

use tokio::sync::mpsc;

/// A line: its number, and what stands there, or why it cannot be read.
pub(super) type InputLine = (usize, Result<String, String>);

/// Reads standard input in a thread of its own; empty lines are left out.
pub(super) fn lines() -> mpsc::Receiver<InputLine> {
    let (sender, receiver) = mpsc::channel(1);
    thread::spawn(move || {
        for (number, line) in (1..).zip(io::stdin().lock().lines()) {
            let readable = match &line {
                Ok(_) => true,
                Err(error) => error.kind() == io::ErrorKind::InvalidData, // not text, but read
            };
            let line = match line {
                Ok(line) if line.trim().is_empty() => continue,
                Ok(line) => Ok(line.trim().to_owned()),
                Err(error) => Err(error.to_string()),
            };
            if sender.blocking_send((number, line)).is_err() || !readable {
                return;
            }
        }
    });
    receiver
}
