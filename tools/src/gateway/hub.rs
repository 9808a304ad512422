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
use std::sync::{Mutex, MutexGuard, PoisonError};

use bytes::Bytes;
use log::{error, info, warn};
use monitor3964r::Diagnosis;
use proto3964r::Event;
use serde::Serialize;
use serde_json::json;
use tokio::{
    sync::{broadcast, mpsc},
    time::{Instant, sleep},
};
use tokio_util::sync::CancellationToken;

use super::{
    config::{Config, Name},
    faults::Faults,
    job::{Asked, Id, Job, Outcome, Refused, Reply},
    outbox::Outbox,
    store::{Entry, Known, Last, Message, Number, StoreError},
    tap::Tap,
    telegram::Report,
    time::now,
};
use crate::capture;

/// Events that a slow TCP client may be behind.
const TCP_QUEUE: usize = 1024;

/// Identifiers of commands that a line remembers, more than the broker hands over at once.
const RECENT: usize = 256;

/// From one attempt to store an outcome to the next.
const STORE_PAUSE: Duration = Duration::from_millis(500);

/// How soon a line that is silent is looked at again.
const SILENCE_PAUSE: Duration = Duration::from_secs(1);

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
    /// Telegrams answered NAK because they were not safe.
    pub(crate) not_stored: AtomicU64,
    /// Messages that the broker does not take.
    pub(crate) dead: AtomicU64,
    /// What the station tells.
    pub(crate) faults: Faults,
}

/// What is told of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LineState {
    /// The port is open, and the last exchange went well.
    Online,
    /// The same, and nothing has come for longer than the line should be silent.
    Silent,
    Offline,
}

/// A line as others see it.
pub(crate) struct Desk {
    pub(crate) counts: Counts,
    /// The last that was told of its state.
    state: Mutex<Option<LineState>>,
    /// When the partner was last heard.
    heard_at: Mutex<Option<Instant>>,
    /// The last telegram of the runs before.
    pub(crate) last: Last,
    pub(crate) tap: Arc<Tap>,
    jobs: mpsc::Sender<Job>,
    refusals: Mutex<Refusals>,
    /// The last commands that had an identifier.
    recent: Mutex<VecDeque<Id>>,
    /// Nothing is sent or written.
    pub(crate) is_read_only: AtomicBool,
}

/// What is refused and the log does not show one by one.
#[derive(Default)]
struct Refusals {
    /// The last that it shows.
    logged: Option<(Instant, String)>,
    unlogged: u64,
}

/// The middle of the gateway.
pub(crate) struct Hub {
    /// Prefix and name of the gateway.
    pub(crate) topic: String,
    /// What takes the messages, as metrics are named by it.
    pub(crate) broker_kind: &'static str,
    pub(crate) run: String,
    pub(crate) outbox: Option<Outbox>,
    pub(crate) events: broadcast::Sender<Bytes>,
    pub(crate) lines: BTreeMap<String, Desk>,
    pub(crate) stop: CancellationToken,
    pub(crate) broker: BrokerCounts,
    /// Of commands for no line.
    refusals: Mutex<Refusals>,
}

/// Counts of the connection to the broker.
#[derive(Default)]
pub(crate) struct BrokerCounts {
    pub(crate) is_connected: AtomicBool,
    pub(crate) connects: AtomicU64,
    pub(crate) published: AtomicU64,
    pub(crate) refused: AtomicU64,
}

impl Hub {
    /// The hub, and for each line, in its order, where its jobs come from.
    pub(crate) fn new(
        config: &Config,
        outbox: Option<Outbox>,
        mut known: Known,
    ) -> (Arc<Self>, Vec<mpsc::Receiver<Job>>) {
        let mut receivers = Vec::new();
        let mut lines = BTreeMap::new();
        for line in config.lines.iter().map(|line| line.get_ref()) {
            let (jobs, receiver) = mpsc::channel(line.commands.get().into());
            receivers.push(receiver);
            let desk = Desk {
                counts: Counts::default(),
                state: Mutex::default(),
                heard_at: Mutex::default(),
                last: known
                    .lines
                    .remove(line.name.get_ref().as_str())
                    .unwrap_or_default(),
                tap: Arc::default(),
                jobs,
                refusals: Mutex::default(),
                recent: Mutex::default(),
                is_read_only: AtomicBool::new(line.read_only),
            };
            lines.insert(line.name.get_ref().to_string(), desk);
        }
        let hub = Self {
            topic: config.topic(),
            broker_kind: config.broker().map_or("", |broker| broker.kind()),
            run: known.run,
            outbox,
            events: broadcast::channel(TCP_QUEUE).0,
            lines,
            stop: CancellationToken::new(),
            broker: BrokerCounts::default(),
            refusals: Mutex::default(),
        };
        (Arc::new(hub), receivers)
    }

    /// The counts of a line.
    pub(crate) fn counts(&self, line: &str) -> Option<&Counts> {
        self.lines.get(line).map(|desk| &desk.counts)
    }

    /// Makes what came safe, and tells it everywhere. In memory it may wait for a place; a future
    /// that is dropped may have kept it all the same.
    ///
    /// # Errors
    /// It is not safe, and was told nowhere.
    pub(crate) async fn report(
        &self,
        report: &Report<'_>,
        number: Number,
    ) -> Result<(), StoreError> {
        let payload = json(report);
        if let Some(outbox) = &self.outbox {
            let Report { event, line, .. } = report;
            let topic = match report.name {
                Some(name) => format!("{}/{line}/{event}/{name}", self.topic),
                None => format!("{}/{line}/{event}", self.topic),
            };
            let message = Message {
                topic,
                payload: payload.clone(),
                seq: Some(report.seq),
                ..Message::default()
            };
            let number = Some(number);
            outbox.push(Entry { message, number }).await?;
        }
        self.tell(payload);
        Ok(())
    }

    /// Tells what became of a job; waits until that is safe, or the gateway stops.
    pub(crate) async fn outcome(&self, line: &str, asked: &Asked, result: Result<(), String>) {
        if let Some(counts) = self.counts(line) {
            let count = if result.is_ok() {
                &counts.done
            } else {
                &counts.failed
            };
            count.fetch_add(1, Ordering::Relaxed);
        }
        let messages = self.make_outcome(line, asked, result);
        let Some(outbox) = &self.outbox else {
            return;
        };
        for message in messages {
            let number = None;
            let entry = Entry { message, number };
            while let Err(error) = outbox.push(entry.clone()).await {
                if self.stop.is_cancelled() {
                    error!("{line}: an outcome is lost: {error}");
                    return;
                }
                sleep(STORE_PAUSE).await;
            }
        }
    }

    /// The message of an outcome, which TCP has been told, and the one for whoever asked.
    fn make_outcome(
        &self,
        line: &str,
        asked: &Asked,
        result: Result<(), String>,
    ) -> impl Iterator<Item = Message> {
        let outcome = Outcome {
            event: "outcome",
            line,
            time: now(),
            id: asked.id.as_ref(),
            ok: result.is_ok(),
            error: result.as_ref().err().map(String::as_str),
        };
        let payload = json(&outcome);
        self.tell(payload.clone());
        let reply = asked.reply.as_ref().map(|reply| Message {
            topic: reply.topic.clone(),
            correlation: reply.correlation.clone(),
            payload: payload.clone(),
            ..Message::default()
        });
        let message = Message {
            topic: format!("{}/{line}/outcome", self.topic),
            payload,
            ..Message::default()
        };
        core::iter::once(message).chain(reply)
    }

    /// Tells whether a line works, where that is news.
    pub(crate) fn online(&self, line: &str, is_online: bool) {
        if is_online && let Some(desk) = self.lines.get(line) {
            *lock(&desk.heard_at) = Some(Instant::now());
        }
        let state = if is_online {
            LineState::Online
        } else {
            LineState::Offline
        };
        self.set_state(line, state);
    }

    /// Tells that the partner of a line is silent, as often as it is, for so long each time.
    pub(crate) async fn watch_for_silence(&self, line: &str, after: Duration) {
        loop {
            let heard_at = self.lines.get(line).and_then(|desk| *lock(&desk.heard_at));
            let rest = heard_at.map(|at| after.saturating_sub(at.elapsed()));
            match rest.filter(|rest| !rest.is_zero()) {
                Some(rest) => sleep(rest).await,
                None => {
                    if self.lines.get(line).is_some_and(Desk::is_online) {
                        self.set_state(line, LineState::Silent);
                    }
                    sleep(SILENCE_PAUSE.min(after)).await;
                }
            }
        }
    }

    /// What goes well and wrong on a line, for those who come later.
    pub(crate) fn retain_health(&self, line: &str, health: String) {
        if let Some(outbox) = &self.outbox {
            outbox.retain(format!("{}/{line}/health", self.topic), health.into());
        }
    }

    /// What is wrong with a line, or that it works, for those who come later.
    pub(crate) fn retain_verdict(&self, line: &str, diagnosis: Diagnosis) {
        let verdict = diagnosis.verdict;
        if verdict.is_fault() {
            warn!("{line}: {verdict} (A is the gateway)");
        } else {
            info!("{line}: {verdict}");
        }
        let told = Told {
            event: "verdict",
            line,
            time: now(),
            is_fault: verdict.is_fault(),
            report: capture::Report::new(None, diagnosis),
        };
        let payload = json(&told);
        self.tell(payload.clone());
        if let Some(outbox) = &self.outbox {
            outbox.retain(format!("{}/{line}/verdict", self.topic), payload);
        }
    }

    /// Hands what a station tells to the counts of its line.
    pub(crate) fn observer(
        self: &Arc<Self>,
        line: &str,
    ) -> impl FnMut(Event<'_>) + Send + 'static + use<> {
        let (hub, line) = (Arc::clone(self), line.to_owned());
        move |event| {
            if let Some(counts) = hub.counts(&line) {
                counts.faults.take(event);
            }
        }
    }

    fn set_state(&self, line: &str, state: LineState) {
        let Some(desk) = self.lines.get(line) else {
            return;
        };
        if lock(&desk.state).replace(state) == Some(state) {
            return;
        }
        let status = match state {
            LineState::Online => "online",
            LineState::Silent => "silent",
            LineState::Offline => "offline",
        };
        self.tell(json(&json!({
            "event": "status", "line": line, "time": now(), "status": status,
        })));
        if let Some(outbox) = &self.outbox {
            outbox.retain(format!("{}/{line}/status", self.topic), status.into());
        }
    }

    /// Hands a command to its line. One that is not taken gets an outcome, as long as there is
    /// room, and a line in the log, where the same is not repeated within a second. One that the
    /// broker may have handed over before is not run again if its `id` is known.
    pub(crate) fn command(
        &self,
        line: &str,
        payload: &[u8],
        reply: Option<Reply>,
        may_be_duplicate: bool,
    ) {
        let desk = self.lines.get(line);
        let refused = match (Job::parse(payload, reply), desk) {
            (Ok(job), Some(desk)) if may_be_duplicate && desk.is_known(&job) => {
                info!("{line}: a command that came twice is not run again");
                return;
            }
            (Ok(job), Some(desk)) => match desk.hand_over(job) {
                Ok(()) => return,
                Err(refused) => refused,
            },
            (Ok(Job { asked, .. }) | Err(Refused { asked, .. }), None) => Refused {
                asked,
                message: "there is no such line".to_owned(),
            },
            (Err(refused), Some(_)) => refused,
        };
        let Refused { asked, message } = refused;
        let shown = line.escape_default();
        let refusals = desk.map_or(&self.refusals, |desk| &desk.refusals);
        lock(refusals).log(&format!("{shown}: command refused: {message}"));
        if let Some(desk) = desk {
            desk.counts.refused.fetch_add(1, Ordering::Relaxed);
        } else if Name::try_from(line.to_owned()).is_err() {
            // No line can have that name: there is no topic for an outcome.
            return;
        }
        for message in self.make_outcome(line, &asked, Err(message)) {
            if let Some(outbox) = &self.outbox {
                outbox.offer(message);
            }
        }
    }

    /// Tells that something of a line is not safe; the same again within a second is counted.
    pub(crate) fn not_stored(&self, line: &str, error: &StoreError) {
        self.log_refusal(line, &format!("not stored: {error}"));
    }

    /// Tells that something was refused on a line; the same again within a second is counted.
    pub(crate) fn log_refusal(&self, line: &str, message: &str) {
        if let Some(desk) = self.lines.get(line) {
            lock(&desk.refusals).log(&format!("{line}: {message}"));
        }
    }

    /// The broker does not take a message. What is retained is not offered again until it is
    /// another; anything else is a dead letter.
    pub(crate) fn refused(&self, outbox: &Outbox, message: Message, reason: &str) {
        self.broker.refused.fetch_add(1, Ordering::Relaxed);
        error!("broker: refused a message to {}: {reason}", message.topic);
        if message.is_retained {
            outbox.forget_retained(&message.topic);
            return;
        }
        if let Some(desk) = self.line_of(&message.topic) {
            desk.counts.dead.fetch_add(1, Ordering::Relaxed);
        }
        outbox.refused(message, reason.to_owned());
    }

    /// The line that a message is about.
    fn line_of(&self, topic: &str) -> Option<&Desk> {
        let rest = topic.strip_prefix(&self.topic)?.strip_prefix('/')?;
        self.lines.get(rest.split('/').next()?)
    }

    /// To the clients over TCP.
    fn tell(&self, json: Bytes) {
        // Nobody may listen.
        drop(self.events.send(json));
    }
}

/// A verdict as it is told.
#[derive(Serialize)]
struct Told<'t> {
    event: &'static str,
    line: &'t str,
    time: String,
    is_fault: bool,
    #[serde(flatten)]
    report: capture::Report,
}

/// Strings, numbers and maps with text as keys always have a JSON.
fn json(event: &impl Serialize) -> Bytes {
    Bytes::from(serde_json::to_vec(event).unwrap_or_default())
}

impl Desk {
    /// Whether the port is open, the last exchange went well, and was not too long ago.
    pub(crate) fn is_online(&self) -> bool {
        *lock(&self.state) == Some(LineState::Online)
    }

    fn is_known(&self, job: &Job) -> bool {
        let recent = lock(&self.recent);
        let id = job.asked.id.as_ref();
        id.is_some_and(|id| recent.contains(id))
    }

    fn hand_over(&self, job: Job) -> Result<(), Refused> {
        let asked = job.asked.clone();
        if self.is_read_only.load(Ordering::Relaxed) && !job.action.is_reading() {
            let message = "the line is read-only".to_owned();
            return Err(Refused { asked, message });
        }
        match self.jobs.try_send(job) {
            Ok(()) => {
                let mut recent = lock(&self.recent);
                recent.extend(asked.id);
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
                Err(Refused { asked, message })
            }
        }
    }
}

impl Refusals {
    /// The same again within a second is counted, and told with the next.
    fn log(&mut self, message: &str) {
        let is_known = self
            .logged
            .as_ref()
            .is_some_and(|(at, last)| last == message && at.elapsed() < LOG_PAUSE);
        if is_known {
            self.unlogged += 1;
            return;
        }
        self.logged = Some((Instant::now(), message.to_owned()));
        match mem::take(&mut self.unlogged) {
            0 => warn!("{message}"),
            more => warn!("{message}; {more} more before this one"),
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests;
