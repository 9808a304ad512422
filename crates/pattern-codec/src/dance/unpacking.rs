//! Bytes to frames, for every packing.

use core::iter::FusedIterator;

use thiserror::Error;

use super::Packing;

impl Packing {
    /// The frames of bytes.
    ///
    /// What [`Packing::encode`] would write in another way is read all the same: runs that could be
    /// one, speeds that do not change.
    ///
    /// ```
    /// use pattern_codec::dance::Packing;
    ///
    /// let frames = Packing::MaskedRuns.decode::<3, _>([2, 0b011, 60, 0xC4, 1, 0b100, 5]);
    /// let frames: Vec<_> = frames.collect::<Result<_, _>>()?;
    /// assert_eq!(frames, [[60, -60, 0], [60, -60, 0], [60, -60, 5]]);
    /// # Ok::<(), pattern_codec::dance::DecodeError>(())
    /// ```
    pub fn decode<const N: usize, I>(self, bytes: I) -> Decoded<I::IntoIter, N>
    where
        I: IntoIterator<Item = u8>,
    {
        const { assert!(N > 0 && N < 256, "1..=255 motors") };
        Decoded {
            packing: self,
            bytes: bytes.into_iter(),
            offset: 0,
            frame: [0; N],
            left: 0,
            failed: false,
        }
    }
}

/// The frames of bytes, made by [`Packing::decode`]. It ends after the first error.
#[derive(Debug, Clone)]
#[must_use = "iterators are lazy"]
pub struct Decoded<I, const N: usize> {
    packing: Packing,
    bytes: I,
    offset: u64,
    frame: [i8; N],
    /// Frames still to come of the run.
    left: u8,
    failed: bool,
}

impl<I: Iterator<Item = u8>, const N: usize> Decoded<I, N> {
    /// Bytes read so far.
    pub(super) const fn offset(&self) -> u64 {
        self.offset
    }

    pub(super) const fn bytes(&self) -> &I {
        &self.bytes
    }

    /// The next run; `None` at the end of the bytes.
    fn run(&mut self) -> Result<Option<u8>, DecodeErrorKind> {
        let Some(first) = self.byte() else {
            return Ok(None);
        };
        match self.packing {
            Packing::Raw => {
                self.speeds(Some(first), |_| true)?;
                return Ok(Some(1));
            }
            Packing::Runs => self.speeds(None, |_| true)?,
            Packing::MaskedRuns => {
                let masks = self.masks()?;
                let in_mask = |motor: usize| {
                    let mask = masks.get(motor >> 3).copied().unwrap_or(0);
                    mask >> (motor & 7) & 1 == 1
                };
                self.speeds(None, in_mask)?;
            }
        }
        match first {
            0 => Err(DecodeErrorKind::ZeroCount),
            count => Ok(Some(count)),
        }
    }

    /// The mask bytes; the rest of the array is zero.
    fn masks(&mut self) -> Result<[u8; 32], DecodeErrorKind> {
        let mut masks = [0; 32];
        for (first, mask) in (0..N).step_by(8).zip(&mut masks) {
            *mask = self.byte().ok_or(DecodeErrorKind::Truncated)?;
            let motors = N.saturating_sub(first);
            if motors < 8 && *mask >> motors != 0 {
                let mask = *mask;
                return Err(DecodeErrorKind::Mask { mask, motors });
            }
        }
        Ok(masks)
    }

    /// The speeds of the motors that have one in the run, the first of them perhaps read already.
    fn speeds(
        &mut self,
        mut first: Option<u8>,
        has_one: impl Fn(usize) -> bool,
    ) -> Result<(), DecodeErrorKind> {
        for motor in (0..N).filter(|motor| has_one(*motor)) {
            let byte = first.take().or_else(|| self.byte());
            let byte = byte.ok_or(DecodeErrorKind::Truncated)?;
            if let Some(speed) = self.frame.get_mut(motor) {
                *speed = byte.cast_signed();
            }
        }
        Ok(())
    }

    fn byte(&mut self) -> Option<u8> {
        let byte = self.bytes.next()?;
        self.offset = self.offset.saturating_add(1);
        Some(byte)
    }
}

impl<I: Iterator<Item = u8>, const N: usize> Iterator for Decoded<I, N> {
    type Item = Result<[i8; N], DecodeError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        if self.left == 0 {
            let offset = self.offset;
            match self.run() {
                Ok(count) => self.left = count?,
                Err(kind) => {
                    self.failed = true;
                    return Some(Err(DecodeError { offset, kind }));
                }
            }
        }
        self.left = self.left.saturating_sub(1);
        Some(Ok(self.frame))
    }
}

impl<I: FusedIterator<Item = u8>, const N: usize> FusedIterator for Decoded<I, N> {}

/// Bytes that are no frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("dance byte {offset}: {kind}")]
#[non_exhaustive]
pub struct DecodeError {
    /// Offset of the first byte of the frame or run.
    pub offset: u64,
    /// Why.
    pub kind: DecodeErrorKind,
}

/// Why bytes are no frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DecodeErrorKind {
    /// The bytes end within a frame or run.
    #[error("the last frame or run is cut off")]
    Truncated,
    /// A run of no frames.
    #[error("a run of 0 frames")]
    ZeroCount,
    /// A mask with bits of motors that are not there.
    #[error("mask {mask:#04X} names more than the {motors} motors of its byte")]
    Mask {
        /// The mask byte.
        mask: u8,
        /// Motors of this byte.
        motors: usize,
    },
}
