//! What goes between a 3964R station and a pendant's driver, here at the end of a silent line.

use core::time::Duration;
use handwheel::{Driver, Event, MAX_COMMAND, Model, Timeouts};
use proto3964r::{Config, Line, Station, SubmitError};

/// Whenever the station has been handed bytes or time.
fn exchange(
    station: &mut Station<MAX_COMMAND>,
    driver: &mut Driver,
    now: Duration,
    mut at_event: impl FnMut(Event),
) -> Result<(), SubmitError> {
    driver.handle_timeout(now);
    while let Some(event) = station.poll_event() {
        match event {
            proto3964r::Event::Received(telegram) => driver.handle_block(now, telegram),
            proto3964r::Event::Sent { .. } => driver.handle_delivered(now),
            proto3964r::Event::Failed(_) => driver.handle_failed(now),
            _ => {}
        }
        core::iter::from_fn(|| driver.poll_event()).for_each(&mut at_event);
    }
    core::iter::from_fn(|| driver.poll_event()).for_each(&mut at_event);
    // Nothing is on its way from the pendant.
    if station.is_idle()
        && !station.is_busy()
        && let Some(telegram) = driver.poll_transmit(now)
    {
        station.submit(now, telegram)?;
    }
    Ok(())
}

fn main() -> Result<(), SubmitError> {
    let line = Config::euchner_hbls(Line::Instant);
    let (mut station, mut now) = (Station::new(line), Duration::ZERO);
    let mut driver = Driver::new(Model::Hbls, Timeouts::DEFAULT);
    while now < Duration::from_secs(5) {
        exchange(&mut station, &mut driver, now, |event| {
            println!("{event:?}");
        })?;
        while let Some(byte) = station.poll_transmit_byte(now) {
            println!("{now:?}: {byte:02X}");
        }
        let due = [station.poll_timeout(), driver.poll_timeout()];
        now = due.into_iter().flatten().min().unwrap_or(now).max(now);
        station.handle_timeout(now);
    }
    Ok(())
}
