//! Many lines to MQTT and to TCP.

mod area;
mod broker;
mod config;
mod discovery;
mod field;
mod hub;
mod job;
mod line;
mod metrics;
mod mqtt;
mod outbox;
mod tcp;
mod telegram;

use alloc::sync::Arc;
use core::{net::SocketAddr, sync::atomic::Ordering, time::Duration};
use std::{path::PathBuf, process::ExitCode};

use anyhow::{Context as _, Result};
use clap::Args;
use log::{error, info, warn};
use tokio::{
    net::{TcpListener, TcpStream},
    task::JoinSet,
    time::{sleep, timeout},
};
use tokio_util::sync::CancellationToken;

use self::{
    config::{Config, Listen},
    hub::Hub,
    line::Line,
};
use crate::cli::{block_on, interrupted};

/// Brings lines of 3964R and RK512 to MQTT and TCP, until SIGINT or SIGTERM.
///
/// What it does is logged to standard error; the environment variable `RUST_LOG` set to
/// `debug` logs more, to `warn` less.
#[derive(Args)]
pub(crate) struct Options {
    /// Configuration: see the README and docs/gateway.md.
    config: PathBuf,
    /// Only reads the configuration and the files that it names.
    #[arg(long)]
    check: bool,
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let config = Config::read(&options.config)?;
    let (hub, jobs) = Hub::new(&config);
    let session = match config.mqtt() {
        Some(mqtt) => Some(mqtt::options(&config, mqtt, &hub)?),
        None => None,
    };
    if options.check {
        return Ok(ExitCode::SUCCESS);
    }
    let environment = env_logger::Env::default().default_filter_or("info");
    env_logger::Builder::from_env(environment).init();
    // On one thread: a core carries hundreds of lines.
    block_on(work(config, hub, jobs, session))
}

/// Starts everything, and ends it in order: lines, broker.
async fn work(
    config: Config,
    hub: Arc<Hub>,
    jobs: Vec<tokio::sync::mpsc::Receiver<job::Job>>,
    session: Option<rumqttc::v5::MqttOptions>,
) -> Result<ExitCode> {
    let mut services = JoinSet::new();
    if let Some(listener) = listen(config.tcp.as_ref()).await? {
        services.spawn(tcp::serve(listener, Arc::clone(&hub)));
    }
    if let Some(listener) = listen(config.metrics.as_ref()).await? {
        services.spawn(metrics::serve(listener, Arc::clone(&hub)));
    }
    if let (Some(outbox), Some(mqtt)) = (&hub.outbox, config.mqtt()) {
        outbox.retain(hub.status_topic(), "online".into());
        if let Some(prefix) = &mqtt.discovery {
            discovery::announce(&config, prefix, &hub, outbox);
        }
    }
    let stop_within = config.stop();
    let finishing = CancellationToken::new();
    let mut delivery = tokio::spawn(deliver(session, Arc::clone(&hub), finishing.clone()));
    let mut lines = JoinSet::new();
    for (line, jobs) in config.lines.into_iter().zip(jobs) {
        lines.spawn(Line::new(line.into_inner(), Arc::clone(&hub), jobs).run());
    }
    info!("{} lines", lines.len());

    interrupted().await?;
    info!("stopping, within {stop_within:?}");
    hub.stop.cancel();
    let ending = async {
        while lines.join_next().await.is_some() {}
        if let Some(outbox) = &hub.outbox {
            outbox.retain(hub.status_topic(), "offline".into());
        }
        finishing.cancel();
        drop((&mut delivery).await);
    };
    let in_time = timeout(stop_within, ending).await.is_ok();
    Ok(report_end(&hub, in_time))
}

/// Whatever the broker has not acknowledged is lost now.
fn report_end(hub: &Hub, in_time: bool) -> ExitCode {
    let lost = hub.outbox.as_ref().map_or(0, outbox::Outbox::len);
    let published = hub.broker.published.load(Ordering::Relaxed);
    if in_time && lost == 0 {
        info!("stopped, {published} messages published");
        return ExitCode::SUCCESS;
    }
    error!("stopped too late: {lost} messages were not delivered, {published} were");
    ExitCode::FAILURE
}

async fn deliver(
    session: Option<rumqttc::v5::MqttOptions>,
    hub: Arc<Hub>,
    finishing: CancellationToken,
) {
    if let (Some(options), Some(outbox)) = (session, &hub.outbox) {
        mqtt::run(options, &hub, outbox, &finishing).await;
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
