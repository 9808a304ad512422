//! The bytes at rest.

use core::hint::black_box;

use pattern_codec::dance::{Data, DataHeader, Packing};
use pattern_codec::engraving::{Axis, Builder, Decoder, Format, JointPulses};

use super::holds;
/// Records to bytes and back, from a slice and from chunks.
pub fn records() -> Option<()> {
    let format = Format::default();
    let mut builder = Builder::new();
    let mut bytes = [0; 15];
    let slow = JointPulses {
        elbow: 45,
        shoulder: -90,
        disc: 6,
    };
    let records = builder
        .fast(Axis::Vertical, black_box(-70_000))
        .ok()?
        .chain(builder.slow(slow).ok()?);
    for (place, record) in bytes.chunks_exact_mut(3).zip(records) {
        place.copy_from_slice(&record.encode(&format));
    }
    let mut arm = Builder::new();
    let (mut decoder, mut input) = (Decoder::new(format), black_box(bytes.as_slice()));
    for located in format.records(black_box(&bytes)) {
        let located = located.ok()?;
        holds(decoder.decode(&mut input)?.ok()? == located)?;
        arm.track(located.record).ok()?;
    }
    holds(decoder.finish() == Ok(15) && arm.position() == builder.position())
}

/// Frames written as a C header and read back.
pub fn dance_header() -> Option<()> {
    let mut text = Text {
        bytes: [0; 1024],
        len: 0,
    };
    let header = DataHeader {
        packing: Packing::MaskedRuns,
        ..DataHeader::DEFAULT
    };
    let frames = [0, 12, 60, 60, -60].map(|speed| [black_box(speed), 0, 7]);
    header.write(frames, &mut text).ok()?;
    let data = Data::<3>::read(core::str::from_utf8(text.bytes.get(..text.len)?).ok()?).ok()?;
    holds(data.frames().eq(frames))
}

/// A writer into fixed memory.
struct Text {
    bytes: [u8; 1024],
    len: usize,
}

impl core::fmt::Write for Text {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let end = self.len + text.len();
        let place = self.bytes.get_mut(self.len..end).ok_or(core::fmt::Error)?;
        place.copy_from_slice(text.as_bytes());
        self.len = end;
        Ok(())
    }
}
