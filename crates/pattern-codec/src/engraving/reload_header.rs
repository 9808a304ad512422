//! The timer reloads of an axis as a C header, and back.

use core::convert::Infallible;
use core::fmt::{self, Write};
use core::iter::FusedIterator;

use crate::c_header::{
    ArrayValues, BYTE, Bytes, Checked, Dialect, Element, HeaderError, HeaderErrorKind, Layout,
    Source, Table, Value, WORD, WriteError,
};

/// One period of a 16-bit timer; the last of those before an edge of a pulse train toggles the pin.
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
/// ReloadHeader::DEFAULT.write(periods, &mut text)?;
/// assert!(text.contains("unsigned int code reloads[3] = {\n  0xF00B, 0x1000, 0x1000\n};"));
/// assert!(text.contains("unsigned char code reloads_toggles[1] = {\n  0x05\n};"));
///
/// let data = ReloadData::read(&text, "reloads")?;
/// assert!(data.periods().eq(periods));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// Bit k of byte j of the second table says whether the pin toggles after period 8 j + k. `COUNT`
/// after the name in upper case is the number of periods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "plain settings, to be written as a literal on top of the default"
)]
pub struct ReloadHeader<'n> {
    /// Name of the table, a C identifier of at most 31 characters.
    pub name: &'n str,
    /// The compiler that reads it.
    pub dialect: Dialect,
}

/// End of the name of the second table.
const TOGGLES: &str = "_toggles";

impl Default for ReloadHeader<'_> {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl ReloadHeader<'_> {
    /// The table `reloads` for C51.
    pub const DEFAULT: Self = Self {
        name: "reloads",
        dialect: Dialect::C51,
    };

    /// Writes the header. The periods are gone through several times, because the totals stand
    /// first.
    ///
    /// # Errors
    /// [`WriteError`]: a name that C does not take, no periods, more bytes than an 8051 addresses,
    /// or the writer's error.
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
        let comment = format_args!("{count} timer periods, {edges} edges, {bytes} bytes.");
        let reloads = periods.clone().map(|period| Value::Word(period.reload));
        let toggles = ToggleBytes(periods).map(Value::Byte);
        let tables = |layout: &mut Layout<'_, '_, W>| {
            layout.empty_line()?;
            layout.table(Element::UnsignedInt, "", count, rows(reloads))?;
            layout.comment(format_args!(
                "Bit k of byte j: whether the pin toggles after period 8 j + k."
            ))?;
            layout.table(Element::UnsignedChar, TOGGLES, toggle_bytes, rows(toggles))
        };
        let Self { name, dialect } = *self;
        Table { name, dialect }.write(bytes, comment, &[("COUNT", count)], tables, out)
    }
}

/// Values, eight a row.
fn rows(values: impl Iterator<Item = Value>) -> impl Iterator<Item = (bool, Value)> {
    let numbered = values.enumerate();
    numbered.map(|(index, value)| (index & 7 == 0, value))
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
    periods: Checked<TablePeriods<'t>>,
}

impl<'t> ReloadData<'t> {
    /// Reads the array of that name, and the one of that name and `_toggles`.
    ///
    /// # Errors
    /// [`HeaderError`] names a location and what is wrong there.
    pub fn read(text: &'t str, name: &str) -> Result<Self, HeaderError> {
        let (source, reloads) = Source::find(text, Some(name), WORD)?;
        let count = reloads.clone().count_all()?;
        source.agree("COUNT", count)?;
        let toggles = match source.second_array(TOGGLES, BYTE) {
            Ok(toggles) => {
                check_toggles(toggles.clone(), count.div_ceil(8))?;
                Some(Bytes(toggles))
            }
            Err(error) if error.kind == HeaderErrorKind::NoArray => None,
            Err(error) => return Err(error),
        };
        let periods = TablePeriods {
            reloads,
            toggles,
            byte: 0,
            bits: 0,
        };
        Ok(Self {
            periods: Checked::known(periods, count),
        })
    }

    /// The number of periods.
    #[must_use]
    pub const fn period_count(&self) -> u64 {
        self.periods.left()
    }

    /// The periods, straight from the text.
    #[must_use]
    pub fn periods(&self) -> impl FusedIterator<Item = TimerPeriod> + Clone + fmt::Debug + use<'t> {
        self.periods.clone()
    }
}

/// Refuses another number of toggle bytes than the reloads need.
fn check_toggles(mut toggles: ArrayValues<'_>, wanted: u64) -> Result<(), HeaderError> {
    let bytes = toggles.count_all()?;
    if bytes == wanted {
        return Ok(());
    }
    Err(toggles.location.error(HeaderErrorKind::ArrayLength {
        values: bytes,
        declared: wanted,
    }))
}

/// The timer periods of both arrays.
#[derive(Debug, Clone)]
struct TablePeriods<'t> {
    reloads: ArrayValues<'t>,
    toggles: Option<Bytes<'t>>,
    /// What is left of a byte of the second table.
    byte: u8,
    bits: u8,
}

impl TablePeriods<'_> {
    fn toggles(&mut self) -> Option<bool> {
        let Some(toggles) = &mut self.toggles else {
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

impl Iterator for TablePeriods<'_> {
    type Item = Result<TimerPeriod, Infallible>;

    fn next(&mut self) -> Option<Self::Item> {
        let [low, high, ..] = self.reloads.next()?.to_le_bytes();
        let reload = u16::from_le_bytes([low, high]);
        let toggles = self.toggles()?;
        Some(Ok(TimerPeriod { reload, toggles }))
    }
}
