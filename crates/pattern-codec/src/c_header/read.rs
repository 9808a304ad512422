//! The reader that all tables share: the array, the `#define`s that go with it, and items that are
//! checked once and then taken straight from the text.

use core::iter::FusedIterator;

use super::items::Items;
use super::{HeaderError, HeaderErrorKind, Item, Location, items};
use crate::size_hint::size_of_rest;

/// A text, and the name of the table in it that counts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Source<'t> {
    text: &'t str,
    pub(crate) name: &'t str,
}

impl<'t> Source<'t> {
    /// The array of the wanted name, or else the only one. The whole text is read.
    ///
    /// # Errors
    /// [`HeaderError`]: whatever is wrong with the text; no such array, or two of them.
    pub(crate) fn find(
        text: &'t str,
        wanted: Option<&str>,
        range: (i64, i64),
    ) -> Result<(Self, ArrayValues<'t>), HeaderError> {
        let is_wanted = |name: &str| wanted.is_none_or(|wanted| wanted == name);
        let (name, values) = array(text, is_wanted, range)?;
        Ok((Self { text, name }, values))
    }

    /// The values of the array with the table's name and an end of its own.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub(crate) fn second_array(
        &self,
        end: &str,
        range: (i64, i64),
    ) -> Result<ArrayValues<'t>, HeaderError> {
        let is_wanted = |name: &str| name.strip_suffix(end) == Some(self.name);
        Ok(array(self.text, is_wanted, range)?.1)
    }

    /// The value of the `#define` whose name is the table's in upper case, `_` and `end`.
    fn define(&self, end: &str) -> Option<(Location, i64)> {
        items(self.text).find_map(|item| match item {
            Ok((location, Item::Define { name, value })) if self.is_define(name, end) => {
                Some((location, value))
            }
            _ => None,
        })
    }

    fn is_define(&self, name: &str, end: &str) -> bool {
        let before = name
            .strip_suffix(end)
            .and_then(|start| start.strip_suffix('_'));
        let table = self.name.chars().map(|c| c.to_ascii_uppercase());
        before.is_some_and(|start| start.chars().eq(table))
    }

    /// Refuses a `#define` that has another value than the table itself.
    pub(crate) fn agree(&self, end: &'static str, wanted: u64) -> Result<(), HeaderError> {
        let Some((location, value)) = self.define(end) else {
            return Ok(());
        };
        if u64::try_from(value) == Ok(wanted) {
            return Ok(());
        }
        let name = end;
        Err(location.error(HeaderErrorKind::Define {
            name,
            value,
            wanted,
        }))
    }

    /// What a `#define` stands for; the default where there is none.
    ///
    /// # Errors
    /// [`HeaderErrorKind::Range`] where `parse` has no answer, with the range that has them.
    pub(crate) fn setting<T>(
        &self,
        end: &str,
        default: T,
        (min, max): (i64, i64),
        parse: impl Fn(i64) -> Option<T>,
    ) -> Result<T, HeaderError> {
        let Some((location, value)) = self.define(end) else {
            return Ok(default);
        };
        parse(value).ok_or_else(|| location.error(HeaderErrorKind::Range { value, min, max }))
    }
}

/// Name and values of the one array whose name is wanted.
fn array<'t>(
    text: &'t str,
    is_wanted: impl Fn(&str) -> bool,
    range: (i64, i64),
) -> Result<(&'t str, ArrayValues<'t>), HeaderError> {
    let mut items = Items::new(text);
    let mut found = None;
    while let Some(item) = items.next() {
        if let (location, Item::Array { name }) = item?
            && is_wanted(name)
        {
            let values = ArrayValues {
                items: items.clone(),
                location,
                range,
                error: None,
            };
            if found.replace((name, values)).is_some() {
                return Err(location.error(HeaderErrorKind::SecondArray));
            }
        }
    }
    let end = items.location()?;
    found.ok_or_else(|| end.error(HeaderErrorKind::NoArray))
}

/// The values of an array. After an error there are no more.
#[derive(Debug, Clone)]
pub(crate) struct ArrayValues<'t> {
    items: Items<'t>,
    range: (i64, i64),
    /// Location of the array, then of the last value, at last of the end.
    pub(crate) location: Location,
    error: Option<HeaderError>,
}

impl ArrayValues<'_> {
    /// Goes through all values and counts them.
    ///
    /// # Errors
    /// The first value that the range does not hold, or what is wrong with the text.
    pub(crate) fn count_all(&mut self) -> Result<u64, HeaderError> {
        let count = self
            .by_ref()
            .fold(0_u64, |count, _| count.saturating_add(1));
        self.error.map_or(Ok(count), Err)
    }
}

impl Iterator for ArrayValues<'_> {
    type Item = i64;

    fn next(&mut self) -> Option<i64> {
        if self.error.is_some() {
            return None;
        }
        match self.items.next()? {
            Ok((location, Item::Value(value))) => {
                self.location = location;
                let (min, max) = self.range;
                if (min..=max).contains(&value) {
                    return Some(value);
                }
                let kind = HeaderErrorKind::Range { value, min, max };
                self.error = Some(location.error(kind));
            }
            Ok((location, _)) => {
                self.location = location;
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
pub(crate) struct Bytes<'t>(pub(crate) ArrayValues<'t>);

impl Iterator for Bytes<'_> {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        let [byte, ..] = self.0.next()?.to_le_bytes();
        Some(byte)
    }
}

/// Items decoded from an array, of which a known number comes without error.
#[derive(Debug, Clone)]
pub(crate) struct Checked<I> {
    items: I,
    left: u64,
}

impl<I> Checked<I> {
    /// Items of which `left` have been gone through.
    pub(crate) const fn known(items: I, left: u64) -> Self {
        Self { items, left }
    }

    /// Items still to come.
    pub(crate) const fn left(&self) -> u64 {
        self.left
    }
}

impl<I, T, E> Checked<I>
where
    I: Iterator<Item = Result<T, E>> + Clone,
{
    /// Goes through all items; returns them, and the iterator as it is at its end.
    ///
    /// # Errors
    /// What is wrong with the array that they come from, or its last value does not fit.
    pub(crate) fn new(
        items: I,
        values: impl Fn(&I) -> &ArrayValues<'_>,
        kind: impl Fn(E) -> HeaderErrorKind,
    ) -> Result<(Self, I), HeaderError> {
        let mut all = items.clone();
        let mut left = 0_u64;
        loop {
            let item = all.next();
            let values = values(&all);
            match (values.error, item) {
                (Some(error), _) => return Err(error),
                (None, Some(Err(error))) => return Err(values.location.error(kind(error))),
                (None, Some(Ok(_))) => left = left.saturating_add(1),
                (None, None) => return Ok((Self { items, left }, all)),
            }
        }
    }
}

impl<I, T, E> Iterator for Checked<I>
where
    I: Iterator<Item = Result<T, E>>,
{
    type Item = T;

    fn next(&mut self) -> Option<T> {
        self.left = self.left.checked_sub(1)?;
        // No error comes: all of them have been gone through.
        self.items.next()?.ok()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.left)
    }
}

impl<I, T, E> FusedIterator for Checked<I> where I: Iterator<Item = Result<T, E>> {}
