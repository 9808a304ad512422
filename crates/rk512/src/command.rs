//! Commands and their continuations.

mod error;

use core::fmt;

pub use error::{CommandError, RequestError};

use crate::area::{Area, AreaKind};
use crate::coordination::Coordination;
use crate::telegram::{COMMAND_HEADER, EncodeError, MAX_DATA, Part, SHORT_HEADER, Telegram};

/// What is asked for: bytes 3 and 4 of a command and of its continuations.
///
/// | request | byte 3 | byte 4 |
/// |---|---|---|
/// | SEND to a data block | `A` 41h | `D` 44h |
/// | SEND to an extended data block | `O` 4Fh | `D` 44h |
/// | FETCH | `E` 45h | [`AreaKind::code`] |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "RK512 has these three, no more")]
pub enum Request {
    /// Write to a data block, DB.
    SendDb,
    /// Write to an extended data block, DX.
    SendDx,
    /// Read from an area.
    Fetch(AreaKind),
}

impl Request {
    /// Bytes 3 and 4.
    pub(crate) const fn codes(self) -> [u8; 2] {
        match self {
            Self::SendDb => *b"AD",
            Self::SendDx => *b"OD",
            Self::Fetch(kind) => [b'E', kind.code()],
        }
    }

    /// What bytes 3 and 4 say.
    fn from_codes([request, kind]: [u8; 2]) -> Result<Self, CommandError> {
        let send = match request {
            b'A' => Self::SendDb,
            b'O' => Self::SendDx,
            b'E' => Self::Fetch(AreaKind::DataBlock),
            value => return Err(CommandError::Request { value }),
        };
        match (send, AreaKind::from_code(kind)) {
            (_, None) => Err(CommandError::AreaKind { value: kind }),
            (Self::Fetch(_), Some(kind)) => Ok(Self::Fetch(kind)),
            (send, Some(AreaKind::DataBlock)) => Ok(send),
            (_, Some(kind)) => Err(CommandError::SendSource { kind }),
        }
    }

    /// The area that is written or read.
    const fn target(self) -> AreaKind {
        match self {
            Self::SendDb => AreaKind::DataBlock,
            Self::SendDx => AreaKind::ExtendedDataBlock,
            Self::Fetch(kind) => kind,
        }
    }
}

/// A SEND or FETCH: the header of a job's first telegram.
///
/// | byte | value |
/// |---|---|
/// | 1 | 00h |
/// | 2 | 00h |
/// | 3, 4 | [`Request`] |
/// | 5 | number of the DB or DX, else 0 |
/// | 6 | first data word, byte, timer or counter |
/// | 7, 8 | length of the whole job, high byte first, in words or bytes, as the area counts |
/// | 9, 10 | [`Coordination`] |
///
/// Source: Siemens help for S7-300/400 point-to-point; CP 341 manual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "[u8; 10]", into = "[u8; 10]"))]
pub struct Command {
    request: Request,
    area: Area,
    length: u16,
    coordination: Coordination,
}

impl Command {
    /// SEND: write `words` data words to a DB or DX.
    ///
    /// # Errors
    /// [`RequestError`] for any other area and for no words at all.
    pub const fn send(area: Area, words: u16) -> Result<Self, RequestError> {
        let request = match area.kind() {
            AreaKind::DataBlock => Request::SendDb,
            AreaKind::ExtendedDataBlock => Request::SendDx,
            kind => return Err(RequestError::NotSendable { kind }),
        };
        Self::new(request, area, words)
    }

    /// FETCH: read `length` units (words or bytes, as the area counts) from `area`.
    ///
    /// # Errors
    /// [`RequestError::Empty`] for no units at all.
    pub const fn fetch(area: Area, length: u16) -> Result<Self, RequestError> {
        Self::new(Request::Fetch(area.kind()), area, length)
    }

    const fn new(request: Request, area: Area, length: u16) -> Result<Self, RequestError> {
        if length == 0 {
            return Err(RequestError::Empty);
        }
        Ok(Self {
            request,
            area,
            length,
            coordination: Coordination::NONE,
        })
    }

    /// The same command with coordination flag and CPU number.
    #[must_use]
    pub const fn with_coordination(mut self, coordination: Coordination) -> Self {
        self.coordination = coordination;
        self
    }

    /// What is asked for.
    #[must_use]
    pub const fn request(self) -> Request {
        self.request
    }

    /// Where it is written or read.
    #[must_use]
    pub const fn area(self) -> Area {
        self.area
    }

    /// Length of the whole job in the area's units; never 0.
    #[must_use]
    pub const fn length(self) -> u16 {
        self.length
    }

    /// Coordination flag and CPU number.
    #[must_use]
    pub const fn coordination(self) -> Coordination {
        self.coordination
    }

    /// Whether the data go with the commands, not with the reactions.
    #[must_use]
    pub const fn is_send(self) -> bool {
        matches!(self.request, Request::SendDb | Request::SendDx)
    }

    /// Length of the whole job in bytes.
    #[must_use]
    pub fn byte_len(self) -> usize {
        usize::from(self.length).saturating_mul(self.area.kind().bytes_per_unit())
    }

    /// Where the job starts, in bytes from the start of its block or area.
    #[must_use]
    pub fn byte_start(self) -> usize {
        usize::from(self.area.start()) * self.area.kind().bytes_per_unit()
    }

    /// User data that go with the telegram after `done` bytes have moved.
    pub(crate) fn chunk_after(self, done: usize) -> usize {
        self.byte_len().saturating_sub(done).min(MAX_DATA)
    }

    /// User data that the first telegram of the command itself carries.
    pub(crate) fn first_data(self) -> usize {
        if self.is_send() {
            self.chunk_after(0)
        } else {
            0
        }
    }

    /// The header.
    const fn encode(self) -> [u8; COMMAND_HEADER] {
        let [request, kind] = self.request.codes();
        let [high, low] = self.length.to_be_bytes();
        let [flag, nibbles] = self.coordination.encode();
        let (number, start) = (self.area.number(), self.area.start());
        let first = Part::First.code();
        [
            first, 0, request, kind, number, start, high, low, flag, nibbles,
        ]
    }

    /// The first telegram: header, then for a SEND the first 128 bytes of data or all if fewer.
    ///
    /// # Errors
    /// [`EncodeError::DataLength`] if `data` is not as long as the command says.
    pub fn telegram(self, data: &[u8]) -> Result<Telegram, EncodeError> {
        let expected = self.first_data();
        if data.len() != expected {
            let len = data.len();
            return Err(EncodeError::DataLength { len, expected });
        }
        Telegram::new(self.encode(), data)
    }

    /// Decodes and checks a first telegram; returns the data after the header.
    ///
    /// # Errors
    /// [`CommandError`] names the byte, the value, and the reaction that it earns.
    pub fn decode(block: &[u8]) -> Result<(Self, &[u8]), CommandError> {
        let Some((&header, data)) = block.split_first_chunk() else {
            let (len, least) = (block.len(), COMMAND_HEADER);
            return Err(CommandError::TooShort { len, least });
        };
        let command = Self::decode_header(header)?;
        command.check_first_data(data.len())?;
        Ok((command, data))
    }

    /// Decodes the ten bytes alone.
    fn decode_header(header: [u8; COMMAND_HEADER]) -> Result<Self, CommandError> {
        let [
            first,
            second,
            request,
            kind,
            number,
            start,
            high,
            low,
            flag,
            nibbles,
        ] = header;
        check_prefix(Part::First, first, second)?;
        let request = Request::from_codes([request, kind])?;
        let area = Area::new(request.target(), number, start)?;
        let length = u16::from_be_bytes([high, low]);
        let coordination = Coordination::decode([flag, nibbles])?;
        let command =
            Self::new(request, area, length).map_err(|_| CommandError::Length { value: length })?;
        Ok(command.with_coordination(coordination))
    }

    fn check_first_data(self, len: usize) -> Result<(), CommandError> {
        let expected = self.first_data();
        if len == expected {
            return Ok(());
        }
        Err(if self.is_send() {
            CommandError::FirstDataLength { len, expected }
        } else {
            CommandError::FetchWithData { len }
        })
    }
}

impl fmt::Display for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verb = if self.is_send() { "SEND" } else { "FETCH" };
        write!(f, "{verb} {}, length {}", self.area, self.length)
    }
}

impl TryFrom<[u8; COMMAND_HEADER]> for Command {
    type Error = CommandError;

    /// Decodes a bare header: for a SEND the data are not asked for.
    fn try_from(header: [u8; COMMAND_HEADER]) -> Result<Self, CommandError> {
        Self::decode_header(header)
    }
}

impl From<Command> for [u8; COMMAND_HEADER] {
    fn from(command: Command) -> Self {
        command.encode()
    }
}

/// Header of a continuation command: `FFh`, 00h, then the [`Request`] of the first telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Continuation {
    request: Request,
}

impl Continuation {
    /// The continuation of a command with that request.
    #[must_use]
    pub const fn new(request: Request) -> Self {
        Self { request }
    }

    /// What the first telegram asked for.
    #[must_use]
    pub const fn request(self) -> Request {
        self.request
    }

    /// The header.
    const fn encode(self) -> [u8; SHORT_HEADER] {
        let [request, kind] = self.request.codes();
        [Part::Continuation.code(), 0, request, kind]
    }

    /// The telegram: header, then the next data of a SEND, nothing for a FETCH.
    ///
    /// # Errors
    /// [`EncodeError::TooMuchData`] above 128 bytes.
    pub fn telegram(self, data: &[u8]) -> Result<Telegram, EncodeError> {
        Telegram::new(self.encode(), data)
    }

    /// Decodes a continuation; returns the data after the header.
    ///
    /// Whether it continues anything, only the [`Server`](crate::Server) knows.
    ///
    /// # Errors
    /// [`CommandError`] names the byte, the value, and the reaction that it earns.
    pub fn decode(block: &[u8]) -> Result<(Self, &[u8]), CommandError> {
        let Some((header, data)) = block.split_first_chunk::<SHORT_HEADER>() else {
            let (len, least) = (block.len(), SHORT_HEADER);
            return Err(CommandError::TooShort { len, least });
        };
        let &[first, second, request, kind] = header;
        check_prefix(Part::Continuation, first, second)?;
        let request = Request::from_codes([request, kind])?;
        match data.len() {
            len if len > MAX_DATA => Err(CommandError::ContinuationDataLength {
                len,
                expected: MAX_DATA,
            }),
            len if len > 0 && matches!(request, Request::Fetch(_)) => {
                Err(CommandError::FetchWithData { len })
            }
            _ => Ok((Self { request }, data)),
        }
    }
}

fn check_prefix(part: Part, first: u8, second: u8) -> Result<(), CommandError> {
    if first != part.code() {
        return Err(CommandError::FirstByte { value: first });
    }
    if second != 0 {
        return Err(CommandError::SecondByte { value: second });
    }
    Ok(())
}
