//! Many motors on one data bus, each through a transparent latch.

use core::iter::FusedIterator;
use thiserror::Error;

/// One state of the bus: the data, and the strobe that is high, if any. Two strobes are never high
/// at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::exhaustive_structs,
    reason = "data and strobe are all of the bus"
)]
pub struct BusWrite {
    /// Data lines.
    pub data: u8,
    /// Index of the latch whose strobe is high; `None` when all hold.
    pub strobe: Option<usize>,
}

/// Iterator of the writes that bring new bytes into latches: for each, the data, the strobe up, the
/// strobe down.
///
/// A latch of the 74373 kind follows the data while its strobe is high. The data therefore changes
/// only while all strobes are low: it is written before the strobe rises and stays until it has
/// fallen. [`Latches`] tests just that. Source: \[Dancer\].
///
/// # Examples
/// ```
/// use motor_phases::{BusWrite, LatchWrites};
/// // Latch 1 keeps its byte.
/// let writes = LatchWrites::new([Some(3), None, Some(12)]);
/// assert!(writes.map(|write| (write.data, write.strobe)).eq([
///     (3, None),
///     (3, Some(0)),
///     (3, None),
///     (12, None),
///     (12, Some(2)),
///     (12, None),
/// ]));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "iterators are lazy"]
pub struct LatchWrites<const N: usize> {
    bytes: [Option<u8>; N],
    latch: usize,
    // Writes made of the three for `latch`.
    made: u8,
}

impl<const N: usize> LatchWrites<N> {
    /// The writes for a byte per latch, in order; `None` leaves a latch as it is.
    pub const fn new(bytes: [Option<u8>; N]) -> Self {
        Self {
            bytes,
            latch: 0,
            made: 0,
        }
    }
}

impl<const N: usize> Iterator for LatchWrites<N> {
    type Item = BusWrite;

    #[inline]
    fn next(&mut self) -> Option<BusWrite> {
        let (latch, data) = loop {
            match *self.bytes.get(self.latch)? {
                Some(data) => break (self.latch, data),
                None => self.latch = self.latch.wrapping_add(1),
            }
        };
        let strobe = (self.made == 1).then_some(latch);
        self.made = self.made.wrapping_add(1);
        if self.made == 3 {
            self.made = 0;
            self.latch = latch.wrapping_add(1);
        }
        Some(BusWrite { data, strobe })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.bytes.iter().skip(self.latch).flatten().count();
        // At most 3 N, for arrays that fit the memory.
        let writes = left
            .saturating_mul(3)
            .saturating_sub(usize::from(self.made));
        (writes, Some(writes))
    }
}

impl<const N: usize> ExactSizeIterator for LatchWrites<N> {}

impl<const N: usize> FusedIterator for LatchWrites<N> {}

/// A write that would spoil a latch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum BusError {
    /// The data changed with the strobe high: the latch passes on what it should not.
    #[error("data {before:#04x} became {after:#04x} under the high strobe {latch}")]
    DataUnderStrobe {
        /// Index of the open latch.
        latch: usize,
        /// Data before.
        before: u8,
        /// Data after.
        after: u8,
    },
    /// A strobe that no latch has.
    #[error("strobe {latch} of {latches} latches")]
    NoSuchLatch {
        /// Index given.
        latch: usize,
        /// Number of latches.
        latches: usize,
    },
}

/// N transparent latches as the motors see them: for a simulation, or to check a program's writes.
///
/// # Examples
/// ```
/// use motor_phases::{BusError, BusWrite, Latches};
/// let mut latches = Latches::<8>::new();
/// latches.write(BusWrite { data: 9, strobe: None })?;
/// latches.write(BusWrite { data: 9, strobe: Some(7) })?;
/// assert_eq!(latches.outputs()[7], 9);
/// let wrong = latches.write(BusWrite { data: 1, strobe: Some(7) });
/// assert_eq!(wrong, Err(BusError::DataUnderStrobe { latch: 7, before: 9, after: 1 }));
/// # Ok::<(), BusError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Latches<const N: usize> {
    outputs: [u8; N],
    bus: BusWrite,
}

impl<const N: usize> Latches<N> {
    /// Latches and bus all zero, every strobe low.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            outputs: [0; N],
            bus: BusWrite {
                data: 0,
                strobe: None,
            },
        }
    }

    /// What the latches hold or pass on.
    #[must_use]
    pub const fn outputs(&self) -> [u8; N] {
        self.outputs
    }

    /// Takes one state of the bus.
    ///
    /// # Errors
    /// [`BusError::DataUnderStrobe`] when the data changes in a write before or after which a
    /// strobe is high; [`BusError::NoSuchLatch`]. Bus and latches are then as before.
    pub fn write(&mut self, write: BusWrite) -> Result<(), BusError> {
        if let Some(latch) = self.bus.strobe.or(write.strobe)
            && write.data != self.bus.data
        {
            return Err(BusError::DataUnderStrobe {
                latch,
                before: self.bus.data,
                after: write.data,
            });
        }
        if let Some(latch) = write.strobe {
            let output = self
                .outputs
                .get_mut(latch)
                .ok_or(BusError::NoSuchLatch { latch, latches: N })?;
            *output = write.data;
        }
        self.bus = write;
        Ok(())
    }
}

impl<const N: usize> Default for Latches<N> {
    fn default() -> Self {
        Self::new()
    }
}
