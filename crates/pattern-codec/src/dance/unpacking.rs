//! Bytes to frames, for every packing.

use core::iter::FusedIterator;

use thiserror::Error;

use super::Packing;

impl Packing {
    /// The frames of bytes.
    ///
    /// Longer forms than [`Packing::encode`] writes are read as well: runs that could be one,
    /// speeds that do not change.
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

/// The masks of runs that have the speed of every motor.
const ALL: [u8; 32] = [0xFF; 32];

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
                self.speeds(Some(first), ALL)?;
                return Ok(Some(1));
            }
            Packing::Runs => self.speeds(None, ALL)?,
            Packing::MaskedRuns => {
                let masks = self.masks()?;
                self.speeds(None, masks)?;
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

    /// The speeds of the motors in the masks, the first of them perhaps read already.
    fn speeds(&mut self, mut first: Option<u8>, masks: [u8; 32]) -> Result<(), DecodeErrorKind> {
        let mut frame = self.frame;
        for (speeds, mask) in frame.chunks_mut(8).zip(masks) {
            for (bit, speed) in (0..8).zip(speeds) {
                if mask >> bit & 1 == 1 {
                    let byte = first.take().or_else(|| self.byte());
                    let byte = byte.ok_or(DecodeErrorKind::Truncated)?;
                    *speed = byte.cast_signed();
                }
            }
        }
        self.frame = frame;
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
