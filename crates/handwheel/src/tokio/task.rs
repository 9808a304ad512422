//! The task of a pendant: a [`Driver`] on a 3964R station.

use core::time::Duration;
use std::io;

use ::tokio::{sync::mpsc, time::Instant};
use proto3964r::tokio::{StreamDriver, sleep};

use super::{PendantError, Request, Waiting};
use crate::{
    driver::{Driver, Event},
    report::MAX_COMMAND,
};

type LineDriver = StreamDriver<MAX_COMMAND>;

/// While something comes in nothing goes out: some characters of 9600 bit/s.
const LOOK_AGAIN: Duration = Duration::from_millis(5);

/// Works until the pendant is dropped.
///
/// # Errors
/// The errors of the stream.
pub(super) async fn work(
    mut line: LineDriver,
    mut pendant: Driver,
    mut requests: mpsc::Receiver<Request>,
    happened: mpsc::Sender<Event>,
) -> io::Result<()> {
    let epoch = Instant::now();
    let mut caller = None;
    loop {
        pendant.handle_timeout(epoch.elapsed());
        while let Some(event) = pendant.poll_event() {
            // Its user, who holds the other end, ends this task, too.
            if let Some(event) = tell(&mut caller, event)
                && happened.send(event).await.is_err()
            {
                return Ok(());
            }
        }
        let now = epoch.elapsed();
        let is_free = line.is_idle() && !line.is_busy();
        if is_free
            && let Some(telegram) = pendant.poll_transmit(now)
            && line.submit(telegram).is_err()
        {
            pendant.handle_failed(now);
            continue;
        }
        let due = pendant.poll_timeout();
        let due = if is_free {
            due
        } else {
            due.map(|due| due.max(now.saturating_add(LOOK_AGAIN)))
        };
        ::tokio::select! {
            event = line.wait() => match event {
                Ok(event) => hand_over(&mut pendant, epoch.elapsed(), event),
                Err(error) => line.take_damage(error)?,
            },
            request = requests.recv(), if !pendant.is_busy() => {
                let Some(Request { job, caller: waiting }) = request else {
                    return Ok(());
                };
                match pendant.submit(job) {
                    Ok(()) => caller = Some(waiting),
                    Err(error) => fail(waiting, error),
                }
            }
            () = sleep(epoch, due) => {}
        }
    }
}

/// What the line has to say to the driver.
fn hand_over(pendant: &mut Driver, now: Duration, event: proto3964r::Event<'_>) {
    match event {
        proto3964r::Event::Received(telegram) => pendant.handle_block(now, telegram),
        proto3964r::Event::Sent { .. } => pendant.handle_delivered(now),
        proto3964r::Event::Failed(_) => pendant.handle_failed(now),
        _ => {}
    }
}

/// Tells the one who waits how the job ended; what is left is for everybody.
fn tell(caller: &mut Option<Waiting>, event: Event) -> Option<Event> {
    match event {
        Event::LedDone => {
            if let Some(Waiting::ForLed(mut caller)) = caller.take() {
                caller.tell(Ok(()));
            }
            None
        }
        Event::Lcd { answer, status } => {
            if let Some(Waiting::ForLcd(mut caller)) = caller.take() {
                caller.tell(Ok(answer));
            }
            status.map(|status| Event::Status {
                status,
                connected: false,
            })
        }
        Event::Failed(failure) => {
            if let Some(waiting) = caller.take() {
                fail(waiting, failure);
            }
            None
        }
        event => Some(event),
    }
}

fn fail(waiting: Waiting, error: impl Into<PendantError>) {
    match waiting {
        Waiting::ForLed(mut caller) => caller.tell(Err(error.into())),
        Waiting::ForLcd(mut caller) => caller.tell(Err(error.into())),
    }
}
