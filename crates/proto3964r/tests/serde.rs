//! What is stored comes back.
#![cfg(all(test, feature = "serde"))]
#![expect(clippy::unwrap_used, reason = "the helpers of tests fail loudly")]

use proto3964r::{Config, Failure, Instant, Phase, Priority, Station, Verdict};

fn round_trip<T: serde::Serialize + serde::de::DeserializeOwned>(value: &T) -> T {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

#[test]
fn configurations() {
    for config in [
        Config::siemens_3964r(Priority::High).with_line(19_200, 11),
        Config::siemens_3964(Priority::Low),
        Config::euchner_hbls(),
        Config::euchner_hbas(),
        Config::linux(Priority::Low),
        Config::km271(),
    ] {
        assert_eq!(round_trip(&config), config);
    }
}

/// A station takes any stored configuration, even one without a single attempt.
#[test]
fn zero_attempts_are_one() {
    let config = Config::siemens_3964r(Priority::Low)
        .with_setup_attempts(0)
        .with_nak_at_startup(false);
    let mut station = Station::<8>::new(round_trip(&config));
    station.send(Instant::ZERO, b"A").unwrap();
    assert_eq!(station.poll_transmit_byte(Instant::ZERO), Some(0x02));
    station.handle_timeout(Instant::from_millis(2000));
    let Some(proto3964r::Event::Failed(failure)) = station.poll_event() else {
        panic!("no failure");
    };
    let Failure {
        phase, attempts, ..
    } = round_trip(&failure);
    assert_eq!((phase, attempts), (Phase::Setup, 1));
}

#[test]
fn verdicts_and_times() {
    assert_eq!(round_trip(&Verdict::Works), Verdict::Works);
    assert_eq!(
        round_trip(&Instant::from_micros(7)),
        Instant::from_micros(7)
    );
}
