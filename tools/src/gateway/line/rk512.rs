//! RK512: areas of the partner, fetched in turn and on command, and those that it sends to and
//! fetches from.

use alloc::sync::Arc;
use core::{fmt, sync::atomic::Ordering, time::Duration};

use log::warn;
use rk512::{
    CallError, ReactionError,
    tokio::{Client, HeldJob},
};
use tokio::{
    sync::{Mutex, mpsc},
    time::{Instant, sleep_until, timeout},
};
use tokio_util::sync::CancellationToken;
use toml::Spanned;

use super::{
    Line,
    numbers::{Arrival, Numbers},
};
use crate::gateway::{
    area::Area,
    config,
    hub::Hub,
    job::{Action, Job},
    served::Served,
    store::{Number, StoreError},
    tap::Tapped,
    telegram::{Report, decode, hex},
    time::now,
};

/// What is next.
enum Next {
    Poll(usize),
    Job(Job),
    Stop,
}

/// Why a job was not done.
enum Failed {
    /// It cannot be, whatever the partner does.
    Refused(String),
    Call(CallError),
}

/// How long the store may take to make a job of the partner safe: less than the shortest reaction
/// monitoring time of a Siemens partner, 3 s.
const STORE_WITHIN: Duration = Duration::from_secs(2);

impl Line {
    /// Serves the line until it is lost or the gateway stops; says why.
    pub(super) async fn exchange_areas(
        &mut self,
        stream: Tapped,
        stop: &CancellationToken,
    ) -> String {
        let source = || Served {
            hub: Arc::clone(&self.hub),
            line: Arc::clone(&self.config),
            memory: self.memory.clone(),
        };
        let partner = Client::with_source(
            stream,
            self.config.config(),
            rk512::Config::DEFAULT,
            source(),
            self.hub.observer(&self.name),
        );
        let desk = Desk {
            hub: &self.hub,
            line: &self.config,
            name: &self.name,
            partner,
            served: source(),
            numbers: Mutex::new(&mut self.numbers),
        };
        // Set when the line is lost or is to be closed: no job is begun after that.
        let closing = stop.child_token();
        // Set when the last own job has ended, until when the partner's jobs are answered.
        let ended = CancellationToken::new();
        let serving = async {
            let why = desk.serve(&ended).await;
            closing.cancel();
            why
        };
        let exchanging = async {
            let why = desk.exchange(&mut self.jobs, &closing).await;
            ended.cancel();
            why
        };
        let (served, exchanged) = tokio::join!(serving, exchanging);
        drop(desk);
        self.numbers.line_was_lost();
        let why = exchanged.or(served);
        why.unwrap_or_else(|| "stopped".to_owned())
    }
}

/// The next job; commands before polls.
async fn next(
    jobs: &mut mpsc::Receiver<Job>,
    due: &[Option<Instant>],
    closing: &CancellationToken,
) -> Next {
    let first = due
        .iter()
        .enumerate()
        .filter_map(|(index, due)| Some(((*due)?, index)))
        .min();
    let poll = async {
        match first {
            Some((due, index)) => {
                sleep_until(due).await;
                index
            }
            None => core::future::pending().await,
        }
    };
    tokio::select! {
        biased;
        () = closing.cancelled() => Next::Stop,
        job = jobs.recv() => job.map_or(Next::Stop, Next::Job),
        index = poll => Next::Poll(index),
    }
}

/// Where jobs of both sides are done and written down.
struct Desk<'d> {
    hub: &'d Hub,
    line: &'d config::Line,
    name: &'d str,
    partner: Client,
    served: Served,
    /// Held while something is stored, so that areas and numbers follow each other as they are
    /// told.
    numbers: Mutex<&'d mut Numbers>,
}

impl Desk<'_> {
    /// Does own jobs until the line is lost, and says why, or is to be closed.
    async fn exchange(
        &self,
        jobs: &mut mpsc::Receiver<Job>,
        closing: &CancellationToken,
    ) -> Option<String> {
        let start = Instant::now();
        let areas = self.line.areas.iter().map(Spanned::get_ref);
        let mut due: Vec<_> = areas.map(|area| area.poll().map(|_| start)).collect();
        loop {
            let result = match next(jobs, &due, closing).await {
                Next::Stop => return None,
                Next::Poll(index) => {
                    let area = self.line.areas.get(index)?.get_ref();
                    if let (Some(due), Some(poll)) = (due.get_mut(index), area.poll()) {
                        *due = Some(Instant::now() + poll);
                    }
                    let result = self.fetch(area).await;
                    if let Err(Failed::Call(error)) = &result {
                        warn!("{}: {}: {error}", self.name, area.name);
                    }
                    result.map(|()| true)
                }
                Next::Job(Job { asked, action }) => {
                    let result = self.act(action).await;
                    let outcome = result.as_ref().map(drop).map_err(ToString::to_string);
                    self.hub.outcome(self.name, &asked, outcome).await;
                    result
                }
            };
            match result {
                Ok(true) => self.hub.online(self.name, true),
                Ok(false) | Err(Failed::Refused(_)) => {}
                Err(Failed::Call(CallError::Lost(error))) => return Some(error.to_string()),
                Err(Failed::Call(_)) => self.hub.online(self.name, false),
            }
        }
    }

    fn find(&self, name: &str) -> Result<&Area, Failed> {
        let mut areas = self.line.areas.iter().map(Spanned::get_ref);
        let found = areas.find(|area| area.name.as_str() == name);
        found.ok_or_else(|| Failed::Refused(format!("no area `{name}` on this line")))
    }

    /// Does a job; whether the partner had a part in it.
    async fn act(&self, action: Action) -> Result<bool, Failed> {
        match action {
            Action::Send(_) => {
                let error = "send is for lines of 3964r; this one has fetch and write";
                Err(Failed::Refused(error.to_owned()))
            }
            Action::Fetch { area } => {
                let area = self.find(&area)?;
                if area.served {
                    let mut numbers = self.numbers.lock().await;
                    let bytes = self.served.memory.read(area);
                    self.tell(&mut numbers, area, &bytes, None).await?;
                } else {
                    self.fetch(area).await?;
                }
                Ok(!area.served)
            }
            Action::Write { area, data } => {
                let area = self.find(&area)?;
                if area.served {
                    let mut numbers = self.numbers.lock().await;
                    let mut bytes = self.served.memory.read(area);
                    area.patch(data, &mut bytes).map_err(Failed::Refused)?;
                    self.mirror(&mut numbers, area, bytes, None).await?;
                    return Ok(false);
                }
                for (start, bytes) in area.blocks(data).map_err(Failed::Refused)? {
                    let words = u16::try_from(bytes.len() / 2).unwrap_or(u16::MAX);
                    let command = rk512::Command::send(start, words);
                    let command = command.map_err(|error| Failed::Refused(error.to_string()))?;
                    let command = command.with_coordination(area.coordination());
                    let sent = self.partner.run(command, &bytes).await;
                    sent.map_err(Failed::Call)?;
                }
                Ok(true)
            }
        }
    }

    /// Fetches an area and tells it.
    async fn fetch(&self, area: &Area) -> Result<(), Failed> {
        let command = rk512::Command::fetch(area.start.0, area.length)
            .map_err(|error| Failed::Refused(error.to_string()))?
            .with_coordination(area.coordination());
        let fetched = self.partner.run(command, &[]).await;
        let bytes = fetched.map_err(Failed::Call)?;
        self.count_received();
        let mut numbers = self.numbers.lock().await;
        let told = self.tell(&mut numbers, area, &bytes, None).await;
        told?;
        Ok(())
    }

    /// Answers the partner's jobs until the line is lost, and says why, or the last own job has
    /// ended.
    async fn serve(&self, ended: &CancellationToken) -> Option<String> {
        loop {
            let held = tokio::select! {
                held = self.partner.held() => held,
                () = ended.cancelled() => return None,
            };
            match held {
                Ok(job) => self.take(job).await,
                Err(lost) => return Some(lost.to_string()),
            }
        }
    }

    /// Makes a job of the partner safe, then lets its reaction go out.
    async fn take(&self, job: HeldJob) {
        self.hub.online(self.name, true);
        let command = job.command();
        let sent = if command.is_send() {
            self.served.memory.take_sent()
        } else {
            Vec::new()
        };
        let header: [u8; 10] = command.into();
        let identity = [&header, sent.as_slice()].concat();
        let kept = timeout(STORE_WITHIN, self.keep(&command, &sent, &identity)).await;
        if !matches!(kept, Ok(Ok(()))) {
            if kept.is_err() {
                self.hub.not_stored(self.name, &StoreError::Stalled);
            }
            if let Some(counts) = self.hub.counts(self.name) {
                counts.not_stored.fetch_add(1, Ordering::Relaxed);
            }
            // What its own store has no room for is none of the partner's mistakes.
            job.refuse(ReactionError::Stopped).await;
            return;
        }
        self.count_received();
        if job.accept().await && command.is_send() {
            let mut numbers = self.numbers.lock().await;
            numbers.acknowledged(identity, Some(Instant::now()));
        }
    }

    /// Stores what a job changes: the area, then the coordination flag.
    async fn keep(
        &self,
        command: &rk512::Command,
        sent: &[u8],
        identity: &[u8],
    ) -> Result<(), StoreError> {
        let mut numbers = self.numbers.lock().await;
        if let Some((area, range)) = self.served.find(command)
            && command.is_send()
        {
            let mut bytes = self.served.memory.read(area);
            if let Some(place) = bytes.get_mut(range)
                && place.len() == sent.len()
            {
                place.copy_from_slice(sent);
            }
            self.mirror(&mut numbers, area, bytes, Some(identity))
                .await?;
        }
        if let Some(flag) = command.coordination().flag
            && let Some((area, byte)) = self.served.find_flag(flag)
        {
            let mut bytes = self.served.memory.read(area);
            if let Some(byte) = bytes.get_mut(byte) {
                *byte |= flag.mask();
            }
            self.mirror(&mut numbers, area, bytes, None).await?;
        }
        Ok(())
    }

    /// Changes an area that is served: in the store and at the broker, then for the partner.
    async fn mirror(
        &self,
        numbers: &mut Numbers,
        area: &Area,
        bytes: Vec<u8>,
        identity: Option<&[u8]>,
    ) -> Result<(), StoreError> {
        self.tell(numbers, area, &bytes, identity).await?;
        self.served.memory.set(area, bytes);
        Ok(())
    }

    /// Tells what stands in an area, when it is safe. What a job of the partner has changed has the
    /// job's identity, by which its repeat is known.
    async fn tell(
        &self,
        numbers: &mut Numbers,
        area: &Area,
        bytes: &[u8],
        identity: Option<&[u8]>,
    ) -> Result<(), StoreError> {
        let arrival = match identity {
            // Of one whose reaction the partner has for sure an equal one is no repeat.
            Some(job) => {
                let within = self.line.mark_repeats.then_some(Duration::ZERO);
                numbers.arrival(job, within)
            }
            None => Arrival::new(numbers.next()),
        };
        let (fields, errors) = decode(&area.fields, bytes);
        let report = Report {
            event: "area",
            line: self.name,
            name: Some(area.name.as_str()),
            run: &self.hub.run,
            seq: arrival.seq,
            time: now(),
            hex: hex(bytes),
            possible_repeat: arrival.possible_repeat,
            fields,
            errors,
        };
        // A number of an area is stored like that of a telegram, so that no other run has it.
        let number = Number {
            line: self.name.to_owned(),
            seq: numbers.highest(),
            telegram: identity.map_or_else(|| numbers.last_telegram(), <[u8]>::to_vec),
            area: area
                .served
                .then(|| Box::new((area.name.to_string(), bytes.to_vec()))),
        };
        let is_repeat = arrival.possible_repeat;
        // Until it is safe; also where this future is dropped.
        numbers.open = identity.map(|_| arrival);
        if let Err(error) = self.hub.report(&report, number).await {
            self.hub.not_stored(self.name, &error);
            return Err(error);
        }
        if let Some(job) = identity {
            numbers.open = None;
            numbers.acknowledged(job.to_vec(), None);
            if is_repeat && let Some(counts) = self.hub.counts(self.name) {
                counts.repeats.fetch_add(1, Ordering::Relaxed);
            }
        }
        Ok(())
    }

    fn count_received(&self) {
        if let Some(counts) = self.hub.counts(self.name) {
            counts.received.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl From<StoreError> for Failed {
    fn from(error: StoreError) -> Self {
        Self::Refused(error.to_string())
    }
}

impl fmt::Display for Failed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(message) => f.write_str(message),
            Self::Call(error) => error.fmt(f),
        }
    }
}
