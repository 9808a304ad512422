use core::fmt::Write;
use core::iter::FusedIterator;
use core::num::NonZeroU32;

use super::{Decoded, Packing, Sizes, Threshold, Timing};
use crate::c_header::{
    BYTE, Bytes, Dialect, Element, HeaderError, HeaderErrorKind, Layout, Name, WriteError, agree,
    array, check_size, setting,
};
use crate::size_hint::size_of_rest;

/// Writes frames as a C header, `data.h`.
///
/// ```
/// use pattern_codec::dance::{Data, DataHeader, Packing};
///
/// let frames = [[60, -60, 0]; 25].into_iter().chain([[0; 3]]);
/// let mut text = String::new();
/// let header = DataHeader::new().with_packing(Packing::Runs);
/// header.write(frames.clone(), &mut text)?;
/// assert!(text.contains("unsigned char code dance[8] = {\n  25, 0x3C, 0xC4, 0x00,\n"));
///
/// let data = Data::<3>::read(&text)?;
/// assert!(data.frames().eq(frames));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// The `#define`s, each behind the name of the table in upper case: `MOTORS`, `FRAMES`,
/// `FRAME_TICKS`, `TICK_US`, `THRESHOLD`, `PACKING` (0 raw, 1 runs, 2 masked runs) and `BYTES`.
///
/// Raw frames are `signed char` in decimal numbers, eight a row for eight motors; runs are
/// `unsigned char`: the count in decimal, masks and speeds as two's complement in hex, one run a
/// row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DataHeader<'n> {
    name: Name<'n>,
    dialect: Dialect,
    timing: Timing,
    threshold: Threshold,
    packing: Packing,
}

impl Default for DataHeader<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'n> DataHeader<'n> {
    /// The table `dance` for C51, raw frames of 200 ms, for a threshold of 600.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            name: Name::fixed("dance"),
            dialect: Dialect::C51,
            timing: Timing::DEFAULT,
            threshold: Threshold::DEFAULT,
            packing: Packing::Raw,
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

    /// With another tick or frame.
    #[must_use]
    pub const fn with_timing(self, timing: Timing) -> Self {
        Self { timing, ..self }
    }

    /// For another threshold of the accumulators.
    #[must_use]
    pub const fn with_threshold(self, threshold: Threshold) -> Self {
        Self { threshold, ..self }
    }

    /// With another packing.
    #[must_use]
    pub const fn with_packing(self, packing: Packing) -> Self {
        Self { packing, ..self }
    }

    /// Writes the header. The frames are gone through several times, because the totals stand
    /// first.
    ///
    /// # Errors
    /// [`WriteError`]: no frames, more bytes than an 8051 addresses, or the writer's error.
    pub fn write<const N: usize, I, W>(&self, frames: I, out: &mut W) -> Result<(), WriteError>
    where
        I: IntoIterator<Item = [i8; N]>,
        I::IntoIter: Clone,
        W: Write,
    {
        let frames = frames.into_iter();
        let sizes = Sizes::of(frames.clone());
        let bytes = sizes.bytes(self.packing);
        check_size(bytes)?;
        self.totals::<N, W>(&sizes, out)?;
        let (name, dialect) = (self.name, self.dialect);
        let mut layout = Layout { name, dialect, out };
        layout.open_guard()?;
        layout.define("MOTORS", N as u64)?;
        layout.define("FRAMES", sizes.frames())?;
        layout.define("FRAME_TICKS", self.timing.frame_ticks().into())?;
        layout.define("TICK_US", self.timing.tick_us().into())?;
        layout.define("THRESHOLD", self.threshold.get().into())?;
        layout.define("PACKING", number(self.packing))?;
        layout.define("BYTES", bytes)?;
        layout.out.write_str(match self.packing {
            Packing::Raw => "\n/* Each row: the speeds of one frame. */\n",
            Packing::Runs => "\n/* Each row: count of frames, their speeds. */\n",
            Packing::MaskedRuns => {
                "\n/* Each row: count of frames, mask, speeds of the motors in the mask. */\n"
            }
        })?;
        layout.open_table(element(self.packing), "", bytes)?;
        self.rows(frames, layout.out)?;
        layout.close_table()?;
        Ok(layout.close_guard()?)
    }

    fn totals<const N: usize, W: Write>(
        &self,
        sizes: &Sizes,
        out: &mut W,
    ) -> Result<(), WriteError> {
        let frames = sizes.frames();
        let us = self.timing.frame_us().saturating_mul(frames);
        let ms = us.checked_div(1000).unwrap_or(0);
        let name = self.name.as_str();
        writeln!(out, "/* {name}: {frames} frames of {N} motors, {ms} ms.")?;
        let [raw, runs, masked] = Packing::ALL.map(|packing| sizes.bytes(packing));
        writeln!(
            out,
            "   Bytes: {raw} raw, {runs} as runs, {masked} as masked runs; here {}. */",
            self.packing.name()
        )?;
        Ok(())
    }

    fn rows<const N: usize, I, W>(&self, frames: I, out: &mut W) -> Result<(), WriteError>
    where
        I: Iterator<Item = [i8; N]>,
        W: Write,
    {
        let mut between_rows = "  ";
        for row in self.packing.rows(frames) {
            let mut between = between_rows;
            for (place, byte) in row.enumerate() {
                out.write_str(between)?;
                match (self.packing, place) {
                    (Packing::Raw, _) => write!(out, "{:4}", byte.cast_signed())?,
                    (_, 0) => write!(out, "{byte}")?,
                    _ => write!(out, "0x{byte:02X}")?,
                }
                between = ", ";
            }
            between_rows = ",\n  ";
        }
        Ok(())
    }
}

const fn number(packing: Packing) -> u64 {
    match packing {
        Packing::Raw => 0,
        Packing::Runs => 1,
        Packing::MaskedRuns => 2,
    }
}

const fn element(packing: Packing) -> Element {
    match packing {
        Packing::Raw => Element::SignedChar,
        Packing::Runs | Packing::MaskedRuns => Element::UnsignedChar,
    }
}

/// The frames of a C header, checked as a whole when it is read.
///
/// The header may be one of [`DataHeader`] or written by hand:
/// ```
/// use pattern_codec::dance::{Data, Packing, Timing};
///
/// let by_hand = "
///     #define STOP 0
///     signed code char Tango [] [4]={ {STOP,STOP , 60,-60}, // left turn
///         {0x3C, 0xC4, 0,0}, };";
/// let data = Data::<4>::read(by_hand)?;
/// assert_eq!((data.name(), data.packing()), ("Tango", Packing::Raw));
/// assert_eq!(data.timing(), Timing::default());
/// assert!(data.frames().eq([[0, 0, 60, -60], [60, -60, 0, 0]]));
/// # Ok::<(), pattern_codec::c_header::HeaderError>(())
/// ```
/// What its `#define`s say counts; without them frames are raw, have the period of
/// [`Timing::default`] and are for a threshold of 600. `MOTORS`, `FRAMES` and `BYTES` must agree with the table. Values are
/// -128..=255: 196 and -60 are the same byte.
#[derive(Debug, Clone)]
pub struct Data<'t, const N: usize = 8> {
    name: &'t str,
    timing: Timing,
    threshold: Threshold,
    packing: Packing,
    frames: u64,
    bytes: u64,
    table: Bytes<'t>,
}

impl<'t, const N: usize> Data<'t, N> {
    /// Reads a header with one array.
    ///
    /// # Errors
    /// [`HeaderError`] names a place and what is wrong there.
    pub fn read(text: &'t str) -> Result<Self, HeaderError> {
        Self::of(text, None)
    }

    /// Reads the array of that name; there may be others.
    ///
    /// # Errors
    /// As [`Data::read`].
    pub fn read_array(text: &'t str, name: &str) -> Result<Self, HeaderError> {
        Self::of(text, Some((name, "")))
    }

    fn of(text: &'t str, wanted: Option<(&str, &str)>) -> Result<Self, HeaderError> {
        let (name, values) = array(text, wanted, BYTE)?;
        let Settings {
            timing,
            threshold,
            packing,
        } = Settings::read(text, name)?;
        let table = Bytes(values);
        let mut data = Self {
            name,
            timing,
            threshold,
            packing,
            frames: 0,
            bytes: 0,
            table,
        };
        (data.frames, data.bytes) = data.check()?;
        agree(text, name, "MOTORS", N as u64)?;
        agree(text, name, "FRAMES", data.frames)?;
        agree(text, name, "BYTES", data.bytes)?;
        Ok(data)
    }

    /// Goes through all frames; counts them and their bytes.
    fn check(&self) -> Result<(u64, u64), HeaderError> {
        let mut decoded = self.packing.decode::<N, _>(self.table.clone());
        let mut frames = 0_u64;
        loop {
            let frame = decoded.next();
            let Bytes(values) = decoded.bytes();
            match (frame, values.error) {
                (_, Some(error)) => return Err(error),
                (Some(Err(error)), None) => {
                    return Err(values.place.error(HeaderErrorKind::Frames(error.kind)));
                }
                (Some(Ok(_)), None) => frames = frames.saturating_add(1),
                (None, None) => return Ok((frames, decoded.offset())),
            }
        }
    }

    /// The name of the array.
    #[must_use]
    pub const fn name(&self) -> &'t str {
        self.name
    }

    /// Tick and period of a frame.
    #[must_use]
    pub const fn timing(&self) -> Timing {
        self.timing
    }

    /// Threshold of the accumulators.
    #[must_use]
    pub const fn threshold(&self) -> Threshold {
        self.threshold
    }

    /// How the frames are stored.
    #[must_use]
    pub const fn packing(&self) -> Packing {
        self.packing
    }

    /// Bytes of the table.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The frames, straight from the text.
    pub fn frames(&self) -> Frames<'t, N> {
        Frames {
            decoded: self.packing.decode(self.table.clone()),
            left: self.frames,
        }
    }
}

/// What the `#define`s of a header say.
struct Settings {
    timing: Timing,
    threshold: Threshold,
    packing: Packing,
}

impl Settings {
    fn read(text: &str, name: &str) -> Result<Self, HeaderError> {
        let period = |end, default| {
            let range = (1, u32::MAX.into());
            let parse = |value| NonZeroU32::new(u32::try_from(value).ok()?);
            setting(text, name, end, default, range, parse)
        };
        let Timing {
            tick_us,
            frame_ticks,
        } = Timing::DEFAULT;
        let timing = Timing {
            tick_us: period("TICK_US", tick_us)?,
            frame_ticks: period("FRAME_TICKS", frame_ticks)?,
        };
        let range = (Threshold::MIN.get().into(), u16::MAX.into());
        let threshold = |value| Threshold::new(u16::try_from(value).ok()?).ok();
        let packing = |value| {
            let mut all = Packing::ALL.into_iter();
            all.find(|packing| u64::try_from(value) == Ok(number(*packing)))
        };
        Ok(Self {
            timing,
            threshold: setting(
                text,
                name,
                "THRESHOLD",
                Threshold::DEFAULT,
                range,
                threshold,
            )?,
            packing: setting(text, name, "PACKING", Packing::Raw, (0, 2), packing)?,
        })
    }
}

/// The frames of a header, made by [`Data::frames`].
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Frames<'t, const N: usize> {
    decoded: Decoded<Bytes<'t>, N>,
    left: u64,
}

impl<const N: usize> Frames<'_, N> {
    /// Frames still to come.
    #[must_use]
    pub const fn remaining(&self) -> u64 {
        self.left
    }
}

impl<const N: usize> Iterator for Frames<'_, N> {
    type Item = [i8; N];

    fn next(&mut self) -> Option<[i8; N]> {
        self.left = self.left.checked_sub(1)?;
        // No error comes: the text has been read once.
        self.decoded.next()?.ok()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        size_of_rest(self.left)
    }
}

impl<const N: usize> FusedIterator for Frames<'_, N> {}
