//! Many lines to MQTT, NATS and TCP.

mod area;
mod broker;
mod config;
mod discovery;
mod faults;
mod field;
mod health;
mod hub;
mod job;
mod line;
mod metrics;
mod mqtt;
mod nats;
mod outbox;
mod reload;
mod served;
mod sparkplug;
mod store;
mod tap;
mod tcp;
mod telegram;
mod time;
mod tls;

use alloc::sync::Arc;
use core::{net::SocketAddr, pin::pin, sync::atomic::Ordering, time::Duration};
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context as _, Result};
use clap::Args;
use log::{error, info, warn};
use tokio::{
    net::{TcpListener, TcpStream},
    task::JoinSet,
    time::{Instant, sleep, timeout_at},
};
use tokio_util::sync::CancellationToken;
use toml::Spanned;

use self::{
    config::{Broker, Config, Listen, Sync},
    hub::Hub,
    line::Line,
    outbox::Outbox,
    reload::{Hangups, Reload},
    store::{DeadLetters, Known, Store},
};
use crate::runtime::{block_on, interrupted};

/// Brings lines of 3964R and RK512 to MQTT or NATS and TCP, until SIGINT or SIGTERM.
///
/// SIGHUP reads the configuration again: lines that have changed are opened anew.
///
/// What it does is logged to standard error; the environment variable `RUST_LOG` set to
/// `debug` logs more, to `warn` less.
#[derive(Args)]
pub(crate) struct Options {
    /// Configuration: see the README, and the book on the gateway.
    config: PathBuf,
    /// Only reads the configuration and the files that it names.
    #[arg(long)]
    check: bool,
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let config = Config::read(&options.config)?;
    let session = match config.broker() {
        Some(Broker::Mqtt(mqtt)) => Some(Session::Mqtt(mqtt::options(&config, mqtt)?.into())),
        Some(Broker::Nats(nats)) => Some(Session::Nats(nats::options(&config, nats)?.into())),
        None => None,
    };
    if options.check {
        return Ok(ExitCode::SUCCESS);
    }
    let environment = env_logger::Env::default().default_filter_or("info");
    env_logger::Builder::from_env(environment).init();
    // On one thread: a core carries hundreds of lines.
    block_on(async {
        // Before the store is opened, which may take a while: until then SIGHUP would be the end.
        let hangups = Hangups::new().context("SIGHUP")?;
        work(&options.config, config, session, hangups).await
    })
}

/// The settings of the connection to what takes the messages.
enum Session {
    Mqtt(Box<mqtt::Options>),
    Nats(Box<nats::Options>),
}

/// Where messages wait for the broker, and what waits there already.
///
/// # Errors
/// Those of the store.
fn keep(config: &Config) -> Result<(Option<Outbox>, Known)> {
    let Some(broker) = config.broker() else {
        return Ok((None, Known::nothing()));
    };
    let (folder, max_bytes) = (config.store_folder(), config.store_max_bytes());
    let letters = DeadLetters::new(folder.join("dead-letters.jsonl"), max_bytes);
    if config.sync() == Sync::None {
        let most = broker.queue();
        warn!(
            "messages are kept in memory, {most} at most: what waits is lost if this program ends"
        );
        let outbox = Outbox::in_memory(most, broker.overflow(), letters)?;
        return Ok((Some(outbox), Known::nothing()));
    }
    let shown = folder.display();
    let opened = Store::open(&folder, max_bytes, broker.overflow());
    let (store, known) = opened.with_context(|| shown.to_string())?;
    info!("store: {shown}, {} messages wait in it", known.messages);
    let outbox = Outbox::on_disk(store, config.sync(), letters)?;
    Ok((Some(outbox), known))
}

/// Starts everything, and ends it in order: lines, broker.
async fn work(
    path: &Path,
    config: Config,
    session: Option<Session>,
    mut hangups: Hangups,
) -> Result<ExitCode> {
    let (outbox, known) = keep(&config)?;
    let (hub, jobs) = Hub::new(&config, outbox, known);
    let mut services = JoinSet::new();
    if let Some(listener) = listen(config.tcp.as_ref().map(Spanned::get_ref)).await? {
        services.spawn(tcp::serve(listener, Arc::clone(&hub)));
    }
    if let Some(listener) = listen(config.metrics.as_ref().map(Spanned::get_ref)).await? {
        services.spawn(metrics::serve(listener, Arc::clone(&hub)));
    }
    if let Some(outbox) = &hub.outbox {
        outbox.retain(config.status_topic(), "online".into());
    }
    let watched = Arc::clone(&hub);
    services.spawn(async move { health::run(&watched).await });
    let (stop_within, status_topic) = (config.stop(), config.status_topic());
    let finishing = CancellationToken::new();
    let mut delivery = tokio::spawn(deliver(session, Arc::clone(&hub), finishing.clone()));
    let mut lines = JoinSet::new();
    let (mut reload, settings) = Reload::new(path.to_owned(), config, &hub);
    for (settings, jobs) in settings.into_iter().zip(jobs) {
        lines.spawn(Line::new(settings, Arc::clone(&hub), jobs).run());
    }
    info!("{} lines", lines.len());

    let mut interrupted = pin!(interrupted());
    loop {
        tokio::select! {
            ended = &mut interrupted => break ended?,
            () = hangups.next() => reload.again(&hub),
        }
    }
    info!("stopping, within {stop_within:?}");
    let stop_at = Instant::now() + stop_within;
    hub.stop.cancel();
    let lines_ended = timeout_at(stop_at, async {
        while lines.join_next().await.is_some() {}
    });
    let lines_ended = lines_ended.await.is_ok();
    if let Some(outbox) = &hub.outbox {
        outbox.retain(status_topic, "offline".into());
    }
    finishing.cancel();
    drop(timeout_at(stop_at, &mut delivery).await);
    delivery.abort();
    Ok(report_end(&hub, lines_ended))
}

/// What the broker has not acknowledged is in the store, or lost now.
fn report_end(hub: &Hub, lines_ended: bool) -> ExitCode {
    let published = hub.broker.published.load(Ordering::Relaxed);
    let mut status = ExitCode::SUCCESS;
    if !lines_ended {
        error!("stopped too late: a line was at work");
        status = ExitCode::FAILURE;
    }
    if let Some(outbox) = &hub.outbox {
        outbox.end();
        let (waiting, dead) = (outbox.len(), outbox.dead());
        if waiting > 0 && outbox.is_on_disk() {
            info!("{waiting} messages wait in the store");
        } else if waiting > 0 {
            error!("stopped too late: {waiting} messages were not delivered");
            status = ExitCode::FAILURE;
        }
        if dead > 0 {
            error!("{dead} messages that the broker refused are in the file of dead letters");
            status = ExitCode::FAILURE;
        }
    }
    info!("stopped, {published} messages published");
    status
}

async fn deliver(session: Option<Session>, hub: Arc<Hub>, finishing: CancellationToken) {
    let Some(outbox) = &hub.outbox else {
        return;
    };
    match session {
        Some(Session::Mqtt(options)) => mqtt::run(*options, &hub, outbox, &finishing).await,
        Some(Session::Nats(options)) => nats::run(*options, &hub, outbox, &finishing).await,
        None => {}
    }
}

async fn listen(settings: Option<&Listen>) -> Result<Option<TcpListener>> {
    let Some(Listen { listen }) = settings else {
        return Ok(None);
    };
    if !listen.ip().is_loopback() {
        warn!("{listen} is open to the network, without a password");
    }
    let listener = TcpListener::bind(listen).await;
    listener.map(Some).with_context(|| listen.to_string())
}

/// From a connection that could not be taken to the next attempt: what is missing may come back.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// The next connection to a service. May be dropped and called again.
async fn accept(listener: &TcpListener, service: &str) -> (TcpStream, SocketAddr) {
    loop {
        match listener.accept().await {
            Ok(accepted) => return accepted,
            Err(error) => warn!("{service}: {error}"),
        }
        sleep(ACCEPT_PAUSE).await;
    }
}
