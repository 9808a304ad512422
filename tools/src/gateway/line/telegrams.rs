//! 3964R: what the partner sends, and what is sent to it.

use core::{
    sync::atomic::{AtomicU64, Ordering},
    time::Duration,
};

use proto3964r::tokio::{Incoming, Link, Lost, SendError};
use tokio::{sync::mpsc, time::Instant};
use tokio_util::sync::CancellationToken;

use super::{
    Line,
    numbers::{Arrival, Numbers},
};
use crate::gateway::{
    config,
    hub::{Counts, Hub},
    job::{Action, Job},
    store::{Number, StoreError},
    tap::Tapped,
    telegram::{Report, decode, describe, hex},
    time::now,
};

/// What a partner may need besides its times: STX, DLE and the reading of them.
const SLACK: Duration = Duration::from_millis(500);

/// How much of the acknowledgement delay time (QVZ) the store may take, in quarters; the rest is
/// for the way to the partner.
const QUARTERS_OF_QVZ: u16 = 3;

impl Line {
    /// Serves the line until it is lost or the gateway stops; says why.
    pub(super) async fn exchange_telegrams(
        &mut self,
        stream: Tapped,
        stop: &CancellationToken,
    ) -> String {
        let mut settings = self.config.config();
        if self.hub.outbox.is_some() {
            settings.acknowledge_wait_ms = (settings.qvz_ms / 4 * QUARTERS_OF_QVZ).max(1);
        }
        let link = Link::with_observer(stream, settings, self.hub.observer(&self.name));
        // Set when the line is lost or is to be closed: no job is begun after that.
        let closing = stop.child_token();
        // Set when the last job has ended, until when the partner may send.
        let ended = CancellationToken::new();
        let (hub, name) = (&*self.hub, self.name.as_str());
        let mut desk = Desk {
            hub,
            line: &self.config,
            name,
            numbers: &mut self.numbers,
            repeat_within: Duration::from_millis(settings.qvz_ms.into()) + SLACK,
        };
        let receiving = async {
            let lost = loop {
                let incoming = tokio::select! {
                    incoming = link.incoming() => incoming,
                    () = ended.cancelled() => break None,
                };
                match incoming {
                    Ok(incoming) => desk.received(incoming, &ended).await,
                    Err(lost) => break Some(lost),
                }
            };
            closing.cancel();
            lost
        };
        let sending = async {
            send_jobs(&mut self.jobs, &link, hub, name, &closing).await;
            ended.cancel();
        };
        let (lost, ()) = tokio::join!(receiving, sending);
        // What was acknowledged to the partner while the last job ended, where nothing is stored.
        for telegram in link.close().await {
            let arrival = desk.number(&telegram);
            desk.keep(&telegram, &arrival).await.ok();
        }
        self.numbers.line_was_lost();
        lost.as_ref()
            .map_or_else(|| "stopped".to_owned(), Lost::to_string)
    }
}

/// Does one job after the other; one that was begun ends with its outcome.
async fn send_jobs(
    jobs: &mut mpsc::Receiver<Job>,
    link: &Link,
    hub: &Hub,
    name: &str,
    closing: &CancellationToken,
) {
    loop {
        let job = tokio::select! {
            () = closing.cancelled() => return,
            job = jobs.recv() => job,
        };
        let Some(Job { asked, action }) = job else {
            return;
        };
        let result = match action {
            Action::Send(telegram) => link.send(&telegram).await,
            Action::Fetch { .. } | Action::Write { .. } => {
                let error = "fetch and write are for lines of RK512".to_owned();
                hub.outcome(name, &asked, Err(error)).await;
                continue;
            }
        };
        match &result {
            Ok(()) => hub.online(name, true),
            // The partner does not answer, or not as it should.
            Err(SendError::Failed(_)) => hub.online(name, false),
            Err(_) => {}
        }
        let result = result.map_err(|error| error.to_string());
        hub.outcome(name, &asked, result).await;
    }
}

/// Where telegrams are written down.
struct Desk<'d> {
    hub: &'d Hub,
    line: &'d config::Line,
    name: &'d str,
    numbers: &'d mut Numbers,
    /// How soon the partner repeats a telegram whose acknowledgement it missed: after the
    /// acknowledgement delay time (QVZ).
    repeat_within: Duration,
}

impl Desk<'_> {
    /// Makes a telegram safe, then acknowledges it; one that cannot be made safe is refused.
    async fn received(&mut self, incoming: Incoming, ended: &CancellationToken) {
        let telegram = incoming.telegram().to_vec();
        self.hub.online(self.name, true);
        let mut arrival = self.number(&telegram);
        if !arrival.is_stored {
            let stored = tokio::select! {
                stored = self.keep(&telegram, &arrival) => stored.is_ok(),
                () = ended.cancelled() => false,
            };
            arrival.is_stored = stored;
        }
        if !arrival.is_stored {
            self.count(|counts| &counts.not_stored);
            self.numbers.open = Some(arrival);
            incoming.refuse();
        } else if incoming.accept().await {
            self.count(|counts| &counts.received);
            if arrival.possible_repeat {
                self.count(|counts| &counts.repeats);
            }
            self.numbers.acknowledged(telegram, Some(Instant::now()));
        } else {
            self.numbers.open = Some(arrival);
        }
    }

    fn number(&mut self, telegram: &[u8]) -> Arrival {
        let character = Duration::from_secs(self.line.port.frame.bits().into())
            / self.line.port.frame.baud.max(1);
        let block = u32::try_from(telegram.len()).unwrap_or(u32::MAX);
        let within = self.repeat_within + character.saturating_mul(block.saturating_mul(2));
        let within = self.line.mark_repeats.then_some(within);
        self.numbers.arrival(telegram, within)
    }

    async fn keep(&self, telegram: &[u8], arrival: &Arrival) -> Result<(), StoreError> {
        let kind = describe(&self.line.telegrams, telegram);
        let fields = kind.map_or(&[][..], |kind| &kind.fields);
        let (fields, errors) = decode(fields, telegram);
        let report = Report {
            event: "telegram",
            line: self.name,
            name: kind.map(|kind| kind.name.as_str()),
            run: &self.hub.run,
            seq: arrival.seq,
            time: now(),
            hex: hex(telegram),
            possible_repeat: arrival.possible_repeat,
            fields,
            errors,
        };
        let number = Number {
            line: self.name.to_owned(),
            seq: arrival.seq,
            telegram: telegram.to_vec(),
            area: None,
        };
        let stored = self.hub.report(&report, number).await;
        if let Err(error) = &stored {
            self.hub.not_stored(self.name, error);
        }
        stored
    }

    fn count(&self, count: impl FnOnce(&Counts) -> &AtomicU64) {
        if let Some(counts) = self.hub.counts(self.name) {
            count(counts).fetch_add(1, Ordering::Relaxed);
        }
    }
}
