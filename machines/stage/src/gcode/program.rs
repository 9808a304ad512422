//! Whole programs of G-code.

use anyhow::{Context, Result, bail};

use super::codes;
use super::interpreter::{Command, Interpreter};
use super::words;
use crate::motion::Motion;
use machine_sim::input::Notes;

/// A motion, and the number of its line from 1.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    pub(crate) number: usize,
    pub(crate) motion: Motion,
}

/// What a whole program asks for, up to its end: at least one motion.
#[derive(Debug, Clone, Default)]
pub struct Program {
    pub(crate) lines: Vec<Line>,
    notes: Notes,
}

impl Program {
    /// Reads a program.
    ///
    /// # Errors
    /// A line that would move X or Y otherwise than written, or that cannot be read, with its
    /// number; or nothing moves.
    pub fn parse(text: &str) -> Result<Self> {
        let mut interpreter = Interpreter::default();
        let mut program = Self::default();
        let (mut has_begun, mut has_ended) = (false, false);
        for (number, line) in (1..).zip(lines(text)) {
            if has_ended {
                program.note_unread(number, line);
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
        if program.lines.is_empty() {
            let why = ["nothing moves".to_owned()];
            bail!("{}", [&why, &*program.notes()].concat().join(": "));
        }
        Ok(program)
    }

    /// Reads a program as it is stored: where bytes are no text, in a comment of an old program,
    /// nothing is lost.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        Self::parse(&String::from_utf8_lossy(bytes))
    }

    /// The number of the line of each motion, from 1.
    pub fn line_numbers(&self) -> impl Iterator<Item = usize> {
        self.lines.iter().map(|line| line.number)
    }

    /// What it asks for that is left out or done otherwise.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.notes.lines()
    }

    /// Notes a line after the end, unless it is empty.
    fn note_unread(&mut self, number: usize, line: &str) {
        let is_empty = words::read(line).is_ok_and(|block| block.words.is_empty());
        if !is_empty {
            let begin: String = line.trim().chars().take(SHOWN).collect();
            self.notes
                .add(number, format!("{begin:?}"), codes::AFTER_END);
        }
    }
}

/// Of a line that is only noted, in characters.
const SHOWN: usize = 24;

/// Lines that end as on any system, without the mark of the text's encoding.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    text.split('\n')
        .map(|line| line.strip_suffix('\r').unwrap_or(line))
        .flat_map(|line| line.split('\r'))
}
