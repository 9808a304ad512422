//! The serial line and the bytes at rest.

use core::hint::black_box;
use core::time::Duration;

use cortex_m_firmware::meter::Meter;
use pattern_codec::engraving::{Axis, Builder, Decoder, Format, JointPulses};
use proto3964r::{Check, Config, Line, Priority, Station, frame};

use crate::next;

const NOW: Duration = Duration::ZERO;

pub fn count(meter: &Meter) {
    stations(meter);
    records(meter);
}

fn stations(meter: &Meter) {
    let config = Config::siemens_3964r(Priority::Low, Line::Instant);
    let mut telegram = [0; 250];
    telegram[0] = 0x02;
    let payload = [0x41; 120];
    let len = frame::encode(&payload, Check::Bcc, &mut telegram[1..]).expect("room for all");
    let start = || {
        let mut station = Station::<128>::new(config);
        station.handle_byte(NOW, telegram[0]);
        station
    };
    let (mut station, mut bytes) = (start(), telegram[1..=len].iter());
    meter.count("Station::handle_byte", "call", 100, || {
        let byte = black_box(*bytes.next().expect("more bytes"));
        black_box(&mut station).handle_byte(NOW, byte);
    });
    let mut station = start();
    meter.count("Station::handle_bytes, the 100 next", "call", 1, || {
        station = start();
        black_box(black_box(&mut station).handle_bytes(NOW, black_box(&telegram[1..=100])));
    });
    meter.count("Station::poll_timeout", "call", 4, || {
        black_box(black_box(&station).poll_timeout());
    });
}

fn records(meter: &Meter) {
    let format = Format::default();
    let mut builder = Builder::new();
    let mut pattern = [0; 3 * 64];
    let slow = JointPulses {
        elbow: 25,
        shoulder: -11,
        disc: 3,
    };
    let mut places = pattern.chunks_exact_mut(3);
    for _ in 0..32 {
        let travel = builder.fast(Axis::Vertical, -700).expect("in range");
        let cut = builder.slow(slow).expect("in range");
        for (record, place) in travel.chain(cut).zip(&mut places) {
            place.copy_from_slice(&record.encode(&format));
        }
    }
    let mut records = format.records(&pattern);
    meter.count("Format::records: next", "call", 50, || {
        let _ = black_box(next(black_box(&mut records)));
    });
    let (mut decoder, mut input) = (Decoder::new(format), pattern.as_slice());
    meter.count("Decoder::decode, a record", "call", 50, || {
        let _ = black_box(black_box(&mut decoder).decode(black_box(&mut input)));
    });
}
