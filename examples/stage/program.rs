//! Whole programs of G-code.

use anyhow::{Context, Result};

use crate::codes;
use crate::geometry::Motion;
use crate::interpreter::{Command, Interpreter};
use crate::words;
use machine_sim::input::Notes;

/// A motion, and the number of its line from 1.
pub(crate) struct Line {
    pub(crate) number: usize,
    pub(crate) motion: Motion,
}

/// What a whole program asks for.
#[derive(Default)]
pub(crate) struct Program {
    pub(crate) lines: Vec<Line>,
    /// What it asks for that is left out or done otherwise.
    pub(crate) notes: Notes,
}

/// Reads a whole program, up to its end.
pub(crate) fn read(text: &str) -> Result<Program> {
    let mut interpreter = Interpreter::default();
    let mut program = Program::default();
    let (mut has_begun, mut has_ended) = (false, false);
    for (number, line) in (1..).zip(lines(text)) {
        if has_ended {
            let is_empty = words::read(line).is_ok_and(|block| block.words.is_empty());
            if !is_empty {
                let begin: String = line.trim().chars().take(SHOWN).collect();
                let name = format!("{begin:?}");
                program.notes.add(number, name, codes::AFTER_END);
            }
            continue;
        }
        let command = interpreter.line(number, line, &mut program.notes);
        match command.with_context(|| format!("line {number}"))? {
            Command::Moves(moves) => {
                let line = |motion| Line { number, motion };
                program.lines.extend(moves.into_iter().map(line));
            }
            Command::Mark => has_ended = has_begun,
            Command::End => has_ended = true,
        }
        has_begun |= !line.trim().is_empty();
    }
    Ok(program)
}

/// Of a line that is only told of, in characters.
const SHOWN: usize = 24;

/// Lines that end as on any system, without the mark of the text's encoding.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    text.split('\n')
        .map(|line| line.strip_suffix('\r').unwrap_or(line))
        .flat_map(|line| line.split('\r'))
}
