//! Captures for Wireshark: pcapng with the link type for serial lines.

use core::time::Duration;
use std::io::{self, Write};

use monitor3964r::{Character, Side};
use proto3964r::CharacterError;

use super::Step;

/// `LINKTYPE_RTAC_SERIAL`: time, event, control lines, then the characters.
const LINK_TYPE: u16 = 250;

// Blocks and options of pcapng.
const SECTION: u32 = 0x0A0D_0D0A;
const BYTE_ORDER: u32 = 0x1A2B_3C4D;
const INTERFACE: u32 = 1;
const PACKET: u32 = 6;
const COMMENT: u16 = 1;
const INTERFACE_NAME: u16 = 2;
const APPLICATION: u16 = 4;
const TIME_RESOLUTION: u16 = 9;
const NANOSECONDS: u8 = 9;

/// What a packet of this link type tells.
#[derive(Clone, Copy)]
enum Event {
    Status = 0,
    FromA = 1,
    FromB = 2,
    Complete = 6,
    Framing = 7,
    Parity = 8,
    Overflow = 10,
}

/// Writes what a tap hears as pcapng, which Wireshark and tshark read as it is.
///
/// Each packet holds what one side sent in one piece, on the interface `A to B` or `B to A`. What
/// it means is its comment (`frame.comment`), and so is the verdict, on a packet of its own at the
/// end. Damaged characters are events of the link type (`rtacser`).
///
/// # Examples
/// ```
/// use core::time::Duration;
/// use line3964r::capture::{self, PcapngWriter, Tap};
/// use proto3964r::{Config, Line, Priority};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut tap = Tap::new(Config::siemens_3964r(Priority::Low, Line::Instant));
/// let mut file = PcapngWriter::new(Vec::new(), Duration::ZERO)?;
/// let record = capture::read("0 > 02\n0.003 < 10\n")?;
/// for piece in capture::pieces(&record) {
///     let steps: Vec<_> = piece.iter().flat_map(|&heard| tap.hear(heard)).collect();
///     file.piece(piece, &steps)?;
/// }
/// file.note(Duration::from_secs(1), &tap.verdict().to_string())?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct PcapngWriter<W> {
    out: W,
    epoch: Duration,
}

impl<W: Write> PcapngWriter<W> {
    /// Begins a file. `epoch` is the time 0 of the capture, since 1970-01-01 00:00 UTC.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn new(mut out: W, epoch: Duration) -> io::Result<Self> {
        let mut body = Vec::new();
        body.extend(BYTE_ORDER.to_le_bytes());
        body.extend([1, 0, 0, 0]); // version 1.0
        body.extend((-1_i64).to_le_bytes()); // of unknown length
        let application = concat!("line3964r ", env!("CARGO_PKG_VERSION"));
        option(&mut body, APPLICATION, application.as_bytes());
        option(&mut body, 0, &[]);
        block(&mut out, SECTION, &body)?;
        for name in ["A to B", "B to A"] {
            let mut body = Vec::new();
            body.extend(LINK_TYPE.to_le_bytes());
            body.extend([0; 6]); // no limit of length
            option(&mut body, INTERFACE_NAME, name.as_bytes());
            option(&mut body, TIME_RESOLUTION, &[NANOSECONDS]);
            option(&mut body, 0, &[]);
            block(&mut out, INTERFACE, &body)?;
        }
        out.flush()?;
        Ok(Self { out, epoch })
    }

    /// Writes a piece of [`pieces`](super::pieces) and what it means.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn piece(&mut self, piece: &[Character], steps: &[Step]) -> io::Result<()> {
        let Some(first) = piece.first() else {
            return Ok(());
        };
        let event = match (first.error, first.side) {
            (None, Side::A) => Event::FromA,
            (None, Side::B) => Event::FromB,
            (Some(CharacterError::Framing), _) => Event::Framing,
            (Some(CharacterError::Overrun), _) => Event::Overflow,
            (Some(_), _) => Event::Parity,
        };
        let bytes: Vec<_> = piece.iter().map(|heard| heard.byte).collect();
        self.packet(first.at, first.side, event, &bytes, &comment(steps))
    }

    /// Writes steps that the time alone has made, if there are any.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn wait(&mut self, steps: &[Step]) -> io::Result<()> {
        let Some(first) = steps.first() else {
            return Ok(());
        };
        let side = first.side.unwrap_or(Side::A);
        self.packet(first.at, side, Event::Status, &[], &comment(steps))
    }

    /// Writes a verdict on all so far.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn note(&mut self, at: Duration, text: &str) -> io::Result<()> {
        self.packet(at, Side::A, Event::Complete, &[], text)
    }

    fn packet(
        &mut self,
        at: Duration,
        side: Side,
        event: Event,
        bytes: &[u8],
        comment: &str,
    ) -> io::Result<()> {
        let time = self.epoch.saturating_add(at);
        // Both in big-endian order, as the link type has it.
        let seconds = u32::try_from(time.as_secs()).unwrap_or(u32::MAX);
        let mut data = Vec::from(seconds.to_be_bytes());
        data.extend(time.subsec_micros().to_be_bytes());
        data.extend([event as u8, 0, 0, 0]);
        data.extend(bytes);

        let nanoseconds = u64::try_from(time.as_nanos()).unwrap_or(u64::MAX);
        let [a, b, c, d, e, f, g, h] = nanoseconds.to_le_bytes();
        let len = u32::try_from(data.len()).unwrap_or(u32::MAX).to_le_bytes();
        let mut body = Vec::from(u32::from(side == Side::B).to_le_bytes());
        body.extend([e, f, g, h, a, b, c, d]);
        body.extend(len);
        body.extend(len);
        padded(&mut body, &data);
        if !comment.is_empty() {
            option(&mut body, COMMENT, comment.as_bytes());
            option(&mut body, 0, &[]);
        }
        block(&mut self.out, PACKET, &body)?;
        self.out.flush()
    }
}

/// The steps of a piece, in one line.
fn comment(steps: &[Step]) -> String {
    let steps: Vec<_> = steps.iter().map(|step| step.text.as_str()).collect();
    steps.join("; ")
}

fn block(out: &mut impl Write, kind: u32, body: &[u8]) -> io::Result<()> {
    let len = u32::try_from(body.len() + 12).map_err(io::Error::other)?;
    out.write_all(&kind.to_le_bytes())?;
    out.write_all(&len.to_le_bytes())?;
    out.write_all(body)?;
    out.write_all(&len.to_le_bytes())
}

/// Appends an option; longer texts than a comment may have are cut.
fn option(body: &mut Vec<u8>, code: u16, value: &[u8]) {
    let len = u16::try_from(value.len()).unwrap_or(u16::MAX);
    let value = value.get(..len.into()).unwrap_or_default();
    body.extend(code.to_le_bytes());
    body.extend(len.to_le_bytes());
    padded(body, value);
}

/// Appends bytes and zeros up to a multiple of four.
fn padded(body: &mut Vec<u8>, bytes: &[u8]) {
    body.extend(bytes);
    body.resize(body.len().next_multiple_of(4), 0);
}
