//! What is stored comes back.

use core::time::Duration;

use proto3964r::{Config, Event, JobPhase, Line, Priority, Station};
use test_support::stored;

use crate::common::low_side::{STX, low, ms};

#[test]
fn configurations() {
    for config in [
        Config::siemens_3964r(Priority::High, Line::paced(19_200, 11)),
        Config::siemens_3964(Priority::Low, Line::Instant),
        Config::euchner_hbls(Line::buffered(9600, 11)),
        Config::euchner_hbas(Line::Instant),
        Config::linux(Priority::Low, Line::Instant),
        Config::km271(Line::paced(2400, 10)),
    ] {
        stored(&config);
    }
}

/// A station takes any stored configuration, even one without a single attempt.
#[test]
fn zero_attempts_are_one() {
    let config = Config {
        connection_attempts: 0,
        ..low()
    };
    stored(&config);
    let mut station = Station::<8>::new(config);
    station.submit(Duration::ZERO, b"A").unwrap();
    assert_eq!(station.poll_transmit_byte(Duration::ZERO), Some(STX));
    station.handle_timeout(ms(2000));
    let Some(Event::Failed(failure)) = station.poll_event() else {
        panic!("no failure");
    };
    stored(&failure);
    assert_eq!((failure.phase, failure.attempts), (JobPhase::Connection, 1));
}
