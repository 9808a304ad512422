use core::iter::FusedIterator;

use super::scan::{Reach, Scanner, Token};
use super::{HeaderError, HeaderErrorKind, Place};

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

/// The items of a header.
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
pub fn items(text: &str) -> Items<'_> {
    Items {
        text,
        scanner: Scanner::new(text),
        state: State::Outside,
    }
}

/// Iterator over the [`items`] of a header, each with its place. It ends after the first error.
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Items<'a> {
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
    type Item = Result<(Place, Item<'a>), HeaderError>;

    fn next(&mut self) -> Option<Self::Item> {
        let item = match self.state {
            State::Outside => self.outside().transpose(),
            State::Inside(inside) => Some(self.inside(inside)),
            State::Over => None,
        };
        if !matches!(item, Some(Ok(_))) {
            self.state = State::Over;
        }
        item
    }
}

impl FusedIterator for Items<'_> {}

impl<'a> Items<'a> {
    /// Up to the next definition or array.
    fn outside(&mut self) -> Result<Option<(Place, Item<'a>)>, HeaderError> {
        let mut name = None;
        let mut dimensions = Dimensions::default();
        let mut assigned = false;
        loop {
            let (place, token) = self.scanner.token(Reach::Text)?;
            match token {
                Token::Directive => {
                    if let Some((name, value)) = directive(&mut self.scanner)? {
                        return Ok(Some((place, Item::Define { name, value })));
                    }
                }
                Token::Word(word) if dimensions.count == 0 => name = Some(word),
                Token::Mark('[') => self.dimension(place, &mut dimensions)?,
                Token::Mark('=') => assigned = true,
                Token::Mark('{') if assigned && dimensions.count > 0 => {
                    let name = name.ok_or_else(|| unexpected(place, '{', "the array's name"))?;
                    self.state = State::Inside(Inside {
                        dimensions,
                        values: 0,
                        row: None,
                        comma_due: false,
                    });
                    return Ok(Some((place, Item::Array { name })));
                }
                Token::Mark(open @ ('(' | '{')) => self.skip_brackets(open)?,
                Token::Mark(';' | ',') => {
                    dimensions = Dimensions::default();
                    assigned = false;
                }
                Token::End => return Ok(None),
                Token::Word(_) | Token::Number(_) | Token::Mark(_) => {}
            }
        }
    }

    fn dimension(&mut self, at: Place, dimensions: &mut Dimensions) -> Result<(), HeaderError> {
        let (place, token) = self.scanner.token(Reach::Text)?;
        let length = if token == Token::Mark(']') {
            None
        } else {
            let length = self.value(place, token)?;
            let length = u32::try_from(length).map_err(|_| out_of_range(place, length))?;
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
    fn inside(&mut self, mut inside: Inside) -> Result<(Place, Item<'a>), HeaderError> {
        loop {
            let (place, token) = self.scanner.token(Reach::Text)?;
            match token {
                Token::Mark('}') => match inside.row.take() {
                    Some(values) => {
                        inside.dimensions.check_row(place, values)?;
                        inside.comma_due = true;
                    }
                    None => {
                        inside.dimensions.check(place, inside.values)?;
                        self.state = State::Outside;
                        return Ok((place, Item::End));
                    }
                },
                Token::Mark(',') if inside.comma_due => inside.comma_due = false,
                _ if inside.comma_due => return Err(wrong(place, token, ", or }")),
                Token::Mark('{') if inside.row.is_none() => {
                    if inside.dimensions.count < 2 {
                        return Err(place.error(HeaderErrorKind::Row));
                    }
                    inside.row = Some(0);
                }
                _ => {
                    let value = self.value(place, token)?;
                    inside.values = inside.values.saturating_add(1);
                    inside.row = inside.row.map(|values| values.saturating_add(1));
                    inside.comma_due = true;
                    self.state = State::Inside(inside);
                    return Ok((place, Item::Value(value)));
                }
            }
        }
    }

    /// A number that begins with a token, or the name of one that is defined further up.
    fn value(&mut self, place: Place, token: Token<'a>) -> Result<i64, HeaderError> {
        if let Token::Word(name) = token {
            return self
                .defined(name)
                .ok_or_else(|| wrong(place, token, NUMBER));
        }
        value(&mut self.scanner, (place, token), Reach::Text)
    }

    /// The definition of a name further up; C allows no second one.
    fn defined(&self, wanted: &str) -> Option<i64> {
        let mut scanner = Scanner::new(self.text);
        while scanner.left() > self.scanner.left() {
            if scanner.token(Reach::Text).ok()?.1 == Token::Directive
                && let Some((name, value)) = directive(&mut scanner).ok()?
                && name == wanted
            {
                return Some(value);
            }
        }
        None
    }

    fn expect(&mut self, mark: char, wanted: &'static str) -> Result<(), HeaderError> {
        match self.scanner.token(Reach::Text)? {
            (_, Token::Mark(found)) if found == mark => Ok(()),
            (place, token) => Err(wrong(place, token, wanted)),
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
                (place, Token::End) => return Err(wrong(place, Token::End, wanted)),
                _ => {}
            }
        }
        Ok(())
    }
}

impl Dimensions {
    fn check_row(self, place: Place, values: u32) -> Result<(), HeaderError> {
        match self.second {
            Some(declared) if declared != values => {
                Err(place.error(HeaderErrorKind::RowLength { values, declared }))
            }
            _ => Ok(()),
        }
    }

    fn check(self, place: Place, values: u32) -> Result<(), HeaderError> {
        let declared = match (self.count, self.first, self.second) {
            (1, first, _) => first,
            (_, Some(first), Some(second)) => Some(first.saturating_mul(second)),
            _ => None,
        };
        match declared {
            Some(declared) if declared != values => {
                Err(place.error(HeaderErrorKind::ArrayLength { values, declared }))
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
    if let Ok((_, Token::Word("define"))) = scanner.token(line)
        && let Ok((_, Token::Word(name))) = scanner.token(line)
    {
        let mut ahead = scanner.clone();
        if let Ok(first) = ahead.token(line)
            && let Ok(value) = value(&mut ahead, first, line)
            && let Ok((_, Token::End)) = ahead.token(line)
        {
            defined = Some((name, value));
        }
    }
    scanner.skip_line()?;
    Ok(defined)
}

/// A number with any signs and round brackets, from its first token on.
fn value<'a>(
    scanner: &mut Scanner<'a>,
    first: (Place, Token<'a>),
    reach: Reach,
) -> Result<i64, HeaderError> {
    let (mut place, mut token) = first;
    let (mut negative, mut depth) = (false, 0_u32);
    let magnitude = loop {
        match token {
            Token::Mark('-') => negative = !negative,
            Token::Mark('+') => {}
            Token::Mark('(') => depth = depth.saturating_add(1),
            Token::Number(magnitude) => break i64::from(magnitude),
            _ => return Err(wrong(place, token, NUMBER)),
        }
        (place, token) = scanner.token(reach)?;
    };
    for _ in 0..depth {
        match scanner.token(reach)? {
            (_, Token::Mark(')')) => {}
            (place, token) => return Err(wrong(place, token, ")")),
        }
    }
    Ok(if negative {
        magnitude.wrapping_neg()
    } else {
        magnitude
    })
}

fn wrong(place: Place, token: Token<'_>, wanted: &'static str) -> HeaderError {
    let found = match token {
        Token::End => return place.error(HeaderErrorKind::UnexpectedEnd { wanted }),
        Token::Directive => '#',
        Token::Mark(mark) => mark,
        Token::Word(word) => word.chars().next().unwrap_or(' '),
        Token::Number(_) => '0',
    };
    unexpected(place, found, wanted)
}

const fn unexpected(place: Place, found: char, wanted: &'static str) -> HeaderError {
    place.error(HeaderErrorKind::Unexpected { found, wanted })
}

const fn out_of_range(place: Place, value: i64) -> HeaderError {
    let (min, max) = (0, u32::MAX as i64);
    place.error(HeaderErrorKind::Range { value, min, max })
}

/// The value of the `#define` whose name is a table's in upper case, `_` and `end`.
pub(crate) fn define(text: &str, table: &str, end: &str) -> Option<(Place, i64)> {
    items(text).find_map(|item| match item {
        Ok((place, Item::Define { name, value })) if is_define(name, table, end) => {
            Some((place, value))
        }
        _ => None,
    })
}

fn is_define(name: &str, table: &str, end: &str) -> bool {
    let behind = name
        .strip_suffix(end)
        .and_then(|start| start.strip_suffix('_'));
    behind.is_some_and(|start| {
        start
            .chars()
            .eq(table.chars().map(|c| c.to_ascii_uppercase()))
    })
}

/// The values of one array: of the wanted name, or else of the only one. The whole text is read.
///
/// # Errors
/// [`HeaderError`]: whatever is wrong with the text; no such array, or two of them.
pub(crate) fn array<'a>(
    text: &'a str,
    wanted: Option<(&str, &str)>,
    range: (i64, i64),
) -> Result<(&'a str, ArrayValues<'a>), HeaderError> {
    let mut items = items(text);
    let mut found = None;
    while let Some(item) = items.next() {
        if let (place, Item::Array { name }) = item?
            && wanted.is_none_or(|(start, end)| name.strip_suffix(end) == Some(start))
        {
            let values = ArrayValues {
                items: items.clone(),
                place,
                range,
                error: None,
            };
            if found.replace((name, values)).is_some() {
                return Err(place.error(HeaderErrorKind::SecondArray));
            }
        }
    }
    let (end, _) = items.scanner.token(Reach::Text)?;
    found.ok_or_else(|| end.error(HeaderErrorKind::NoArray))
}

/// The values of an array. After an error there are no more.
#[derive(Debug, Clone)]
pub(crate) struct ArrayValues<'a> {
    items: Items<'a>,
    range: (i64, i64),
    /// Of the last value, or the end.
    pub(crate) place: Place,
    pub(crate) error: Option<HeaderError>,
}

impl Iterator for ArrayValues<'_> {
    type Item = i64;

    fn next(&mut self) -> Option<i64> {
        if self.error.is_some() {
            return None;
        }
        match self.items.next()? {
            Ok((place, Item::Value(value))) => {
                self.place = place;
                let (min, max) = self.range;
                if (min..=max).contains(&value) {
                    return Some(value);
                }
                let kind = HeaderErrorKind::Range { value, min, max };
                self.error = Some(place.error(kind));
            }
            Ok((place, _)) => {
                self.place = place;
                // Another array may follow.
                self.items.state = State::Over;
            }
            Err(error) => self.error = Some(error),
        }
        None
    }
}
