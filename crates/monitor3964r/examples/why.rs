//! A line that does not come up, step by step, and why.

use core::time::Duration;
use monitor3964r::{Character, Monitor, Side, diagnose};
use proto3964r::{Config, Line, Priority};

fn main() {
    let config = Config::siemens_3964r(Priority::Low, Line::Instant);
    let mut monitor = Monitor::<128>::new(config);
    // A tap on both directions heard STX of A, NAK of B, and that once more.
    let record = [
        (0, Side::A, 0x02),
        (3, Side::B, 0x15),
        (6, Side::A, 0x02),
        (9, Side::B, 0x15),
    ]
    .map(|(ms, side, byte)| Character {
        at: Duration::from_millis(ms),
        side,
        byte,
        error: None,
    });
    for heard in record {
        for step in monitor.handle_byte(heard.at, heard.side, heard.byte) {
            println!("{:?} {step}", heard.at);
        }
    }
    // The line is set up right, and B takes nothing.
    println!("{}", diagnose(&record, &config).verdict);
}
