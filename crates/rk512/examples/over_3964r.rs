//! What goes between a 3964R station and an RK512 endpoint, here at the end of a silent line.

use core::time::Duration;
use proto3964r::{Event, Priority, Station, SubmitError};
use rk512::{Area, Command, Config, DataSource, Endpoint, MAX_TELEGRAM, Memory};

/// Whenever the station has been handed bytes or time.
fn exchange(
    station: &mut Station<MAX_TELEGRAM>,
    endpoint: &mut Endpoint<512>,
    plc: &mut impl DataSource,
    now: Duration,
) -> Result<(), SubmitError> {
    endpoint.handle_timeout(now, plc);
    while let Some(event) = station.poll_event() {
        match event {
            Event::Received(block) => endpoint.handle_block(now, block, plc),
            Event::Sent { .. } => endpoint.handle_delivered(now),
            Event::Failed(_) => endpoint.handle_failed(now, plc),
            _ => {}
        }
        if endpoint.wants_recall() {
            station.cancel(now);
        }
    }
    match endpoint.poll_transmit(now) {
        Some(telegram) => station.submit(now, &telegram),
        None => Ok(()),
    }
}

fn main() -> Result<(), Box<dyn core::error::Error>> {
    let line = proto3964r::Config::siemens_3964r(Priority::High, proto3964r::Line::Instant);
    let (mut station, mut endpoint) = (Station::new(line), Endpoint::new(Config::DEFAULT));
    endpoint.submit(Command::fetch(Area::db(5, 0), 1)?, &[])?;
    let (mut plc, mut now) = (Memory::new([]), Duration::ZERO);
    exchange(&mut station, &mut endpoint, &mut plc, now)?;
    while let Some(due) = station.poll_timeout() {
        now = due;
        station.handle_timeout(now);
        exchange(&mut station, &mut endpoint, &mut plc, now)?;
    }
    println!("after {now:?}: {:?}", endpoint.poll_event());
    Ok(())
}
