//! What is stored comes back.

use core::time::Duration;

use proto3964r::{Config, Failure, Line, Phase, Priority, Station, Verdict};

fn round_trip<T: serde::Serialize + serde::de::DeserializeOwned>(value: &T) -> T {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

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
        assert_eq!(round_trip(&config), config);
    }
}

/// A station takes any stored configuration, even one without a single attempt.
#[test]
fn zero_attempts_are_one() {
    let config = Config {
        connection_attempts: 0,
        nak_at_startup: false,
        ..Config::siemens_3964r(Priority::Low, Line::Instant)
    };
    let mut station = Station::<8>::new(round_trip(&config));
    station.submit(Duration::ZERO, b"A").unwrap();
    assert_eq!(station.poll_transmit_byte(Duration::ZERO), Some(0x02));
    station.handle_timeout(Duration::from_millis(2000));
    let Some(proto3964r::Event::Failed(failure)) = station.poll_event() else {
        panic!("no failure");
    };
    let Failure {
        phase, attempts, ..
    } = round_trip(&failure);
    assert_eq!((phase, attempts), (Phase::Connection, 1));
}

#[test]
fn verdicts() {
    assert_eq!(round_trip(&Verdict::Works), Verdict::Works);
}
