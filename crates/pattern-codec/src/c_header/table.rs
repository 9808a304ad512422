use super::{HeaderError, HeaderErrorKind, Item, Items, Place, items};

/// The value of the `#define` whose name is a table's in upper case, `_` and `end`.
fn define(text: &str, table: &str, end: &str) -> Option<(Place, i64)> {
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

/// Whether a name is a table's name and `end`.
fn is_table(name: &str, table: &str, end: &str) -> bool {
    name.strip_suffix(end) == Some(table)
}

/// Name and values of one array: the one of the wanted name, a table's and an end, or else the only
/// one. The whole text is read.
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
            && wanted.is_none_or(|(table, end)| is_table(name, table, end))
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
    let end = items.place()?;
    found.ok_or_else(|| end.error(HeaderErrorKind::NoArray))
}

/// The values of an array. After an error there are no more.
#[derive(Debug, Clone)]
pub(crate) struct ArrayValues<'a> {
    items: Items<'a>,
    range: (i64, i64),
    /// Of the array, then of the last value, at last of the end.
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
                self.items.stop();
            }
            Err(error) => self.error = Some(error),
        }
        None
    }
}

/// What a byte may be written as, signed or unsigned.
pub(crate) const BYTE: (i64, i64) = (i8::MIN as i64, u8::MAX as i64);

/// What a word of two bytes may be written as.
pub(crate) const WORD: (i64, i64) = (i16::MIN as i64, u16::MAX as i64);

/// The values of an array as bytes.
#[derive(Debug, Clone)]
pub(crate) struct Bytes<'a>(pub(crate) ArrayValues<'a>);

impl Iterator for Bytes<'_> {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        let [byte, ..] = self.0.next()?.to_le_bytes();
        Some(byte)
    }
}

/// Refuses a `#define` of a table that has another value than the table itself.
pub(crate) fn agree(
    text: &str,
    table: &str,
    end: &'static str,
    wanted: u64,
) -> Result<(), HeaderError> {
    let wanted = i64::try_from(wanted).unwrap_or(i64::MAX);
    match define(text, table, end) {
        Some((place, value)) if value != wanted => Err(place.error(HeaderErrorKind::Define {
            name: end,
            value,
            wanted,
        })),
        _ => Ok(()),
    }
}

/// What a `#define` of a table stands for; the default where there is none.
///
/// # Errors
/// [`HeaderErrorKind::Range`] where `parse` has no answer, with the range of those that have one.
pub(crate) fn setting<T>(
    text: &str,
    table: &str,
    end: &str,
    default: T,
    (min, max): (i64, i64),
    parse: impl Fn(i64) -> Option<T>,
) -> Result<T, HeaderError> {
    let Some((place, value)) = define(text, table, end) else {
        return Ok(default);
    };
    parse(value).ok_or_else(|| place.error(HeaderErrorKind::Range { value, min, max }))
}
