//! The items of any C header, one after the other: `#define`s, arrays and their values.

use core::fmt;
use core::iter::FusedIterator;

use super::scan::{Reach, Scanner, Token};
use super::{HeaderError, HeaderErrorKind, Location};

/// What a header has to say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Item<'a> {
    /// `#define` of a number.
    Define {
        /// The name.
        name: &'a str,
        /// The number.
        value: i64,
    },
    /// The start of an array with values.
    Array {
        /// The name.
        name: &'a str,
    },
    /// A value of the array.
    Value(i64),
    /// The end of the array.
    End,
}

/// The items of a header, each with its location. The iterator ends after the first error.
///
/// ```
/// use pattern_codec::c_header::{Item, items};
///
/// let text = "#define STOP 0\nunsigned char code table[] = { 0x10, -2, STOP };";
/// let items: Vec<_> = items(text).map(|item| item.map(|(_, item)| item)).collect::<Result<_, _>>()?;
/// assert_eq!(items[0], Item::Define { name: "STOP", value: 0 });
/// assert_eq!(items[1], Item::Array { name: "table" });
/// assert_eq!(items[2..5], [Item::Value(16), Item::Value(-2), Item::Value(0)]);
/// # Ok::<(), pattern_codec::c_header::HeaderError>(())
/// ```
#[must_use]
pub fn items(
    text: &str,
) -> impl FusedIterator<Item = Result<(Location, Item<'_>), HeaderError>> + Clone + fmt::Debug {
    Items::new(text)
}

/// Iterator over the [`items`] of a header.
#[derive(Debug, Clone)]
pub(super) struct Items<'a> {
    text: &'a str,
    scanner: Scanner<'a>,
    state: State,
}

#[derive(Debug, Clone, Copy)]
enum State {
    Outside,
    Inside(Inside),
    Over,
}

/// An array under way.
#[derive(Debug, Clone, Copy)]
struct Inside {
    dimensions: Dimensions,
    values: u32,
    /// Values in the row that is open.
    row: Option<u32>,
    /// A value or a row has ended, and no comma come yet.
    comma_due: bool,
}

/// Declared lengths, as far as they are.
#[derive(Debug, Clone, Copy, Default)]
struct Dimensions {
    count: u8,
    first: Option<u32>,
    second: Option<u32>,
}

const NUMBER: &str = "a number";

impl<'a> Iterator for Items<'a> {
    type Item = Result<(Location, Item<'a>), HeaderError>;

    fn next(&mut self) -> Option<Self::Item> {
        let item = match self.state {
            State::Outside => self.outside().transpose(),
            State::Inside(inside) => Some(self.inside(inside)),
            State::Over => None,
        };
        if !matches!(item, Some(Ok(_))) {
            self.stop();
        }
        item
    }
}

impl FusedIterator for Items<'_> {}

impl<'a> Items<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self {
            text,
            scanner: Scanner::new(text),
            state: State::Outside,
        }
    }

    /// The location of the next token, or the end.
    pub(super) fn location(mut self) -> Result<Location, HeaderError> {
        Ok(self.scanner.token(Reach::Text)?.0)
    }

    /// No more items.
    pub(super) const fn stop(&mut self) {
        self.state = State::Over;
    }

    /// Up to the next definition or array.
    fn outside(&mut self) -> Result<Option<(Location, Item<'a>)>, HeaderError> {
        let mut name = None;
        let mut dimensions = Dimensions::default();
        let mut assigned = false;
        loop {
            let (location, token) = self.scanner.token(Reach::Text)?;
            match token {
                Token::Directive => {
                    if let Some((name, value)) = directive(&mut self.scanner)? {
                        return Ok(Some((location, Item::Define { name, value })));
                    }
                }
                Token::Word { word, .. } if dimensions.count == 0 => name = Some(word),
                Token::Mark('[') => self.dimension(location, &mut dimensions)?,
                Token::Mark('=') => assigned = true,
                Token::Mark('{') if assigned && dimensions.count > 0 => {
                    let name = name.ok_or_else(|| unexpected(location, '{', "the array's name"))?;
                    self.state = State::Inside(Inside {
                        dimensions,
                        values: 0,
                        row: None,
                        comma_due: false,
                    });
                    return Ok(Some((location, Item::Array { name })));
                }
                Token::Mark(open @ ('(' | '{')) => self.skip_brackets(open)?,
                Token::Mark(';' | ',') => {
                    dimensions = Dimensions::default();
                    assigned = false;
                }
                Token::End => return Ok(None),
                Token::Word { .. } | Token::Number { .. } | Token::Mark(_) => {}
            }
        }
    }

    fn dimension(&mut self, at: Location, dimensions: &mut Dimensions) -> Result<(), HeaderError> {
        let (location, token) = self.scanner.token(Reach::Text)?;
        let length = if token == Token::Mark(']') {
            None
        } else {
            let length = self.value(location, token)?;
            let length = u32::try_from(length).map_err(|_| out_of_range(location, length))?;
            self.expect(']', "]")?;
            Some(length)
        };
        match dimensions.count {
            0 => dimensions.first = length,
            1 => dimensions.second = length,
            _ => return Err(at.error(HeaderErrorKind::Dimensions)),
        }
        dimensions.count = dimensions.count.saturating_add(1);
        Ok(())
    }

    /// Up to the next value or the end of the array.
    fn inside(&mut self, mut inside: Inside) -> Result<(Location, Item<'a>), HeaderError> {
        loop {
            let (location, token) = self.scanner.token(Reach::Text)?;
            match token {
                Token::Mark('}') => match inside.row.take() {
                    Some(values) => {
                        inside.dimensions.check_row(location, values)?;
                        inside.comma_due = true;
                    }
                    None => {
                        inside.dimensions.check(location, inside.values)?;
                        self.state = State::Outside;
                        return Ok((location, Item::End));
                    }
                },
                Token::Mark(',') if inside.comma_due => inside.comma_due = false,
                _ if inside.comma_due => return Err(wrong(location, token, ", or }")),
                Token::Mark('{') if inside.row.is_none() => {
                    if inside.dimensions.count < 2 {
                        return Err(location.error(HeaderErrorKind::Row));
                    }
                    inside.row = Some(0);
                }
                _ => {
                    let value = self.value(location, token)?;
                    inside.values = inside.values.saturating_add(1);
                    inside.row = inside.row.map(|values| values.saturating_add(1));
                    inside.comma_due = true;
                    self.state = State::Inside(inside);
                    return Ok((location, Item::Value(value)));
                }
            }
        }
    }

    /// A number that begins with a token, or a name that is defined further up.
    fn value(&mut self, location: Location, token: Token<'a>) -> Result<i64, HeaderError> {
        let (text, left) = (self.text, self.scanner.left());
        let defined = |name: &str| defined(text, left, name);
        value(&mut self.scanner, (location, token), Reach::Text, defined)
    }

    fn expect(&mut self, mark: char, wanted: &'static str) -> Result<(), HeaderError> {
        match self.scanner.token(Reach::Text)? {
            (_, Token::Mark(found)) if found == mark => Ok(()),
            (location, token) => Err(wrong(location, token, wanted)),
        }
    }

    /// Skips to the bracket that closes the one just read.
    fn skip_brackets(&mut self, open: char) -> Result<(), HeaderError> {
        let (close, wanted) = match open {
            '(' => (')', ")"),
            _ => ('}', "}"),
        };
        let mut depth = 1_u32;
        while depth > 0 {
            match self.scanner.token(Reach::Text)? {
                (_, Token::Mark(mark)) if mark == open => depth = depth.saturating_add(1),
                (_, Token::Mark(mark)) if mark == close => depth = depth.saturating_sub(1),
                (location, Token::End) => return Err(wrong(location, Token::End, wanted)),
                _ => {}
            }
        }
        Ok(())
    }
}

impl Dimensions {
    fn check_row(self, location: Location, values: u32) -> Result<(), HeaderError> {
        match self.second {
            Some(declared) if declared != values => {
                Err(location.error(HeaderErrorKind::RowLength { values, declared }))
            }
            _ => Ok(()),
        }
    }

    fn check(self, location: Location, values: u32) -> Result<(), HeaderError> {
        let declared = match (self.count, self.first, self.second) {
            (1, first, _) => first.map(u64::from),
            (_, Some(first), Some(second)) => Some(u64::from(first).saturating_mul(second.into())),
            _ => None,
        };
        let values = u64::from(values);
        match declared {
            Some(declared) if declared != values => {
                Err(location.error(HeaderErrorKind::ArrayLength { values, declared }))
            }
            _ => Ok(()),
        }
    }
}

/// The rest of a directive: name and value of a `#define` of a number.
fn directive<'a>(scanner: &mut Scanner<'a>) -> Result<Option<(&'a str, i64)>, HeaderError> {
    let line = Reach::Line;
    let mut defined = None;
    // What is no number is not ours to understand.
    if let Ok((_, Token::Word { word: "define", .. })) = scanner.token(line)
        && let Ok((_, Token::Word { word: name, .. })) = scanner.token(line)
    {
        let mut ahead = scanner.clone();
        if let Ok(first) = ahead.token(line)
            && let Ok(value) = value(&mut ahead, first, line, |_| None)
            && let Ok((_, Token::End)) = ahead.token(line)
        {
            defined = Some((name, value));
        }
    }
    scanner.skip_line()?;
    Ok(defined)
}

/// The definition of a name before the last `left` bytes of the text; C allows no second one.
fn defined(text: &str, left: usize, wanted: &str) -> Option<i64> {
    let mut scanner = Scanner::new(text);
    while scanner.left() > left {
        if scanner.token(Reach::Text).ok()?.1 == Token::Directive
            && let Some((name, value)) = directive(&mut scanner).ok()?
            && name == wanted
        {
            return Some(value);
        }
    }
    None
}

/// A number, perhaps by its name, with any signs and round brackets, from its first token on.
fn value<'a>(
    scanner: &mut Scanner<'a>,
    (mut location, mut token): (Location, Token<'a>),
    reach: Reach,
    defined: impl Fn(&str) -> Option<i64>,
) -> Result<i64, HeaderError> {
    let (mut negative, mut depth) = (false, 0_u32);
    let value = loop {
        let value = match token {
            Token::Number { value, .. } => Some(i64::from(value)),
            Token::Word { word, .. } => defined(word),
            _ => None,
        };
        match (value, token) {
            (Some(value), _) => break value,
            (None, Token::Mark('-')) => negative = !negative,
            (None, Token::Mark('+')) => {}
            (None, Token::Mark('(')) => depth = depth.saturating_add(1),
            _ => return Err(wrong(location, token, NUMBER)),
        }
        (location, token) = scanner.token(reach)?;
    };
    for _ in 0..depth {
        match scanner.token(reach)? {
            (_, Token::Mark(')')) => {}
            (location, token) => return Err(wrong(location, token, ")")),
        }
    }
    // Within 33 bits.
    Ok(if negative {
        value.wrapping_neg()
    } else {
        value
    })
}

fn wrong(location: Location, token: Token<'_>, wanted: &'static str) -> HeaderError {
    let found = match token {
        Token::End => return location.error(HeaderErrorKind::UnexpectedEnd { wanted }),
        Token::Directive => '#',
        Token::Mark(mark) => mark,
        Token::Word { first, .. } | Token::Number { first, .. } => first,
    };
    unexpected(location, found, wanted)
}

const fn unexpected(location: Location, found: char, wanted: &'static str) -> HeaderError {
    location.error(HeaderErrorKind::Unexpected { found, wanted })
}

const fn out_of_range(location: Location, value: i64) -> HeaderError {
    let (min, max) = (0, u32::MAX as i64);
    location.error(HeaderErrorKind::Range { value, min, max })
}
