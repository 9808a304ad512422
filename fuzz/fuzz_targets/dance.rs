//! Frames of the dancer: packed, unpacked, in C headers; any text as a header.
#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use pattern_codec::c_header::{Dialect, Item, items};
use pattern_codec::dance::{Data, DataHeader, Packing, Sizes};
use pattern_codec::engraving::{Format, PatternData, ReloadData};

#[derive(Debug, Arbitrary)]
enum Input<'a> {
    Packed {
        packing: u8,
        bytes: &'a [u8],
    },
    Frames {
        packing: u8,
        sdcc: bool,
        frames: Vec<[i8; 9]>,
    },
    Text(&'a str),
    /// As the values of an array.
    Values(&'a str),
}

fuzz_target!(|input: Input<'_>| match input {
    Input::Packed { packing, bytes } => packed(packing_of(packing), bytes),
    Input::Frames {
        packing,
        sdcc,
        frames,
    } => written(packing_of(packing), sdcc, &frames),
    Input::Text(text) => read(text),
    Input::Values(text) => read(&format!("#define p_PACKING 2\nchar p[] = {{ {text} }};")),
});

fn packing_of(number: u8) -> Packing {
    Packing::ALL[usize::from(number) % 3]
}

/// Bytes that are accepted are frames that the shortest form means, too.
fn packed(packing: Packing, bytes: &[u8]) {
    let frames: Result<Vec<_>, _> = packing.decode::<9, _>(bytes.iter().copied()).collect();
    let Ok(frames) = frames else {
        let good = packing.decode::<9, _>(bytes.iter().copied());
        assert!(good.skip_while(Result::is_ok).count() == 1, "it goes on");
        return;
    };
    let shortest: Vec<u8> = packing.encode(frames.iter().copied()).collect();
    assert!(shortest.len() <= bytes.len());
    assert!(
        packing
            .decode(shortest)
            .map(|frame| frame.unwrap())
            .eq(frames)
    );
}

/// What is written is read.
fn written(packing: Packing, sdcc: bool, frames: &[[i8; 9]]) {
    let dialect = if sdcc { Dialect::Sdcc } else { Dialect::C51 };
    let header = DataHeader {
        dialect,
        packing,
        ..DataHeader::DEFAULT
    };
    let mut text = String::new();
    if header.write(frames.iter().copied(), &mut text).is_err() {
        assert!(frames.is_empty() || frames.len() > 5461);
        return;
    }
    let data = Data::<9>::read(&text).unwrap();
    assert!(data.frames().eq(frames.iter().copied()));
    assert_eq!(data.bytes(), Sizes::of(data.frames()).bytes(packing));
}

/// Any text: places never go back, and what is accepted is as long as it says.
fn read(text: &str) {
    let mut last = None;
    for (place, item) in items(text).map_while(Result::ok) {
        assert!(last < Some(place), "{item:?}");
        last = Some(place);
        if let Item::Define { name, .. } | Item::Array { name } = item {
            assert!(text.contains(name));
        }
    }
    if let Ok(data) = Data::<3>::read(text) {
        assert_eq!(data.frames().count() as u64, data.frame_count());
    }
    if let Ok(data) = PatternData::read(text, Format::new()) {
        assert_eq!(data.records().count() as u64, data.record_count());
    }
    if let Ok(data) = ReloadData::read(text, "p") {
        assert_eq!(data.periods().count() as u64, data.period_count());
    }
}
