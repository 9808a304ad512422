//! One telegram from one station to the other, on a line that takes no time.

use core::time::Duration;
use proto3964r::{Config, Event, Line, Priority, Station, SubmitError};

fn main() -> Result<(), SubmitError> {
    let mut plc = Station::<128>::new(Config::siemens_3964r(Priority::High, Line::Instant));
    let mut scale = Station::<128>::new(Config::siemens_3964r(Priority::Low, Line::Instant));
    let now = Duration::ZERO; // since any moment
    plc.submit(now, b"tare")?;
    for _ in 0..3 {
        while let Some(byte) = plc.poll_transmit_byte(now) {
            scale.handle_byte(now, byte);
        }
        while let Some(byte) = scale.poll_transmit_byte(now) {
            plc.handle_byte(now, byte);
        }
    }
    println!("at the scale: {:02X?}", scale.poll_event());
    assert_eq!(plc.poll_event(), Some(Event::Sent { len: 4 }));
    Ok(())
}
