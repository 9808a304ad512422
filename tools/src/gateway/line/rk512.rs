//! RK512: areas of the partner, fetched in turn and on command.

use core::{fmt, sync::atomic::Ordering, time::Duration};

use log::warn;
use rk512::{CallError, tokio::Client};
use serde_json::{Map, Value};
use tokio::time::{Instant, sleep_until};
use tokio_util::sync::CancellationToken;

use super::Line;
use crate::gateway::{
    area::Area,
    hub,
    job::{Action, Data, Job},
    tap::Tapped,
    telegram::{Report, decode, hex},
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

impl Line {
    /// Serves the line until it is lost or the gateway stops; says why.
    pub(super) async fn exchange_areas(
        &mut self,
        stream: Tapped,
        stop: &CancellationToken,
    ) -> String {
        let config = rk512::Config::DEFAULT;
        let observer = self.hub.observer(&self.name);
        let partner = Client::with_observer(stream, self.config.config(), config, observer);
        let start = Instant::now();
        let areas = self.config.areas.iter().map(|area| area.get_ref());
        let mut due: Vec<_> = areas.map(|area| area.poll().map(|_| start)).collect();
        loop {
            let result = match self.next(&due, stop).await {
                Next::Stop => return "stopped".to_owned(),
                Next::Poll(index) => {
                    if let (Some(due), Some(poll)) = (due.get_mut(index), self.poll(index)) {
                        *due = Some(Instant::now() + poll);
                    }
                    let result = self.fetch(&partner, index).await;
                    if let Err(Failed::Call(error)) = &result {
                        warn!("{}: {}: {error}", self.name, self.area_name(index));
                    }
                    result
                }
                Next::Job(Job { asked, action }) => {
                    let result = self.act(&partner, action).await;
                    let outcome = result.as_ref().copied().map_err(ToString::to_string);
                    self.hub.outcome(&self.name, &asked, outcome).await;
                    result
                }
            };
            match result {
                Ok(()) => self.hub.online(&self.name, true),
                Err(Failed::Refused(_)) => {}
                Err(Failed::Call(CallError::Lost(error))) => return error.to_string(),
                Err(Failed::Call(_)) => self.hub.online(&self.name, false),
            }
        }
    }

    /// Commands before polls.
    async fn next(&mut self, due: &[Option<Instant>], stop: &CancellationToken) -> Next {
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
            () = stop.cancelled() => Next::Stop,
            job = self.jobs.recv() => job.map_or(Next::Stop, Next::Job),
            index = poll => Next::Poll(index),
        }
    }

    fn area(&self, index: usize) -> Option<&Area> {
        self.config.areas.get(index).map(|area| area.get_ref())
    }

    fn poll(&self, index: usize) -> Option<Duration> {
        self.area(index)?.poll()
    }

    fn area_name(&self, index: usize) -> &str {
        self.area(index).map_or("", |area| area.name.as_str())
    }

    fn find(&self, name: &str) -> Result<usize, Failed> {
        let mut areas = self.config.areas.iter();
        let found = areas.position(|area| area.get_ref().name.as_str() == name);
        found.ok_or_else(|| Failed::Refused(format!("no area `{name}` on this line")))
    }

    async fn act(&mut self, partner: &Client, action: Action) -> Result<(), Failed> {
        match action {
            Action::Send(_) => {
                let error = "send is for lines of 3964r; this one has fetch and write";
                Err(Failed::Refused(error.to_owned()))
            }
            Action::Fetch { area } => {
                let index = self.find(&area)?;
                self.fetch(partner, index).await
            }
            Action::Write { area, data } => {
                let index = self.find(&area)?;
                let Some(area) = self.area(index) else {
                    return Ok(());
                };
                for (start, bytes) in area.blocks(data).map_err(Failed::Refused)? {
                    partner.send(start, &bytes).await.map_err(Failed::Call)?;
                }
                Ok(())
            }
        }
    }

    /// Fetches an area and tells it.
    async fn fetch(&mut self, partner: &Client, index: usize) -> Result<(), Failed> {
        let Some(area) = self.config.areas.get(index).map(|area| area.get_ref()) else {
            return Ok(());
        };
        let fetched = partner.fetch(area.start.0, area.length).await;
        let bytes = fetched.map_err(Failed::Call)?;
        if let Some(counts) = self.hub.counts(&self.name) {
            counts.received.fetch_add(1, Ordering::Relaxed);
        }
        let seq = self.numbers.next();
        let (fields, errors) = decode(&area.fields, &bytes);
        let report = Report {
            event: "area",
            line: &self.name,
            name: Some(area.name.as_str()),
            run: &self.hub.run,
            seq,
            time: hub::now(),
            hex: hex(&bytes),
            possible_repeat: false,
            fields,
            errors,
        };
        // A number of an area is stored like that of a telegram, so that no other run has it.
        let stored = self.hub.report(&report, Some(&[])).await;
        stored.map_err(|error| {
            self.hub.not_stored(&self.name, &error);
            Failed::Refused(error.to_string())
        })
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

impl Area {
    /// What is to be written where, in whole words.
    fn blocks(&self, data: Data) -> Result<Vec<(rk512::Area, Vec<u8>)>, String> {
        let name = &self.name;
        if !self.writable {
            return Err(format!("`{name}` is not writable"));
        }
        match data {
            Data::Bytes(bytes) if bytes.is_empty() || bytes.len() > self.bytes() => {
                let (len, most) = (bytes.len(), self.bytes());
                Err(format!("{len} bytes for `{name}`, 2 to {most} fit"))
            }
            Data::Bytes(bytes) => Ok(vec![(self.start.0, bytes)]),
            Data::Fields(fields) => self.field_blocks(&fields),
        }
    }

    fn field_blocks(
        &self,
        values: &Map<String, Value>,
    ) -> Result<Vec<(rk512::Area, Vec<u8>)>, String> {
        let mut blocks = Vec::new();
        for (name, value) in values {
            let mut fields = self.fields.iter().map(|field| field.get_ref());
            let field = fields
                .find(|field| field.name.as_str() == name)
                .ok_or_else(|| format!("no field `{name}` in `{}`", self.name))?;
            if !field.is_made_of_words() {
                return Err(format!("`{name}` is not made of whole words"));
            }
            let bytes = field
                .encode(value)
                .map_err(|error| format!("`{name}`: {error}"))?;
            blocks.push((self.place(field.range().start / 2)?, bytes));
        }
        Ok(blocks)
    }

    /// The address of a word of the area.
    fn place(&self, word: usize) -> Result<rk512::Area, String> {
        let start = self.start.0;
        let word = u8::try_from(usize::from(start.start()) + word)
            .map_err(|_| format!("no address for word {word} of `{}`", self.name))?;
        rk512::Area::new(start.kind(), start.number(), word).map_err(|error| error.to_string())
    }
}
