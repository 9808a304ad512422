use thiserror::Error;

use super::header::{Checksum, HEADER_LEN, Header, HeaderError, TRAILER_LEN};

/// Checks a whole container and gives access to it.
///
/// ```
/// use pattern_codec::container::{Content, open};
///
/// let bytes = [
///     0x89, 0x50, 0x32, 0x50, 1, 1, 0xE4, 0, 0, 0, 0, 3, // fields
///     0x9E, 0x50, 0x5E, 0x4D, // their CRC-32
///     0x02, 0x0F, 0x9E, // one record
///     0x5B, 0xFB, 0x90, 0xD3, // CRC-32
/// ];
/// let container = open(&bytes)?;
/// let Content::Engraving(format) = container.header().content() else { panic!() };
/// assert_eq!(format.records(container.payload()).count(), 1);
/// # Ok::<(), pattern_codec::container::ContainerError>(())
/// ```
///
/// # Errors
/// [`ContainerError`], with the reason, for anything but one whole undamaged container.
pub fn open(bytes: &[u8]) -> Result<Container<'_>, ContainerError> {
    let mut verifier = Verifier::new();
    verifier.update(bytes)?;
    let header = verifier.finish()?;
    let payload = bytes
        .split_first_chunk::<HEADER_LEN>()
        .and_then(|(_, rest)| rest.split_last_chunk::<TRAILER_LEN>())
        .map_or([].as_slice(), |(payload, _)| payload);
    Ok(Container { header, payload })
}

/// A container that was found whole, made by [`open`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Container<'a> {
    header: Header,
    payload: &'a [u8],
}

impl<'a> Container<'a> {
    /// What the container says about its payload.
    #[must_use]
    pub const fn header(&self) -> Header {
        self.header
    }

    /// The payload.
    #[must_use]
    pub const fn payload(&self) -> &'a [u8] {
        self.payload
    }
}

/// Checks a container that arrives in chunks of any size, in constant memory.
///
/// Feed the whole file, then [`Verifier::finish`]; only then read the payload once more, from
/// offset [`HEADER_LEN`] on, and decode it with a
/// [`Decoder`](crate::engraving::Decoder). An error is final: every later call repeats it.
#[derive(Debug, Clone)]
pub struct Verifier {
    stage: Stage,
}

#[derive(Debug, Clone)]
enum Stage {
    Header(Fill<HEADER_LEN>),
    Body(Body),
    Failed(ContainerError),
}

impl Default for Verifier {
    fn default() -> Self {
        Self::new()
    }
}

impl Verifier {
    /// A verifier at the first byte of the header.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            stage: Stage::Header(Fill::new()),
        }
    }

    /// Checks the next bytes of the container.
    ///
    /// # Errors
    /// [`ContainerError`] as soon as it is certain that the container will be refused.
    pub fn update(&mut self, mut bytes: &[u8]) -> Result<(), ContainerError> {
        if let Stage::Header(fill) = &mut self.stage {
            let Some(header) = fill.complete(&mut bytes) else {
                return Ok(());
            };
            self.stage = match Header::decode(&header) {
                Ok((header, checksum)) => Stage::Body(Body::new(header, checksum)),
                Err(error) => Stage::Failed(error.into()),
            };
        }
        if let Stage::Body(body) = &mut self.stage
            && let Err(error) = body.update(bytes)
        {
            self.stage = Stage::Failed(error);
        }
        match self.stage {
            Stage::Failed(error) => Err(error),
            Stage::Header(_) | Stage::Body(_) => Ok(()),
        }
    }

    /// Ends the container: its header, when all of it was there and undamaged.
    ///
    /// # Errors
    /// [`ContainerError::Truncated`] when bytes are missing; the error of
    /// [`Verifier::update`], if there was one.
    pub fn finish(self) -> Result<Header, ContainerError> {
        match self.stage {
            Stage::Failed(error) => Err(error),
            Stage::Body(body) => body.finish(),
            Stage::Header(fill) => Err(ContainerError::Truncated {
                expected: HEADER_LEN as u64,
                found: u64::from(fill.len),
            }),
        }
    }
}

/// Payload and trailer under way.
#[derive(Debug, Clone)]
struct Body {
    header: Header,
    checksum: Checksum,
    /// Bytes of the payload still to come.
    remaining: u32,
    trailer: Fill<TRAILER_LEN>,
}

impl Body {
    const fn new(header: Header, checksum: Checksum) -> Self {
        Self {
            header,
            checksum,
            remaining: header.payload_len(),
            trailer: Fill::new(),
        }
    }

    fn update(&mut self, bytes: &[u8]) -> Result<(), ContainerError> {
        let wanted = usize::try_from(self.remaining).unwrap_or(usize::MAX);
        let (payload, mut rest) = bytes.split_at_checked(wanted).unwrap_or((bytes, &[]));
        self.checksum.update(payload);
        let taken = u32::try_from(payload.len()).unwrap_or(u32::MAX);
        self.remaining = self.remaining.saturating_sub(taken);
        if rest.is_empty() {
            return Ok(());
        }
        if let Some(stored) = self.trailer.complete(&mut rest) {
            let stored = u32::from_be_bytes(stored);
            let computed = self.checksum.value();
            if stored != computed {
                return Err(ContainerError::Damaged { stored, computed });
            }
        }
        if rest.is_empty() {
            Ok(())
        } else {
            Err(ContainerError::TrailingBytes {
                expected: self.container_len(),
            })
        }
    }

    fn finish(self) -> Result<Header, ContainerError> {
        let expected = self.container_len();
        let missing_trailer = (TRAILER_LEN as u64).saturating_sub(u64::from(self.trailer.len));
        let missing = u64::from(self.remaining).saturating_add(missing_trailer);
        if missing == 0 {
            return Ok(self.header);
        }
        Err(ContainerError::Truncated {
            expected,
            found: expected.saturating_sub(missing),
        })
    }

    fn container_len(&self) -> u64 {
        const AROUND: u64 = (HEADER_LEN + TRAILER_LEN) as u64;
        u64::from(self.header.payload_len()).saturating_add(AROUND)
    }
}

/// An array that is filled from several chunks.
#[derive(Debug, Clone)]
struct Fill<const N: usize> {
    bytes: [u8; N],
    len: u8,
}

impl<const N: usize> Fill<N> {
    const fn new() -> Self {
        Self {
            bytes: [0; N],
            len: 0,
        }
    }

    /// Takes bytes off the front of `input`; the array once it is full.
    fn complete(&mut self, input: &mut &[u8]) -> Option<[u8; N]> {
        for place in self.bytes.iter_mut().skip(self.len.into()) {
            let (byte, rest) = input.split_first()?;
            *place = *byte;
            *input = rest;
            self.len = self.len.saturating_add(1);
        }
        Some(self.bytes)
    }
}

/// Why a container was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ContainerError {
    /// The header is wrong.
    #[error(transparent)]
    Header(#[from] HeaderError),
    /// Bytes are missing at the end.
    #[error("truncated container: {found} of at least {expected} bytes")]
    Truncated {
        /// Length by the header, or of the header.
        expected: u64,
        /// Length found.
        found: u64,
    },
    /// The check value of the whole does not match.
    #[error(
        "damaged container: its CRC-32 is {computed:#010X}, but {stored:#010X} stands at its end"
    )]
    Damaged {
        /// The check value in the trailer.
        stored: u32,
        /// The check value of header and payload.
        computed: u32,
    },
    /// There is more behind the end.
    #[error("bytes follow the end of the container at byte {expected}")]
    TrailingBytes {
        /// Length by the header.
        expected: u64,
    },
}
