//! Frames as a C header, `data.h`, and back.

use core::fmt::{self, Write};
use core::iter::FusedIterator;
use core::num::NonZeroU32;
use core::time::Duration;

use super::{Decoded, Packing, Sizes, Threshold, Timing};
use crate::c_header::{
    BYTE, Bytes, Checked, Dialect, Element, HeaderError, HeaderErrorKind, Layout, Source, Table,
    Value, WriteError,
};

/// Writes frames as a C header, `data.h`.
///
/// ```
/// use pattern_codec::dance::{Data, DataHeader, Packing};
///
/// let frames = [[60, -60, 0]; 25].into_iter().chain([[0; 3]]);
/// let mut text = String::new();
/// let header = DataHeader { packing: Packing::Runs, ..DataHeader::DEFAULT };
/// header.write(frames.clone(), &mut text)?;
/// assert!(text.contains("unsigned char code dance[8] = {\n  25, 0x3C, 0xC4, 0x00,\n"));
///
/// let data = Data::<3>::read(&text)?;
/// assert!(data.frames().eq(frames));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// The `#define`s, each after the name of the table in upper case: `MOTORS`, `FRAMES`,
/// `FRAME_TICKS`, `TICK_US`, `THRESHOLD`, `PACKING` (0 raw, 1 runs, 2 masked runs) and `BYTES`.
///
/// Raw frames are `signed char` in decimal numbers, eight a row for eight motors; runs are
/// `unsigned char`: the count in decimal, masks and speeds as two's complement in hex, one run a
/// row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "plain settings, to be written as a literal on top of the default"
)]
pub struct DataHeader<'n> {
    /// Name of the table, a C identifier of at most 31 characters.
    pub name: &'n str,
    /// The compiler that reads it.
    pub dialect: Dialect,
    /// Tick and period of a frame.
    pub timing: Timing,
    /// Threshold of the accumulators.
    pub threshold: Threshold,
    /// How the frames are stored.
    pub packing: Packing,
}

impl Default for DataHeader<'_> {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl DataHeader<'_> {
    /// The table `dance` for C51, raw frames of 200 ms, for a threshold of 600.
    pub const DEFAULT: Self = Self {
        name: "dance",
        dialect: Dialect::C51,
        timing: Timing::DEFAULT,
        threshold: Threshold::DEFAULT,
        packing: Packing::Raw,
    };

    /// Writes the header. The frames are gone through several times, because the totals stand
    /// first.
    ///
    /// # Errors
    /// [`WriteError`]: a name that C does not take, no frames, more bytes than an 8051 addresses,
    /// or the writer's error.
    pub fn write<const N: usize, I, W>(&self, frames: I, out: &mut W) -> Result<(), WriteError>
    where
        I: IntoIterator<Item = [i8; N]>,
        I::IntoIter: Clone,
        W: Write,
    {
        let Self {
            name,
            dialect,
            timing,
            threshold,
            packing,
        } = *self;
        let frames = frames.into_iter();
        let sizes = Sizes::of(frames.clone());
        let (count, bytes) = (sizes.frames(), sizes.bytes(packing));
        let duration = Duration::from_micros(timing.frame_us().saturating_mul(count));
        let [raw, runs, masked] = Packing::ALL.map(|packing| sizes.bytes(packing));
        let comment = format_args!(
            "{count} frames of {N} motors, {} ms.\n   \
             Bytes: {raw} raw, {runs} as runs, {masked} as masked runs; here {}.",
            duration.as_millis(),
            packing.name()
        );
        let defines = [
            ("MOTORS", N as u64),
            ("FRAMES", count),
            ("FRAME_TICKS", timing.frame_ticks().into()),
            ("TICK_US", timing.tick_us().into()),
            ("THRESHOLD", threshold.get().into()),
            ("PACKING", number(packing)),
            ("BYTES", bytes),
        ];
        let (element, each_row) = match packing {
            Packing::Raw => (Element::SignedChar, "the speeds of one frame"),
            Packing::Runs => (Element::UnsignedChar, "count of frames, their speeds"),
            Packing::MaskedRuns => (
                Element::UnsignedChar,
                "count of frames, mask, speeds of the motors in the mask",
            ),
        };
        let values = packing.rows(frames).flat_map(|row| {
            row.enumerate().map(move |(index, byte)| match packing {
                Packing::Raw => (index == 0, Value::Signed(byte.cast_signed())),
                _ if index == 0 => (true, Value::Count(byte)),
                _ => (false, Value::Byte(byte)),
            })
        });
        let table = |layout: &mut Layout<'_, '_, W>| {
            layout.comment(format_args!("Each row: {each_row}."))?;
            layout.table(element, "", bytes, values)
        };
        Table { name, dialect }.write(bytes, comment, &defines, table, out)
    }
}

const fn number(packing: Packing) -> u64 {
    match packing {
        Packing::Raw => 0,
        Packing::Runs => 1,
        Packing::MaskedRuns => 2,
    }
}

/// What the `#define`s of a header say of its frames.
#[derive(Debug, Clone, Copy)]
struct FrameFormat {
    timing: Timing,
    threshold: Threshold,
    packing: Packing,
}

impl FrameFormat {
    fn read(source: &Source<'_>) -> Result<Self, HeaderError> {
        let period = |end, default| {
            let range = (1, u32::MAX.into());
            let parse = |value| NonZeroU32::new(u32::try_from(value).ok()?);
            source.setting(end, default, range, parse)
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
            threshold: source.setting("THRESHOLD", Threshold::DEFAULT, range, threshold)?,
            packing: source.setting("PACKING", Packing::Raw, (0, 2), packing)?,
        })
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
/// [`Timing::default`] and are for a threshold of 600. `MOTORS`, `FRAMES` and `BYTES` must agree
/// with the table. Values are -128..=255: 196 and -60 are the same byte.
#[derive(Debug, Clone)]
pub struct Data<'t, const N: usize = 8> {
    name: &'t str,
    format: FrameFormat,
    bytes: u64,
    frames: Checked<Decoded<Bytes<'t>, N>>,
}

impl<'t, const N: usize> Data<'t, N> {
    /// Reads a header with one array.
    ///
    /// # Errors
    /// [`HeaderError`] names a location and what is wrong there.
    pub fn read(text: &'t str) -> Result<Self, HeaderError> {
        Self::find(text, None)
    }

    /// Reads the array of that name; there may be others.
    ///
    /// # Errors
    /// As [`Data::read`].
    pub fn read_array(text: &'t str, name: &str) -> Result<Self, HeaderError> {
        Self::find(text, Some(name))
    }

    fn find(text: &'t str, wanted: Option<&str>) -> Result<Self, HeaderError> {
        let (source, values) = Source::find(text, wanted, BYTE)?;
        let format = FrameFormat::read(&source)?;
        let (frames, at_end) = Checked::new(
            format.packing.decode(Bytes(values)),
            |decoded| &decoded.bytes().0,
            |error| HeaderErrorKind::Frames(error.kind),
        )?;
        let bytes = at_end.offset();
        source.agree("MOTORS", N as u64)?;
        source.agree("FRAMES", frames.left())?;
        source.agree("BYTES", bytes)?;
        Ok(Self {
            name: source.name,
            format,
            bytes,
            frames,
        })
    }

    /// The name of the array.
    #[must_use]
    pub const fn name(&self) -> &'t str {
        self.name
    }

    /// Tick and period of a frame.
    #[must_use]
    pub const fn timing(&self) -> Timing {
        self.format.timing
    }

    /// Threshold of the accumulators.
    #[must_use]
    pub const fn threshold(&self) -> Threshold {
        self.format.threshold
    }

    /// How the frames are stored.
    #[must_use]
    pub const fn packing(&self) -> Packing {
        self.format.packing
    }

    /// Bytes of the table.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The number of frames.
    #[must_use]
    pub const fn frame_count(&self) -> u64 {
        self.frames.left()
    }

    /// The frames, straight from the text.
    #[must_use]
    pub fn frames(&self) -> impl FusedIterator<Item = [i8; N]> + Clone + fmt::Debug + use<'t, N> {
        self.frames.clone()
    }
}
