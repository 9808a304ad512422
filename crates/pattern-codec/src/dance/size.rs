//! Bytes of each packing, and whether they fit into a program memory.

use core::fmt;

use super::Packing;

/// How many bytes frames take.
///
/// ```
/// use pattern_codec::dance::{Packing, ProgramMemory, Sizes};
///
/// let five_minutes = (0..1500).map(|frame| [if frame < 25 { 60 } else { 0 }; 8]);
/// let sizes = Sizes::of(five_minutes);
/// assert_eq!((sizes.frames(), sizes.bytes(Packing::Raw)), (1500, 12_000));
/// assert_eq!(sizes.bytes(Packing::Runs), 9 * 7);
/// assert_eq!(sizes.bytes(Packing::MaskedRuns), 10 + 10 + 2 * 5);
///
/// let memory = ProgramMemory::AT89C52;
/// assert_eq!(
///     memory.fit(sizes.bytes(Packing::Raw), 1200).to_string(),
///     "12000 bytes of data and 1200 of code do not fit into 8192 bytes: 5008 too many"
/// );
/// assert!(memory.fit(sizes.bytes(Packing::Runs), 1200).fits());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sizes {
    frames: u64,
    raw: u64,
    runs: u64,
    masked_runs: u64,
}

impl Sizes {
    /// Counts frames.
    pub fn of<const N: usize, I>(frames: I) -> Self
    where
        I: IntoIterator<Item = [i8; N]>,
        I::IntoIter: Clone,
    {
        let frames = frames.into_iter();
        let count = |packing: Packing| count_items(packing.encode(frames.clone()));
        let total = count_items(frames.clone());
        Self {
            frames: total,
            raw: total.saturating_mul(N as u64),
            runs: count(Packing::Runs),
            masked_runs: count(Packing::MaskedRuns),
        }
    }

    /// Frames.
    #[must_use]
    pub const fn frames(&self) -> u64 {
        self.frames
    }

    /// Bytes of a packing.
    #[must_use]
    pub const fn bytes(&self, packing: Packing) -> u64 {
        match packing {
            Packing::Raw => self.raw,
            Packing::Runs => self.runs,
            Packing::MaskedRuns => self.masked_runs,
        }
    }

    /// The packing of the fewest bytes, the simplest of them.
    #[must_use]
    pub fn smallest(&self) -> Packing {
        let shorter = |a, b| if self.bytes(b) < self.bytes(a) { b } else { a };
        shorter(shorter(Packing::Raw, Packing::Runs), Packing::MaskedRuns)
    }
}

/// The number of items.
fn count_items<I: Iterator>(items: I) -> u64 {
    items.fold(0, |count, _| count.saturating_add(1))
}

/// The program memory of a microcontroller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "a size and nothing else")]
pub struct ProgramMemory {
    /// Its size in bytes.
    pub bytes: u64,
}

impl ProgramMemory {
    /// 4 KiB.
    pub const AT89C51: Self = Self { bytes: 4096 };
    /// 8 KiB.
    pub const AT89C52: Self = Self { bytes: 8192 };

    /// Whether the memory holds data and code, both in bytes.
    #[must_use]
    pub const fn fit(self, data_bytes: u64, code_bytes: u64) -> Fit {
        Fit {
            memory_bytes: self.bytes,
            data_bytes,
            code_bytes,
        }
    }
}

/// Data and code in a program memory; its text says whether they fit and what is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Fit {
    /// Bytes of the memory.
    pub memory_bytes: u64,
    /// Bytes of data.
    pub data_bytes: u64,
    /// Bytes of code.
    pub code_bytes: u64,
}

impl Fit {
    /// Whether the memory holds both.
    #[must_use]
    pub fn fits(&self) -> bool {
        self.too_many() == 0
    }

    /// Bytes that do not fit.
    fn too_many(&self) -> u128 {
        let used = u128::from(self.data_bytes).saturating_add(self.code_bytes.into());
        used.saturating_sub(self.memory_bytes.into())
    }
}

impl fmt::Display for Fit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            memory_bytes,
            data_bytes,
            code_bytes,
        } = self;
        write!(f, "{data_bytes} bytes of data and {code_bytes} of code ")?;
        match self.too_many() {
            0 => {
                // They fit, so the differences do, too.
                let left = memory_bytes
                    .wrapping_sub(*data_bytes)
                    .wrapping_sub(*code_bytes);
                write!(f, "fit into {memory_bytes} bytes: {left} left")
            }
            over => write!(f, "do not fit into {memory_bytes} bytes: {over} too many"),
        }
    }
}
