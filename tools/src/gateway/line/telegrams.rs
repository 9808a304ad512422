//! 3964R: what the partner sends, and what is sent to it.

use core::{sync::atomic::Ordering, time::Duration};

use proto3964r::tokio::{Link, Lost, SendError};
use tokio::{sync::mpsc, time::Instant};
use tokio_util::sync::CancellationToken;

use super::Line;
use crate::{
    Port,
    gateway::{
        config,
        hub::{self, Hub},
        job::{Action, Job},
        telegram::{Report, decode, describe, hex},
    },
};

/// What a partner may need besides its times: STX, DLE and the reading of them.
const SLACK: Duration = Duration::from_millis(500);

impl Line {
    /// Serves the line until it is lost or the gateway stops; says why.
    pub(super) async fn exchange_telegrams(
        &mut self,
        stream: Port,
        stop: &CancellationToken,
    ) -> String {
        let settings = self.config.config();
        let link = Link::new(stream, settings);
        // Set when the line is lost or the gateway stops: no job is begun after that.
        let closing = stop.child_token();
        let (hub, name) = (&*self.hub, self.name.as_str());
        let mut desk = Desk {
            hub,
            line: &self.config,
            name,
            seq: &mut self.seq,
            repeat_within: Duration::from_millis(settings.qvz_ms.into()) + SLACK,
            last: None,
        };
        let receiving = async {
            let lost = loop {
                let telegram = tokio::select! {
                    telegram = link.receive() => telegram,
                    () = closing.cancelled() => break None,
                };
                match telegram {
                    Ok(telegram) => desk.received(&telegram).await,
                    Err(lost) => break Some(lost),
                }
            };
            closing.cancel();
            lost
        };
        let sending = send_jobs(&mut self.jobs, &link, hub, name, &closing);
        let (lost, ()) = tokio::join!(receiving, sending);
        // What was acknowledged to the partner while the last job ended.
        for telegram in link.close().await {
            desk.received(&telegram).await;
        }
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
        let Some(Job { id, action }) = job else {
            return;
        };
        let result = match action {
            Action::Send(telegram) => link.send(&telegram).await,
            Action::Fetch { .. } | Action::Write { .. } => {
                let error = "fetch and write are for lines of RK512".to_owned();
                hub.outcome(name, id.as_ref(), Err(error)).await;
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
        hub.outcome(name, id.as_ref(), result).await;
    }
}

/// Where telegrams are written down.
struct Desk<'d> {
    hub: &'d Hub,
    line: &'d config::Line,
    name: &'d str,
    seq: &'d mut u64,
    /// How soon the partner repeats a telegram whose acknowledgement it missed: after the
    /// acknowledgement delay time (QVZ).
    repeat_within: Duration,
    last: Option<(Vec<u8>, Instant)>,
}

impl Desk<'_> {
    async fn received(&mut self, telegram: &[u8]) {
        let now = Instant::now();
        let character = Duration::from_secs(self.line.port.frame.bits().into())
            / self.line.port.frame.baud.max(1);
        let block = u32::try_from(telegram.len()).unwrap_or(u32::MAX);
        let within = self.repeat_within + character.saturating_mul(block.saturating_mul(2));
        let possible_repeat = self
            .last
            .replace((telegram.to_vec(), now))
            .is_some_and(|(last, at)| last == telegram && now - at <= within);
        if let Some(counts) = self.hub.counts(self.name) {
            counts.received.fetch_add(1, Ordering::Relaxed);
            let repeats = u64::from(possible_repeat);
            counts.repeats.fetch_add(repeats, Ordering::Relaxed);
        }
        self.hub.online(self.name, true);
        *self.seq += 1;
        let kind = describe(&self.line.telegrams, telegram);
        let fields = kind.map_or(&[][..], |kind| &kind.fields);
        let (fields, errors) = decode(fields, telegram);
        let report = Report {
            event: "telegram",
            line: self.name,
            name: kind.map(|kind| kind.name.as_str()),
            run: &self.hub.run,
            seq: *self.seq,
            time: hub::now(),
            hex: hex(telegram),
            possible_repeat,
            fields,
            errors,
        };
        self.hub.report(&report).await;
    }
}
