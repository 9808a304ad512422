//! pattern-codec: frames of the dancer, C headers.

use std::hint::black_box;

use no_panic::no_panic;
use pattern_codec::c_header::{HeaderError, items};
use pattern_codec::dance::{Data, DecodeError, Decoded, Packing};
use pattern_codec::engraving::{Format, PatternData, ReloadData};

type Bytes<'a> = std::iter::Copied<std::slice::Iter<'a, u8>>;

#[no_panic]
#[inline(never)]
fn decoded_next(decoded: &mut Decoded<Bytes<'_>, 8>) -> Option<Result<[i8; 8], DecodeError>> {
    decoded.next()
}

#[no_panic]
#[inline(never)]
fn data_read(text: &str) -> Result<Data<'_, 8>, HeaderError> {
    Data::read(text)
}

/// Bytes of frames, items of a header, its frames, records and timer periods.
#[no_panic]
#[inline(never)]
fn any_next<I: Iterator>(items: &mut I) -> Option<I::Item> {
    items.next()
}

#[no_panic]
#[inline(never)]
fn pattern_read(text: &str, format: Format) -> Result<PatternData<'_>, HeaderError> {
    PatternData::read(text, format)
}

#[no_panic]
#[inline(never)]
fn reloads_read<'a>(text: &'a str, name: &str) -> Result<ReloadData<'a>, HeaderError> {
    ReloadData::read(text, name)
}

pub fn run() {
    let frames = black_box([[60, -60, 0, 0, 0, 0, 0, 0]; 3].as_slice());
    let bytes = black_box([3, 1, 60, 1, 0, 0, 0, 0, 0].as_slice());
    let text = black_box("#define P_PACKING 1\nchar p[] = {1, 60, 0, 0, 0, 0, 0, 0, 0};");
    for packing in black_box(Packing::ALL) {
        let encoded = packing.encode(frames.iter().copied());
        black_box(any_next(&mut black_box(encoded)));
        let decoded = packing.decode(bytes.iter().copied());
        let _ = black_box(decoded_next(&mut black_box(decoded)));
    }
    let _ = black_box(any_next(&mut black_box(items(text))));
    if let Ok(data) = data_read(text) {
        black_box(any_next(&mut black_box(data.frames())));
    }
    if let Ok(data) = pattern_read(text, black_box(Format::new())) {
        black_box(any_next(&mut black_box(data.records())));
    }
    if let Ok(data) = reloads_read(text, black_box("p")) {
        black_box(any_next(&mut black_box(data.periods())));
    }
}
