//! SIGHUP: the configuration is read again, and lines that have changed are opened anew.

use alloc::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};
use core::{mem, sync::atomic::Ordering};
use std::{io, path::PathBuf};

use bytes::Bytes;
use log::{error, info, warn};
#[cfg(unix)]
use tokio::signal::unix::{Signal, SignalKind, signal};
use tokio::sync::watch;
use toml::{Spanned, Table, Value};

use super::{
    config::{Config, Line},
    discovery,
    hub::Hub,
};

/// What of a line counts from the start of the gateway only.
const KEPT_OF_A_LINE: &str = "commands";

/// The configuration that holds, and where its lines hear of another one.
pub(crate) struct Reload {
    path: PathBuf,
    tables: Tables,
    /// Topics of discovery.
    announced: BTreeSet<String>,
    lines: BTreeMap<String, watch::Sender<Arc<Line>>>,
}

/// The tables of a file as they stand there.
struct Tables {
    lines: BTreeMap<String, Table>,
    /// What of the lines counts from the start only.
    kept: BTreeMap<String, Option<Value>>,
    others: Table,
}

impl Tables {
    fn of(config: &mut Config) -> Self {
        let mut others = mem::take(&mut config.tables);
        let read = match others.remove("line") {
            Some(Value::Array(read)) => read,
            _ => Vec::new(),
        };
        let (mut lines, mut kept) = (BTreeMap::new(), BTreeMap::new());
        for line in read {
            if let Value::Table(mut line) = line
                && let Some(Value::String(name)) = line.remove("name")
            {
                kept.insert(name.clone(), line.remove(KEPT_OF_A_LINE));
                lines.insert(name, line);
            }
        }
        Self {
            lines,
            kept,
            others,
        }
    }
}

impl Reload {
    /// The state at the start, and for each line, in its order, where its settings come from.
    pub(crate) fn new(
        path: PathBuf,
        mut config: Config,
        hub: &Hub,
    ) -> (Self, Vec<watch::Receiver<Arc<Line>>>) {
        let announced = discovery::announce(&config, hub);
        let tables = Tables::of(&mut config);
        let (mut lines, mut receivers) = (BTreeMap::new(), Vec::new());
        for line in config.lines.into_iter().map(Spanned::into_inner) {
            let name = line.name.get_ref().to_string();
            let (sender, receiver) = watch::channel(Arc::new(line));
            lines.insert(name, sender);
            receivers.push(receiver);
        }
        let reload = Self {
            path,
            tables,
            announced,
            lines,
        };
        (reload, receivers)
    }

    /// Reads the file again. One that is wrong changes nothing; what counts from the start only is
    /// named.
    pub(crate) fn again(&mut self, hub: &Hub) {
        let mut config = match Config::read(&self.path) {
            Ok(config) => config,
            Err(error) => {
                error!("not read again, everything stays as it was: {error:#}");
                return;
            }
        };
        let mut new = Tables::of(&mut config);
        self.tell_what_needs_a_start(&new);
        if self.tables.others == new.others {
            self.announce(&config, hub);
        }
        let mut changed = 0;
        for line in config.lines.into_iter().map(Spanned::into_inner) {
            let name = line.name.get_ref().as_str();
            if let (Some(sender), Some(desk)) = (self.lines.get(name), hub.lines.get(name))
                && let Some(table) = new.lines.remove(name)
                && self.tables.lines.get(name) != Some(&table)
            {
                info!("{name}: has changed");
                desk.is_read_only.store(line.read_only, Ordering::Relaxed);
                self.tables.lines.insert(name.to_owned(), table);
                sender.send_replace(Arc::new(line));
                changed += 1;
            }
        }
        info!("read again: {changed} lines have changed");
    }

    /// Announces what there is now, and takes back what there is no longer.
    fn announce(&mut self, config: &Config, hub: &Hub) {
        let before = mem::replace(&mut self.announced, discovery::announce(config, hub));
        if let Some(outbox) = &hub.outbox {
            for topic in before.difference(&self.announced) {
                outbox.retain(topic.clone(), Bytes::new());
            }
        }
    }

    fn tell_what_needs_a_start(&self, new: &Tables) {
        let warn = |what: &str| warn!("{what}: counts from the next start");
        let (now, then) = (&self.tables.others, &new.others);
        let names: BTreeSet<_> = now.keys().chain(then.keys()).collect();
        for name in names {
            if now.get(name) != then.get(name) {
                warn(&format!("`{name}` has changed"));
            }
        }
        for (name, kept) in &new.kept {
            match self.tables.kept.get(name) {
                None => warn(&format!("{name}: is a new line")),
                Some(before) if before != kept => {
                    warn(&format!("{name}: `{KEPT_OF_A_LINE}` has changed"));
                }
                Some(_) => {}
            }
        }
        for name in self.tables.kept.keys() {
            if !new.kept.contains_key(name) {
                warn(&format!("{name}: is no line any more"));
            }
        }
    }
}

/// Requests to read the configuration again: SIGHUP, on Unix.
pub(crate) struct Hangups {
    #[cfg(unix)]
    signals: Signal,
}

impl Hangups {
    /// # Errors
    /// Those of the operating system.
    pub(crate) fn new() -> io::Result<Self> {
        Ok(Self {
            #[cfg(unix)]
            signals: signal(SignalKind::hangup())?,
        })
    }

    /// Returns with the next one. May be dropped and called again.
    pub(crate) async fn next(&mut self) {
        #[cfg(unix)]
        if self.signals.recv().await.is_some() {
            return;
        }
        core::future::pending::<()>().await;
    }
}
