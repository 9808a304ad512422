//! One line: opened, served, and opened again.

mod numbers;
mod rk512;
mod telegrams;

use alloc::sync::Arc;
use core::{
    future::{Future, pending},
    pin::pin,
    sync::atomic::Ordering,
    time::Duration,
};

use log::{info, warn};
use tokio::{
    sync::{mpsc, watch},
    time::sleep,
};
use tokio_util::sync::CancellationToken;

use self::numbers::Numbers;
use super::{
    config::{self, Procedure},
    hub::Hub,
    job::Job,
    served::Memory,
    tap::Tap,
};
use crate::Port;

/// From one attempt to open the port to the next: doubled with each, between these.
const PAUSE: (Duration, Duration) = (Duration::from_millis(250), Duration::from_secs(10));

/// A line in its task.
pub(crate) struct Line {
    pub(super) name: String,
    pub(super) config: Arc<config::Line>,
    /// Where other settings come from.
    settings: watch::Receiver<Arc<config::Line>>,
    pub(super) hub: Arc<Hub>,
    pub(super) jobs: mpsc::Receiver<Job>,
    numbers: Numbers,
    /// What stands in the areas that are served.
    memory: Memory,
    tap: Arc<Tap>,
}

impl Line {
    pub(crate) fn new(
        mut settings: watch::Receiver<Arc<config::Line>>,
        hub: Arc<Hub>,
        jobs: mpsc::Receiver<Job>,
    ) -> Self {
        let config = Arc::clone(&settings.borrow_and_update());
        let name = config.name.get_ref().to_string();
        let desk = hub.lines.get(&name);
        let numbers = desk.map(|desk| Numbers::after(&desk.last));
        let areas = desk.map(|desk| desk.last.areas.clone());
        let tap = desk.map(|desk| Arc::clone(&desk.tap));
        Self {
            name,
            config,
            settings,
            hub,
            jobs,
            numbers: numbers.unwrap_or_default(),
            memory: Memory::new(areas.unwrap_or_default()),
            tap: tap.unwrap_or_default(),
        }
    }

    /// Works until the gateway stops.
    pub(crate) async fn run(mut self) {
        let stop = self.hub.stop.clone();
        let mut pause = PAUSE.0;
        while !stop.is_cancelled() {
            self.config = Arc::clone(&self.settings.borrow_and_update());
            let opening = unless_changed(&self.settings, self.config.port.open());
            let opened = refuse_until(opening, &mut self.jobs, &self.hub, &self.name).await;
            let Some(opened) = opened else {
                break;
            };
            let Some(opened) = opened else {
                continue;
            };
            let error = match opened {
                Ok(stream) => {
                    info!("{}: {} is open", self.name, self.config.port);
                    for (area, kept) in self.memory.of_another_length(&self.config) {
                        let (line, name, bytes) = (&self.name, &area.name, area.bytes());
                        warn!(
                            "{line}: area `{name}`: zeros, as {kept} bytes are kept, not {bytes}"
                        );
                    }
                    if let Some(counts) = self.hub.counts(&self.name) {
                        counts.opened.fetch_add(1, Ordering::Relaxed);
                    }
                    self.hub.online(&self.name, true);
                    pause = PAUSE.0;
                    self.exchange_until_changed(stream, &stop).await
                }
                Err(error) => error.to_string(),
            };
            self.hub.online(&self.name, false);
            if stop.is_cancelled() {
                break;
            }
            if self.settings.has_changed().unwrap_or_default() {
                continue;
            }
            warn!(
                "{}: {}: {error}; next attempt in {pause:?}",
                self.name, self.config.port
            );
            let pausing = unless_changed(&self.settings, sleep(pause));
            refuse_until(pausing, &mut self.jobs, &self.hub, &self.name).await;
            pause = (2 * pause).min(PAUSE.1);
        }
        self.hub.online(&self.name, false);
        self.jobs.close();
        while let Some(job) = self.jobs.recv().await {
            let error = "the gateway is stopping".to_owned();
            self.hub.outcome(&self.name, &job.asked, Err(error)).await;
        }
    }
}

impl Line {
    /// Serves the line until it is lost, its settings change or the gateway stops; says why.
    async fn exchange_until_changed(&mut self, stream: Port, stop: &CancellationToken) -> String {
        let closing = stop.child_token();
        let mut settings = self.settings.clone();
        let changing = async {
            match settings.changed().await {
                Ok(()) => closing.cancel(),
                // Nobody changes them any more.
                Err(_) => pending().await,
            }
            pending().await
        };
        // What is under way ends first.
        tokio::select! {
            why = self.exchange(stream, &closing) => why,
            never = changing => never,
        }
    }

    /// Serves the line until it is lost or is to be closed; says why.
    async fn exchange(&mut self, stream: Port, stop: &CancellationToken) -> String {
        let (hub, name) = (Arc::clone(&self.hub), self.name.clone());
        let silent_after = self.config.silent_after();
        let watching = async {
            match silent_after {
                Some(after) => hub.watch_for_silence(&name, after).await,
                None => pending().await,
            }
        };
        let stream = self
            .tap
            .listen(stream, self.config.config(), self.config.diagnose);
        let exchanging = async {
            match self.config.procedure {
                Procedure::Telegrams => self.exchange_telegrams(stream, stop).await,
                Procedure::Rk512 => self.exchange_areas(stream, stop).await,
            }
        };
        tokio::select! {
            why = exchanging => why,
            () = watching => String::new(),
        }
    }
}

/// The outcome, or `None` as soon as there are other settings.
async fn unless_changed<T>(
    settings: &watch::Receiver<Arc<config::Line>>,
    outcome: impl Future<Output = T>,
) -> Option<T> {
    // A copy: the change is taken with the settings.
    let mut settings = settings.clone();
    tokio::select! {
        outcome = outcome => Some(outcome),
        Ok(()) = settings.changed() => None,
    }
}

/// Waits until `done`, and refuses the jobs that come meanwhile: the port is not open. `None` when
/// the gateway stops.
async fn refuse_until<T>(
    done: impl Future<Output = T>,
    jobs: &mut mpsc::Receiver<Job>,
    hub: &Hub,
    line: &str,
) -> Option<T> {
    let mut done = pin!(done);
    loop {
        let job = tokio::select! {
            done = &mut done => return Some(done),
            () = hub.stop.cancelled() => return None,
            job = jobs.recv() => job?,
        };
        // Its outcome is not dropped, however long the queue of the broker is full.
        let error = "the port is not open".to_owned();
        hub.outcome(line, &job.asked, Err(error)).await;
    }
}

#[cfg(test)]
mod tests;
