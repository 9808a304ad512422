//! Notes of what an input asks for and a machine leaves out or does otherwise, one for each kind.

use core::fmt;

/// No more names are listed in one note.
const NAMES: usize = 8;

/// Where something stands in the input: a line, or a line and a column, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Location {
    line: usize,
    /// Where a line can be as long as the file.
    column: Option<usize>,
}

impl From<usize> for Location {
    fn from(line: usize) -> Self {
        Self { line, column: None }
    }
}

impl From<(usize, usize)> for Location {
    fn from((line, column): (usize, usize)) -> Self {
        let column = Some(column);
        Self { line, column }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}", self.line)?;
        match self.column {
            Some(column) => write!(f, ", column {column}"),
            None => Ok(()),
        }
    }
}

/// One kind of thing that was met.
#[derive(Debug, Clone)]
struct Note {
    what_is_done: &'static str,
    first: Location,
    names: Vec<String>,
    has_more_names: bool,
    count: usize,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.first, self.names.join(", "))?;
        if self.has_more_names {
            f.write_str(" and others")?;
        }
        let times = if self.count == 1 { "time" } else { "times" };
        write!(f, ": {} ({} {times})", self.what_is_done, self.count)
    }
}

/// Notes, by their kinds.
///
/// # Examples
/// ```
/// let mut notes = machine_sim::input::Notes::default();
/// notes.add(4, "Z", "passed over, there is no such axis");
/// notes.add(2, "A", "passed over, there is no such axis");
/// assert_eq!(
///     notes.lines(),
///     ["line 2: Z, A: passed over, there is no such axis (2 times)"]
/// );
/// ```
#[derive(Debug, Clone, Default)]
pub struct Notes(Vec<Note>);

impl Notes {
    /// Notes something by its name in the input, and what is done with it, which is its kind.
    pub fn add(
        &mut self,
        location: impl Into<Location>,
        name: impl Into<String>,
        what_is_done: &'static str,
    ) {
        self.merge(Self(vec![Note {
            what_is_done,
            first: location.into(),
            names: vec![name.into()],
            has_more_names: false,
            count: 1,
        }]));
    }

    /// Adds what was met later; returns the kinds that are new.
    #[expect(
        clippy::return_self_not_must_use,
        reason = "new kinds matter to dialogues alone"
    )]
    pub fn merge(&mut self, later: Self) -> Self {
        let mut new = Self::default();
        for note in later.0 {
            let same = |known: &&mut Note| known.what_is_done == note.what_is_done;
            let Some(known) = self.0.iter_mut().find(same) else {
                new.0.push(note.clone());
                self.0.push(note);
                continue;
            };
            known.count += note.count;
            known.first = known.first.min(note.first);
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

    /// One line for each kind: first location, names, what is done, how often; in the input's
    /// order.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let mut notes: Vec<_> = self.0.iter().collect();
        notes.sort_by_key(|note| note.first);
        notes.into_iter().map(ToString::to_string).collect()
    }
}
