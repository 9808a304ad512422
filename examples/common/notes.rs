//! What an input asks for and a program leaves out or does otherwise: one note for each kind.

use core::fmt;

/// No more names are listed in one note.
const NAMES: usize = 8;

/// One kind of thing that was met.
#[derive(Debug, Clone)]
struct Note {
    what_is_done: &'static str,
    first_line: usize,
    names: Vec<String>,
    has_more_names: bool,
    count: usize,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.first_line, self.names.join(", "))?;
        if self.has_more_names {
            f.write_str(" and others")?;
        }
        let times = if self.count == 1 { "time" } else { "times" };
        write!(f, ": {} ({} {times})", self.what_is_done, self.count)
    }
}

/// Notes, in the order in which their kinds were first met.
#[derive(Debug, Clone, Default)]
pub(crate) struct Notes(Vec<Note>);

impl Notes {
    /// Notes something by its name in the input, and what is done with it, which is its kind.
    pub(crate) fn add(&mut self, line: usize, name: impl Into<String>, what_is_done: &'static str) {
        self.merge(Self(vec![Note {
            what_is_done,
            first_line: line,
            names: vec![name.into()],
            has_more_names: false,
            count: 1,
        }]));
    }

    /// Adds what was met later; returns the kinds that are new.
    pub(crate) fn merge(&mut self, later: Self) -> Self {
        let mut new = Self::default();
        for note in later.0 {
            let same = |known: &&mut Note| known.what_is_done == note.what_is_done;
            let Some(known) = self.0.iter_mut().find(same) else {
                new.0.push(note.clone());
                self.0.push(note);
                continue;
            };
            known.count += note.count;
            known.has_more_names |= note.has_more_names;
            for name in note.names {
                if known.names.contains(&name) {
                    continue;
                }
                if known.names.len() < NAMES {
                    known.names.push(name);
                } else {
                    known.has_more_names = true;
                }
            }
        }
        new
    }

    /// One line for each kind: first place, names, what is done, how often.
    pub(crate) fn lines(&self) -> Vec<String> {
        self.0.iter().map(ToString::to_string).collect()
    }
}
