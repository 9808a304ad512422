//! Commands as text.

use core::fmt::{self, Display, Formatter};

use thiserror::Error;

use crate::kinematics::{Axis, Kinematics};

/// What a telegram asks for: a word in small letters and its numbers, with spaces in between.
///
/// | text | what it does |
/// |---|---|
/// | `home` | finds all home switches |
/// | `line X Y [Z] [F]` | the tool along a straight line to there in mm, at most at F mm/s |
/// | `cw X Y I J [F]`, `ccw ..` | the same along an arc about the centre that is I, J from its begin |
/// | `jog AXIS A` | turns or moves an axis by A degrees or mm |
/// | `hold` | comes to rest on the path |
/// | `resume` | goes on |
/// | `stop` | comes to rest on the path and gives the rest of it up |
/// | `feed P` | at P percent of the planned speed from now on, 1 to 100 |
/// | `where` | tool, axes and steps |
/// | `status` | what the machine does |
/// | `limits` | where it can go, and how fast |
/// | `machine` | which it is |
/// | `scales` | what the scales of its axes read |
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command<const N: usize> {
    /// A motion.
    Job(Job<N>),
    /// To rest on the path.
    Hold,
    /// On from there.
    Resume,
    /// To rest on the path, for good.
    Stop,
    /// The speed of all motions.
    Feed {
        /// 1 to 100.
        percent: u8,
    },
    /// Tool, axes and steps.
    Where,
    /// What the machine does.
    Status,
    /// Where it can go, and how fast.
    Limits,
    /// Which it is.
    Machine,
    /// What the scales of its axes read.
    Scales,
}

/// A command that takes time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Job<const N: usize> {
    /// Finds all home switches.
    Home,
    /// A straight line of the tool.
    Line {
        /// The tool's position at the end, in mm.
        to_mm: [f64; N],
        /// Its largest speed, in mm/s.
        feed_mm_s: Option<f64>,
    },
    /// An arc of the tool in the plane of its first two coordinates.
    Arc {
        /// Which way it turns.
        turn: Turn,
        /// The tool's position at the end, in mm; where it begins: all round.
        to_mm: [f64; N],
        /// From the begin to the centre, in mm.
        centre_mm: [f64; 2],
        /// The tool's largest speed, in mm/s.
        feed_mm_s: Option<f64>,
    },
    /// One axis turns or moves.
    Jog {
        /// Which, from 0.
        axis: usize,
        /// By how much, in degrees or mm.
        by: f64,
    },
}

/// Which way an arc turns, as one looks at the plane with x to the right and y up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Clockwise.
    Clockwise,
    /// The other way.
    CounterClockwise,
}

/// Why a text is no command. Columns count from 1, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum CommandError<'t> {
    /// Nothing but spaces.
    #[error("no command")]
    Empty,
    /// A word that is not the name of a command.
    #[error("column {column}: `{}` is no command", Quoted(.word))]
    Unknown {
        /// Where it begins.
        column: usize,
        /// The word.
        word: &'t [u8],
    },
    /// The text ends before something that the command needs.
    #[error("column {column}: {name} is missing")]
    Missing {
        /// Where it should begin.
        column: usize,
        /// What.
        name: &'static str,
    },
    /// A word that is not what the command needs there.
    #[error("column {column}: `{}` is no {name}", Quoted(.word))]
    Wrong {
        /// Where it begins.
        column: usize,
        /// The word.
        word: &'t [u8],
        /// What it should be.
        name: &'static str,
    },
    /// A word after the end of the command.
    #[error("column {column}: `{}` is too much", Quoted(.word))]
    TooMuch {
        /// Where it begins.
        column: usize,
        /// The word.
        word: &'t [u8],
    },
}

/// The first bytes of a word, as far as an answer has room for them.
struct Quoted<'t>(&'t [u8]);

impl Display for Quoted<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        const MOST: usize = 16;
        let shown = self.0.get(..MOST).unwrap_or(self.0);
        write!(f, "{}", shown.escape_ascii())?;
        if shown.len() < self.0.len() {
            write!(f, "...")?;
        }
        Ok(())
    }
}

impl<const N: usize> Command<N> {
    /// The command of a text, for a kind of machine.
    ///
    /// # Errors
    /// [`CommandError`], with the place.
    pub fn parse<K: Kinematics<N>>(text: &[u8]) -> Result<Self, CommandError<'_>> {
        let mut words = Words { text, next: 0 };
        let (column, name) = words.next().ok_or(CommandError::Empty)?;
        let command = match name {
            b"home" => Self::Job(Job::Home),
            b"line" => Self::Job(Job::Line {
                to_mm: words.lengths()?,
                feed_mm_s: words.positive(FEED)?,
            }),
            b"cw" if K::HAS_ARCS => Self::Job(words.arc(Turn::Clockwise)?),
            b"ccw" if K::HAS_ARCS => Self::Job(words.arc(Turn::CounterClockwise)?),
            b"jog" => Self::Job(Job::Jog {
                axis: words.one_of(&K::AXES, K::ONE_AXIS)?,
                by: words.number(K::Axis::UNIT.number())?,
            }),
            b"hold" => Self::Hold,
            b"resume" => Self::Resume,
            b"stop" => Self::Stop,
            b"feed" => Self::Feed {
                percent: words.percent()?,
            },
            b"where" => Self::Where,
            b"status" => Self::Status,
            b"limits" => Self::Limits,
            b"machine" => Self::Machine,
            b"scales" => Self::Scales,
            word => return Err(CommandError::Unknown { column, word }),
        };
        match words.next() {
            None => Ok(command),
            Some((column, word)) => Err(CommandError::TooMuch { column, word }),
        }
    }
}

const FEED: &str = "positive number of mm/s";

/// The words of a text with their columns.
struct Words<'t> {
    text: &'t [u8],
    next: usize,
}

impl<'t> Iterator for Words<'t> {
    type Item = (usize, &'t [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let is_space = |&byte: &u8| byte.is_ascii_whitespace();
        let rest = self.text.get(self.next..)?;
        let start = self.next + rest.iter().position(|byte| !is_space(byte))?;
        let rest = self.text.get(start..)?;
        let len = rest.iter().position(is_space).unwrap_or(rest.len());
        self.next = start + len;
        Some((start + 1, rest.get(..len)?))
    }
}

impl<'t> Words<'t> {
    fn need(&mut self, name: &'static str) -> Result<(usize, &'t [u8]), CommandError<'t>> {
        let column = self.text.len() + 1;
        self.next().ok_or(CommandError::Missing { column, name })
    }

    fn number(&mut self, name: &'static str) -> Result<f64, CommandError<'t>> {
        let (column, word) = self.need(name)?;
        number(word).ok_or(CommandError::Wrong { column, word, name })
    }

    fn lengths<const D: usize>(&mut self) -> Result<[f64; D], CommandError<'t>> {
        let mut lengths = [0.0; D];
        for length in &mut lengths {
            *length = self.number("number of mm")?;
        }
        Ok(lengths)
    }

    fn arc<const N: usize>(&mut self, turn: Turn) -> Result<Job<N>, CommandError<'t>> {
        Ok(Job::Arc {
            turn,
            to_mm: self.lengths()?,
            centre_mm: self.lengths()?,
            feed_mm_s: self.positive(FEED)?,
        })
    }

    fn positive(&mut self, name: &'static str) -> Result<Option<f64>, CommandError<'t>> {
        let Some((column, word)) = self.next() else {
            return Ok(None);
        };
        match number(word) {
            Some(value) if value > 0.0 => Ok(Some(value)),
            _ => Err(CommandError::Wrong { column, word, name }),
        }
    }

    fn percent(&mut self) -> Result<u8, CommandError<'t>> {
        let name = "whole percentage from 1 to 100";
        let (column, word) = self.need(name)?;
        let percent = core::str::from_utf8(word)
            .ok()
            .and_then(|word| word.parse().ok());
        percent
            .filter(|percent| (1..=100).contains(percent))
            .ok_or(CommandError::Wrong { column, word, name })
    }

    fn one_of(&mut self, names: &[&str], name: &'static str) -> Result<usize, CommandError<'t>> {
        let (column, word) = self.need(name)?;
        let found = names.iter().position(|name| name.as_bytes() == word);
        found.ok_or(CommandError::Wrong { column, word, name })
    }
}

/// A finite number.
fn number(word: &[u8]) -> Option<f64> {
    let word = core::str::from_utf8(word).ok()?;
    word.parse().ok().filter(|value: &f64| value.is_finite())
}
