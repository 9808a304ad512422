//! A 3964R station of 128 bytes each way.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;
use core::time::Duration;

use proto3964r::{Config, Line, Priority, Station};

fn work() -> Option<()> {
    let config = Config::siemens_3964r(Priority::Low, Line::Instant);
    let mut station = Station::<128>::new(config);
    let (mut now, mut wire) = (Duration::ZERO, [0; 16]);
    station.submit(now, black_box(b"tare")).ok()?;
    for byte in black_box([0x10, 0x10, 0x02]) {
        now += Duration::from_millis(1);
        station.handle_byte(now, byte);
        station.handle_timeout(now);
        black_box(station.poll_transmit(now, &mut wire));
        black_box(station.poll_event());
        black_box(station.poll_timeout());
    }
    Some(())
}
