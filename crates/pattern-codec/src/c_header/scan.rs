//! A text cut into tokens of C, without blanks and comments.

use core::num::IntErrorKind;
use core::str::Chars;

use super::{HeaderError, HeaderErrorKind, Location};

/// A piece of C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Token<'a> {
    Word {
        word: &'a str,
        first: char,
    },
    Number {
        value: u32,
        first: char,
    },
    /// Any other character; a string or character constant is its first quote.
    Mark(char),
    /// `#` first on its line.
    Directive,
    /// The end of the text, or of the line if only that was asked for.
    End,
}

/// How far a token may be away.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    Text,
    Line,
}

/// Cuts a text into tokens, without blanks and comments.
#[derive(Debug, Clone)]
pub(super) struct Scanner<'a> {
    chars: Chars<'a>,
    location: Location,
    /// Nothing but blanks since the line began.
    at_line_start: bool,
}

impl<'a> Scanner<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self {
            chars: text.strip_prefix('\u{FEFF}').unwrap_or(text).chars(),
            location: Location::START,
            at_line_start: true,
        }
    }

    /// Bytes still to read.
    pub(super) fn left(&self) -> usize {
        self.rest().len()
    }

    pub(super) fn token(&mut self, reach: Reach) -> Result<(Location, Token<'a>), HeaderError> {
        self.skip_blanks(reach)?;
        let location = self.location;
        let at_line_start = core::mem::replace(&mut self.at_line_start, false);
        let token = match self.peek() {
            None => Token::End,
            // Blanks that are left are the line end.
            Some(c) if c.is_whitespace() => Token::End,
            Some('#') if at_line_start => {
                self.bump();
                Token::Directive
            }
            Some(first) if first.is_ascii_digit() => {
                let value = number(self.word()).map_err(|kind| location.error(kind))?;
                Token::Number { value, first }
            }
            Some(first) if first.is_alphabetic() || first == '_' => {
                let word = self.word();
                Token::Word { word, first }
            }
            Some(quote @ ('"' | '\'')) => {
                self.skip_quoted(quote)?;
                Token::Mark(quote)
            }
            Some(mark) => {
                self.bump();
                Token::Mark(mark)
            }
        };
        Ok((location, token))
    }

    /// Skips the rest of a directive.
    pub(super) fn skip_line(&mut self) -> Result<(), HeaderError> {
        loop {
            self.skip_blanks(Reach::Line)?;
            match self.peek() {
                Some(c) if !c.is_whitespace() => self.bump(),
                _ => return Ok(()),
            }
        }
    }

    fn rest(&self) -> &'a str {
        self.chars.as_str()
    }

    fn peek(&self) -> Option<char> {
        self.chars.clone().next()
    }

    fn bump(&mut self) {
        let Location { line, column } = self.location;
        self.location = match self.chars.next() {
            None => return,
            Some('\r') if self.rest().starts_with('\n') => return,
            Some('\n' | '\r') => Location {
                line: line.saturating_add(1),
                column: 1,
            },
            Some(_) => Location {
                line,
                column: column.saturating_add(1),
            },
        }
    }

    fn word(&mut self) -> &'a str {
        let is_end = |c: char| !c.is_alphanumeric() && c != '_';
        let rest = self.rest();
        while self.peek().is_some_and(|c| !is_end(c)) {
            self.bump();
        }
        rest.split_once(is_end).map_or(rest, |(word, _)| word)
    }

    fn skip_blanks(&mut self, reach: Reach) -> Result<(), HeaderError> {
        loop {
            let rest = self.rest();
            match self.peek() {
                Some('\n' | '\r') if reach == Reach::Line => return Ok(()),
                Some('\n' | '\r') => {
                    self.at_line_start = true;
                    self.bump();
                }
                Some(c) if c.is_whitespace() => self.bump(),
                Some('/') if rest.starts_with("/*") => self.skip_comment()?,
                Some('/') if rest.starts_with("//") => {
                    // A line that goes on takes the comment along.
                    while self.peek().is_some_and(|c| c != '\n' && c != '\r') {
                        if !self.skip_continuation() {
                            self.bump();
                        }
                    }
                }
                Some('\\') if self.skip_continuation() => {}
                _ => return Ok(()),
            }
        }
    }

    /// Skips a backslash and the line end after it, if they come next.
    fn skip_continuation(&mut self) -> bool {
        let continues = ["\\\n", "\\\r"]
            .iter()
            .any(|end| self.rest().starts_with(end));
        if continues {
            self.bump();
            if self.rest().starts_with("\r\n") {
                self.bump();
            }
            self.bump();
        }
        continues
    }

    fn skip_comment(&mut self) -> Result<(), HeaderError> {
        let start = self.location;
        self.bump();
        self.bump();
        while !self.rest().starts_with("*/") {
            if self.peek().is_none() {
                return Err(start.error(HeaderErrorKind::OpenComment));
            }
            self.bump();
        }
        self.bump();
        self.bump();
        Ok(())
    }

    fn skip_quoted(&mut self, quote: char) -> Result<(), HeaderError> {
        self.bump();
        loop {
            match self.peek() {
                None | Some('\n' | '\r') => {
                    let wanted = "the closing quote";
                    let kind = HeaderErrorKind::UnexpectedEnd { wanted };
                    return Err(self.location.error(kind));
                }
                Some('\\') => self.bump(),
                Some(c) if c == quote => {
                    self.bump();
                    return Ok(());
                }
                Some(_) => {}
            }
            self.bump();
        }
    }
}

/// The value of a C integer constant.
fn number(word: &str) -> Result<u32, HeaderErrorKind> {
    let digits = word.trim_end_matches(['u', 'U', 'l', 'L']);
    let after = |prefixes: [&str; 2]| prefixes.iter().find_map(|p| digits.strip_prefix(p));
    let value = if let Some(hex) = after(["0x", "0X"]) {
        u32::from_str_radix(hex, 16)
    } else if let Some(binary) = after(["0b", "0B"]) {
        u32::from_str_radix(binary, 2)
    } else if digits.starts_with('0') {
        u32::from_str_radix(digits, 8)
    } else {
        digits.parse()
    };
    value.map_err(|error| match error.kind() {
        IntErrorKind::PosOverflow => HeaderErrorKind::TooLarge,
        _ => HeaderErrorKind::NotANumber,
    })
}
