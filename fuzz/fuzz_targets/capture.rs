//! Any text as a capture: what is read is written and read again, told, judged, and kept for
//! Wireshark.
#![no_main]

use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use line3964r::capture::{self, PcapngWriter, Tap};
use monitor3964r::Character;
use proto3964r::{Config, Line, Priority};

fuzz_target!(|text: &str| {
    let Ok(record) = capture::read(text) else {
        return;
    };
    let written = write(&record);
    let again = capture::read(&written).expect("what is written is a capture");
    assert_eq!(write(&again), written);
    let said = |record: &[Character]| -> Vec<_> {
        // A written time has microseconds.
        let said = record
            .iter()
            .map(|it| (it.at.as_micros(), it.side, it.byte, it.error));
        said.collect()
    };
    assert_eq!(said(&again), said(&record));
    let pieces: Vec<_> = capture::pieces(&record).flatten().copied().collect();
    assert_eq!(pieces, record);
    closes(&keep(&record));
});

fn write(record: &[Character]) -> String {
    let lines = record.iter().map(|it| capture::line(it) + "\n");
    lines.collect()
}

/// As `line3964r monitor --save` keeps it.
fn keep(record: &[Character]) -> Vec<u8> {
    let mut tap = Tap::new(Config::siemens_3964r(Priority::Low, Line::Instant));
    let mut kept = Vec::new();
    let mut file = PcapngWriter::new(&mut kept, Duration::ZERO).expect("memory takes all");
    for piece in capture::pieces(record) {
        let steps: Vec<_> = piece.iter().flat_map(|&it| tap.hear(it)).collect();
        file.piece(piece, &steps).expect("memory takes all");
    }
    let verdict = tap.verdict().to_string();
    assert!(!verdict.is_empty());
    file.note(Duration::ZERO, &verdict)
        .expect("memory takes all");
    kept
}

/// Each block has its length, a multiple of four, at both ends.
fn closes(mut file: &[u8]) {
    while !file.is_empty() {
        let len = |at: &[u8]| u32::from_le_bytes(at.try_into().expect("four bytes"));
        let total = usize::try_from(len(&file[4..8])).expect("fits");
        assert!(total.is_multiple_of(4) && total >= 12);
        let (block, rest) = file.split_at(total);
        assert_eq!(len(&block[total - 4..]), len(&block[4..8]));
        file = rest;
    }
}
