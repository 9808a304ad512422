//! What lines, broker, TCP and metrics share.

use alloc::{
    collections::{BTreeMap, VecDeque},
    sync::Arc,
};
use core::{
    mem,
    sync::atomic::{AtomicBool, AtomicU64, Ordering},
    time::Duration,
};
use std::{
    sync::{Mutex, MutexGuard, PoisonError},
    time::Instant,
};

use bytes::Bytes;
use jiff::Timestamp;
use log::{info, warn};
use serde::Serialize;
use serde_json::{Value, json};
use tokio::sync::{broadcast, mpsc};
use tokio_util::sync::CancellationToken;

use super::{
    config::Config,
    job::{Job, Outcome, Refused},
    outbox::Outbox,
    telegram::Report,
};

/// Events that a slow TCP client may be behind.
const TCP_QUEUE: usize = 1024;

/// Identifiers of commands that a line remembers, more than the broker hands over at once.
const RECENT: usize = 256;

/// From one refusal in the log to the next.
const LOG_PAUSE: Duration = Duration::from_secs(1);

/// Counts of one line.
#[derive(Default)]
pub(crate) struct Counts {
    pub(crate) received: AtomicU64,
    pub(crate) repeats: AtomicU64,
    pub(crate) done: AtomicU64,
    pub(crate) failed: AtomicU64,
    pub(crate) refused: AtomicU64,
    pub(crate) opened: AtomicU64,
}

/// A line as others see it.
pub(crate) struct Desk {
    pub(crate) counts: Counts,
    /// The last that was told of its state.
    is_online: Mutex<Option<bool>>,
    jobs: mpsc::Sender<Job>,
    refusals: Mutex<Refusals>,
    /// The last commands that had an identifier.
    recent: Mutex<VecDeque<Value>>,
}

/// Refused commands that the log does not show one by one.
#[derive(Default)]
struct Refusals {
    /// The last that it shows.
    logged: Option<(Instant, String)>,
    unlogged: u64,
}

/// The middle of the gateway.
pub(crate) struct Hub {
    /// Of MQTT: prefix and name of the gateway.
    pub(crate) topic: String,
    pub(crate) run: String,
    pub(crate) outbox: Option<Outbox>,
    pub(crate) events: broadcast::Sender<Bytes>,
    pub(crate) lines: BTreeMap<String, Desk>,
    pub(crate) stop: CancellationToken,
    pub(crate) broker: BrokerCounts,
}

/// Counts of the connection to the broker.
#[derive(Default)]
pub(crate) struct BrokerCounts {
    pub(crate) is_connected: AtomicBool,
    pub(crate) connects: AtomicU64,
    pub(crate) published: AtomicU64,
    pub(crate) refused: AtomicU64,
}

/// The time of day, in UTC to the millisecond.
pub(crate) fn now() -> String {
    format!("{:.3}", Timestamp::now())
}

impl Hub {
    /// The hub, and for each line, in its order, where its jobs come from.
    pub(crate) fn new(config: &Config) -> (Arc<Self>, Vec<mpsc::Receiver<Job>>) {
        let mut receivers = Vec::new();
        let mut lines = BTreeMap::new();
        for line in config.lines.iter().map(|line| line.get_ref()) {
            let (jobs, receiver) = mpsc::channel(line.commands.get().into());
            receivers.push(receiver);
            let desk = Desk {
                counts: Counts::default(),
                is_online: Mutex::default(),
                jobs,
                refusals: Mutex::default(),
                recent: Mutex::default(),
            };
            lines.insert(line.name.get_ref().to_string(), desk);
        }
        let mqtt = config.mqtt();
        let prefix = mqtt.map(|mqtt| mqtt.prefix.0.as_str()).unwrap_or_default();
        let hub = Self {
            topic: format!("{prefix}/{}", config.name),
            run: now(),
            outbox: mqtt.map(|mqtt| Outbox::new(mqtt.queue.get().into(), mqtt.overflow)),
            events: broadcast::channel(TCP_QUEUE).0,
            lines,
            stop: CancellationToken::new(),
            broker: BrokerCounts::default(),
        };
        (Arc::new(hub), receivers)
    }

    /// Where the state of the gateway is retained.
    pub(crate) fn status_topic(&self) -> String {
        format!("{}/status", self.topic)
    }

    /// The counts of a line.
    pub(crate) fn counts(&self, line: &str) -> Option<&Counts> {
        self.lines.get(line).map(|desk| &desk.counts)
    }

    /// Tells what came, everywhere; waits where the queue of the broker does.
    pub(crate) async fn report(&self, report: &Report<'_>) {
        let payload = self.tell(report);
        if let Some(outbox) = &self.outbox {
            let Report { event, line, .. } = report;
            let topic = match report.name {
                Some(name) => format!("{}/{line}/{event}/{name}", self.topic),
                None => format!("{}/{line}/{event}", self.topic),
            };
            outbox.push(topic, payload).await;
        }
    }

    /// Tells what became of a job.
    pub(crate) async fn outcome(
        &self,
        line: &str,
        job: Option<&Value>,
        result: Result<(), String>,
    ) {
        if let Some(counts) = self.counts(line) {
            let count = if result.is_ok() {
                &counts.done
            } else {
                &counts.failed
            };
            count.fetch_add(1, Ordering::Relaxed);
        }
        let (topic, payload) = self.make_outcome(line, job, result);
        if let Some(outbox) = &self.outbox {
            outbox.push(topic, payload).await;
        }
    }

    /// The event of an outcome, and its topic.
    fn make_outcome(
        &self,
        line: &str,
        id: Option<&Value>,
        result: Result<(), String>,
    ) -> (String, Bytes) {
        let outcome = Outcome {
            event: "outcome",
            line,
            time: now(),
            id,
            ok: result.is_ok(),
            error: result.as_ref().err().map(String::as_str),
        };
        (
            format!("{}/{line}/outcome", self.topic),
            self.tell(&outcome),
        )
    }

    /// Tells whether a line works, where that is news.
    pub(crate) fn online(&self, line: &str, is_online: bool) {
        let Some(desk) = self.lines.get(line) else {
            return;
        };
        if lock(&desk.is_online).replace(is_online) == Some(is_online) {
            return;
        }
        let status = if is_online { "online" } else { "offline" };
        self.tell(&json!({
            "event": "status", "line": line, "time": now(), "status": status,
        }));
        if let Some(outbox) = &self.outbox {
            outbox.retain(format!("{}/{line}/status", self.topic), status.into());
        }
    }

    /// Hands a command to its line. One that is not taken gets an outcome, as long as there is
    /// room, and a line in the log, where the same is not repeated within a second. One that the broker may have handed over
    /// before is not run again if its `id` is known.
    pub(crate) fn command(&self, line: &str, payload: &[u8], may_be_duplicate: bool) {
        let Some(desk) = self.lines.get(line) else {
            warn!(
                "a command for `{}`, which is no line here",
                line.escape_default()
            );
            return;
        };
        let refused = match Job::parse(payload) {
            Ok(job) if may_be_duplicate && desk.is_known(&job) => {
                info!("{line}: a command that came twice is not run again");
                return;
            }
            Ok(job) => match desk.hand_over(job) {
                Ok(()) => return,
                Err(refused) => refused,
            },
            Err(refused) => refused,
        };
        desk.counts.refused.fetch_add(1, Ordering::Relaxed);
        desk.log_refusal(line, &refused.message);
        let (topic, payload) = self.make_outcome(line, refused.id.as_ref(), Err(refused.message));
        if let Some(outbox) = &self.outbox {
            outbox.offer(topic, payload);
        }
    }

    /// To the clients over TCP; the JSON is handed back.
    fn tell(&self, event: &impl Serialize) -> Bytes {
        // Strings, numbers and maps with text as keys always have a JSON.
        let json = Bytes::from(serde_json::to_vec(event).unwrap_or_default());
        // Nobody may listen.
        drop(self.events.send(json.clone()));
        json
    }
}

impl Desk {
    /// Whether the port is open and the last exchange went well.
    pub(crate) fn is_online(&self) -> bool {
        *lock(&self.is_online) == Some(true)
    }

    fn is_known(&self, job: &Job) -> bool {
        let recent = lock(&self.recent);
        job.id.as_ref().is_some_and(|id| recent.contains(id))
    }

    fn hand_over(&self, job: Job) -> Result<(), Refused> {
        let id = job.id.clone();
        match self.jobs.try_send(job) {
            Ok(()) => {
                let mut recent = lock(&self.recent);
                recent.extend(id);
                while recent.len() > RECENT {
                    recent.pop_front();
                }
                Ok(())
            }
            Err(error) => {
                let message = match error {
                    mpsc::error::TrySendError::Full(_) => "too many commands wait",
                    mpsc::error::TrySendError::Closed(_) => "the gateway is stopping",
                };
                let message = message.to_owned();
                Err(Refused { id, message })
            }
        }
    }

    /// The same again within a second is counted, and told with the next.
    fn log_refusal(&self, line: &str, message: &str) {
        let mut refusals = lock(&self.refusals);
        let is_known = refusals
            .logged
            .as_ref()
            .is_some_and(|(at, last)| last == message && at.elapsed() < LOG_PAUSE);
        if is_known {
            refusals.unlogged += 1;
            return;
        }
        refusals.logged = Some((Instant::now(), message.to_owned()));
        match mem::take(&mut refusals.unlogged) {
            0 => warn!("{line}: command refused: {message}"),
            more => warn!("{line}: command refused: {message}; {more} more before this one"),
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests;
