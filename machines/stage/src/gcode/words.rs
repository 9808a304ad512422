//! The words of one line of G-code.

use core::fmt;

use anyhow::{Context as _, Result, bail, ensure};

/// A letter and its number, if one follows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Word {
    /// In upper case.
    pub(crate) letter: char,
    pub(crate) number: Option<f64>,
    /// As written, but for spaces.
    text: String,
    /// From 1.
    column: usize,
}

impl Word {
    /// The number, which must be there.
    pub(crate) fn value(&self) -> Result<f64> {
        let place = || format!("column {}: {} without a number", self.column, self.letter);
        self.number.with_context(place)
    }

    /// The number of a code in tenths, as G90.1 is 901.
    pub(crate) fn tenths(&self) -> Result<u32> {
        const LARGEST: f64 = 99_999.0;
        let tenths = self.value()? * 10.0;
        let whole = tenths.round();
        ensure!(
            (0.0..=LARGEST).contains(&whole) && (tenths - whole).abs() < 1e-6,
            "{self}: no code of this stage"
        );
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked"
        )]
        Ok(whole as u32)
    }
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// A block: what stands on a line.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Block {
    pub(crate) words: Vec<Word>,
    /// It begins with `/`: a switch of the machine could delete it.
    pub(crate) can_be_deleted: bool,
    /// It is the tape's mark `%`, before and after a program.
    pub(crate) is_mark: bool,
}

/// M-codes of printers that the rest of the line belongs to, as text.
const TEXTS: [&str; 8] = ["M23", "M28", "M32", "M115", "M117", "M118", "M486", "M928"];

/// Reads a line; line number, comments and a right checksum say nothing and are left out.
pub(crate) fn read(line: &str) -> Result<Block> {
    let mut reader = Reader {
        rest: line,
        column: 1,
    };
    let mut read = Block::default();
    while let Some(next) = reader.next() {
        let column = reader.column;
        let is_first = read == Block::default();
        match next {
            ';' => break,
            '(' => reader.comment()?,
            '*' => {
                let before = line.len() - reader.rest.len();
                reader.checksum(line.get(..before).unwrap_or(line))?;
            }
            '/' if is_first => {
                reader.take(1);
                read.can_be_deleted = true;
            }
            '%' if is_first => {
                reader.take(1);
                read.is_mark = true;
            }
            letter if letter.is_ascii_alphabetic() && !read.is_mark => {
                let word = reader.word(letter)?;
                let is_number = word.letter == 'N' && read.words.is_empty();
                if is_number {
                    word.value()?;
                    continue;
                }
                let has_text = TEXTS.contains(&word.text.as_str());
                read.words.push(word);
                if has_text {
                    break;
                }
            }
            '#' | '[' | '=' | '<' => {
                bail!("column {column}: {next:?}: parameters and expressions are not computed here")
            }
            char::REPLACEMENT_CHARACTER => bail!("column {column}: no UTF-8 text"),
            other => bail!("column {column}: {other:?} begins no word"),
        }
    }
    Ok(read)
}

struct Reader<'a> {
    rest: &'a str,
    column: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> &'a str {
        let length = self.rest.chars().take(count).map(char::len_utf8).sum();
        let (taken, rest) = self.rest.split_at(length);
        self.rest = rest;
        self.column += count;
        taken
    }

    fn take_while(&mut self, wanted: impl Fn(char) -> bool) -> &'a str {
        let count = self.rest.chars().take_while(|c| wanted(*c)).count();
        self.take(count)
    }

    fn next(&mut self) -> Option<char> {
        self.take_while(char::is_whitespace);
        self.rest.chars().next()
    }

    fn comment(&mut self) -> Result<()> {
        let text = self.rest.trim_end();
        ensure!(text.contains(')'), "{text:?}: never closed");
        self.take_while(|c| c != ')');
        self.take(1);
        Ok(())
    }

    fn digits(&mut self) -> &'a str {
        self.take_while(|c| c.is_ascii_digit())
    }

    fn word(&mut self, letter: char) -> Result<Word> {
        let (column, letter) = (self.column, letter.to_ascii_uppercase());
        self.take(1);
        self.next();
        let sign = match self.rest.chars().next() {
            Some('+' | '-') => self.take(1),
            _ => "",
        };
        let whole = self.digits();
        let point = match self.rest.chars().next() {
            Some('.') => self.take(1),
            _ => "",
        };
        let decimals = if point.is_empty() { "" } else { self.digits() };
        let digits = format!("{sign}{whole}{point}{decimals}");
        let text = format!("{letter}{digits}");
        if whole.is_empty() && decimals.is_empty() {
            ensure!(digits.is_empty(), "column {column}: {text:?}: no number");
        } else {
            self.no_exponent(&text, column)?;
        }
        Ok(Word {
            letter,
            number: digits.parse().ok(),
            text,
            column,
        })
    }

    /// `X1e-5` is one number to some programs, and X1 with the extruder's E-5 to a printer.
    fn no_exponent(&self, text: &str, column: usize) -> Result<()> {
        let mut after = self.rest.chars();
        let is_exponent = matches!(after.next(), Some('e' | 'E'))
            && matches!(after.next(), Some('0'..='9' | '+' | '-'));
        ensure!(
            !is_exponent,
            "column {column}: {text}{}: a number has no exponent; a word E needs a space before it",
            self.rest
                .chars()
                .take_while(|c| !c.is_whitespace())
                .collect::<String>()
        );
        Ok(())
    }

    /// The exclusive or of all bytes before the star.
    fn checksum(&mut self, before: &str) -> Result<()> {
        let column = self.column;
        self.take(1);
        self.next();
        let stated = self.digits();
        let computed = before.bytes().fold(0, |sum, byte| sum ^ byte);
        ensure!(
            stated.parse() == Ok(computed),
            "column {column}: checksum {stated:?}, the line has {computed}"
        );
        Ok(())
    }
}
