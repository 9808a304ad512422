use core::fmt::Write;
use core::iter::FusedIterator;

use crate::c_header::{
    ArrayValues, BYTE, Bytes, Dialect, Element, HeaderError, HeaderErrorKind, Layout, Name, WORD,
    WriteError, agree, array, check_size,
};
use crate::size_hint::size_of_rest;

/// One period of a 16-bit timer on the way to an edge of a pulse train.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "what the handler needs, no more")]
pub struct TimerPeriod {
    /// What the timer is loaded with; 0 stands for 65536 ticks.
    pub reload: u16,
    /// Whether the pin toggles when the period ends: not where an interval longer than the timer
    /// counts goes on.
    pub toggles: bool,
}

/// Writes the timer reloads of one axis as a C header.
///
/// ```
/// use pattern_codec::engraving::{ReloadData, ReloadHeader, TimerPeriod};
///
/// let periods = [(0xF00B, true), (0x1000, false), (0x1000, true)];
/// let periods = periods.map(|(reload, toggles)| TimerPeriod { reload, toggles });
/// let mut text = String::new();
/// ReloadHeader::new().write(periods, &mut text)?;
/// assert!(text.contains("unsigned int code reloads[3] = {\n  0xF00B, 0x1000, 0x1000\n};"));
/// assert!(text.contains("unsigned char code reloads_toggles[1] = {\n  0x05\n};"));
///
/// let data = ReloadData::read(&text, "reloads")?;
/// assert!(data.periods().eq(periods));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// Bit k of byte j of the second table says whether the pin toggles after period 8 j + k. `COUNT`
/// behind the name in upper case is the number of periods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ReloadHeader<'n> {
    name: Name<'n>,
    dialect: Dialect,
}

/// End of the name of the second table.
const TOGGLES: &str = "_toggles";

impl Default for ReloadHeader<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'n> ReloadHeader<'n> {
    /// The table `reloads` for C51.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            name: Name::fixed("reloads"),
            dialect: Dialect::C51,
        }
    }

    /// With another name of the table.
    #[must_use]
    pub const fn with_name(self, name: Name<'n>) -> Self {
        Self { name, ..self }
    }

    /// For another compiler.
    #[must_use]
    pub const fn with_dialect(self, dialect: Dialect) -> Self {
        Self { dialect, ..self }
    }

    /// Writes the header. The periods are gone through several times, because the totals stand
    /// first.
    ///
    /// # Errors
    /// [`WriteError`]: no periods, more bytes than an 8051 addresses, or the writer's error.
    pub fn write<I, W>(&self, periods: I, out: &mut W) -> Result<(), WriteError>
    where
        I: IntoIterator<Item = TimerPeriod>,
        I::IntoIter: Clone,
        W: Write,
    {
        let periods = periods.into_iter();
        let (mut count, mut edges) = (0_u64, 0_u64);
        for period in periods.clone() {
            count = count.saturating_add(1);
            edges = edges.saturating_add(period.toggles.into());
        }
        let toggle_bytes = count.div_ceil(8);
        let bytes = count.saturating_mul(2).saturating_add(toggle_bytes);
        check_size(bytes)?;
        let (name, dialect) = (self.name, self.dialect);
        writeln!(
            out,
            "/* {}: {count} timer periods, {edges} edges, {bytes} bytes. */",
            name.as_str()
        )?;
        let mut layout = Layout { name, dialect, out };
        layout.open_guard()?;
        layout.define("COUNT", count)?;
        layout.out.write_char('\n')?;
        layout.open_table(Element::UnsignedInt, "", count)?;
        rows(periods.clone(), layout.out, |period, out| {
            write!(out, "0x{:04X}", period.reload)
        })?;
        layout.close_table()?;
        layout.out.write_str(
            "\n/* Bit k of byte j: whether the pin toggles after period 8 j + k. */\n",
        )?;
        layout.open_table(Element::UnsignedChar, TOGGLES, toggle_bytes)?;
        rows(ToggleBytes(periods), layout.out, |byte, out| {
            write!(out, "0x{byte:02X}")
        })?;
        layout.close_table()?;
        Ok(layout.close_guard()?)
    }
}

/// Numbers, eight a row.
fn rows<T, W: Write>(
    numbers: impl Iterator<Item = T>,
    out: &mut W,
    write: impl Fn(T, &mut W) -> core::fmt::Result,
) -> core::fmt::Result {
    for (place, number) in numbers.enumerate() {
        out.write_str(match (place, place & 7) {
            (0, _) => "  ",
            (_, 0) => ",\n  ",
            _ => ", ",
        })?;
        write(number, out)?;
    }
    Ok(())
}

/// The second table.
struct ToggleBytes<I>(I);

impl<I: Iterator<Item = TimerPeriod>> Iterator for ToggleBytes<I> {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        let mut byte = u8::from(self.0.next()?.toggles);
        for (bit, period) in (1..8).zip(self.0.by_ref()) {
            byte |= u8::from(period.toggles).wrapping_shl(bit);
        }
        Some(byte)
    }
}

/// The timer reloads of a C header, checked as a whole when it is read.
///
/// The header may be one of [`ReloadHeader`] or written by hand; without the table of toggles the
/// pin toggles after every period. Reloads are -32768..=65535: -4096 and 0xF000 are the same.
#[derive(Debug, Clone)]
pub struct ReloadData<'t> {
    count: u64,
    reloads: ArrayValues<'t>,
    toggles: Option<Bytes<'t>>,
}

impl<'t> ReloadData<'t> {
    /// Reads the array of that name, and the one of that name and `_toggles`.
    ///
    /// # Errors
    /// [`HeaderError`] names a place and what is wrong there.
    pub fn read(text: &'t str, name: &str) -> Result<Self, HeaderError> {
        let (_, reloads) = array(text, Some((name, "")), WORD)?;
        let mut all = reloads.clone();
        let count = count(&mut all)?;
        agree(text, name, "COUNT", count)?;
        let toggles = match array(text, Some((name, TOGGLES)), BYTE) {
            Ok((_, toggles)) => Some(Bytes(toggles)),
            Err(error) if error.kind == HeaderErrorKind::NoArray => None,
            Err(error) => return Err(error),
        };
        if let Some(Bytes(toggles)) = &toggles {
            let mut all = toggles.clone();
            let bytes = self::count(&mut all)?;
            if bytes != count.div_ceil(8) {
                let shorten = |count| u32::try_from(count).unwrap_or(u32::MAX);
                return Err(all.place.error(HeaderErrorKind::ArrayLength {
                    values: shorten(bytes),
                    declared: shorten(count.div_ceil(8)),
                }));
            }
        }
        Ok(Self {
            count,
            reloads,
            toggles,
        })
    }

    /// The periods, straight from the text.
    pub fn periods(&self) -> TimerPeriods<'t> {
        TimerPeriods {
            data: self.clone(),
            byte: 0,
            bits: 0,
        }
    }
}

/// Goes through all values.
fn count(values: &mut ArrayValues<'_>) -> Result<u64, HeaderError> {
    let count = values
        .by_ref()
        .fold(0_u64, |count, _| count.saturating_add(1));
    values.error.map_or(Ok(count), Err)
}

/// The timer periods of a header, made by [`ReloadData::periods`].
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct TimerPeriods<'t> {
    data: ReloadData<'t>,
    /// What is left of a byte of the second table.
    byte: u8,
    bits: u8,
}

impl TimerPeriods<'_> {
    /// Periods still to come.
    #[must_use]
    pub const fn remaining(&self) -> u64 {
        self.data.count
    }

    fn toggles(&mut self) -> Option<bool> {
        let Some(toggles) = &mut self.data.toggles else {
            return Some(true);
        };
        if self.bits == 0 {
            self.byte = toggles.next()?;
            self.bits = 8;
        }
        let toggles = self.byte & 1 == 1;
        self.byte >>= 1;
        self.bits = self.bits.saturating_sub(1);
        Some(toggles)
    }
}

impl Iterator for TimerPeriods<'_> {
    type Item = TimerPeriod;

    fn next(&mut self) -> Option<TimerPeriod> {
        self.data.count = self.data.count.checked_sub(1)?;
        let [low, high, ..] = self.data.reloads.next()?.to_le_bytes();
        Some(TimerPeriod {
            reload: u16::from_le_bytes([low, high]),
            toggles: self.toggles()?,
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.data.count)
    }
}

impl FusedIterator for TimerPeriods<'_> {}
