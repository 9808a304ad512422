//! The connection to the broker: MQTT 5 or 3.1.1, everything at least once.

mod connection;
mod edge;
mod session;
mod suspect;
mod v3;
mod v5;
mod version;
mod window;

use alloc::sync::Arc;
use core::{mem, sync::atomic::Ordering, time::Duration};

use anyhow::Result;
use log::{info, warn};
use rumqttc::{TlsConfiguration, Transport};
use tokio::time::Instant;
use tokio_util::sync::CancellationToken;

pub(crate) use self::version::Version;
use self::{
    connection::{Cause, requests},
    session::{Ended, Purpose, Session},
    suspect::Suspect,
    version::{Refusal, Search},
};
use super::{
    config::{Config, Mqtt},
    hub::Hub,
    outbox::Outbox,
    sparkplug::Node,
    tls,
};

/// From one attempt to connect to the next: doubled with each, between these.
const PAUSE: (Duration, Duration) = (Duration::from_millis(250), Duration::from_secs(15));

/// A connection that is closed for no reason so soon after another one is one too many.
const THEFT: Duration = Duration::from_secs(30);

/// The settings of the connection, for each version.
pub(crate) struct Options {
    protocol: Option<Version>,
    three: rumqttc::MqttOptions,
    five: rumqttc::v5::MqttOptions,
    /// As an edge node of Sparkplug B.
    node: Option<Node>,
}

/// The settings of the connection.
///
/// # Errors
/// Those of the files that the configuration names.
pub(crate) fn options(config: &Config, mqtt: &Mqtt) -> Result<Options> {
    Ok(Options {
        protocol: mqtt.protocol,
        three: v3::options(config, mqtt)?,
        five: v5::options(config, mqtt)?,
        node: mqtt
            .sparkplug
            .as_ref()
            .map(|settings| Node::new(config, settings)),
    })
}

/// TCP, or TLS over it.
///
/// # Errors
/// Those of the files that the configuration names.
fn transport(mqtt: &Mqtt) -> Result<Transport> {
    Ok(if mqtt.broker.is_tls {
        let client = tls::client(mqtt.tls())?;
        Transport::Tls(TlsConfiguration::Rustls(Arc::new(client)))
    } else {
        Transport::Tcp
    })
}

/// Keeps the connection until `finishing` and everything is delivered.
pub(crate) async fn run(
    options: Options,
    hub: &Hub,
    outbox: &Outbox,
    finishing: &CancellationToken,
) {
    let mut broker = Broker::new(options, hub, outbox);
    while let Err(pause) = broker.connect(finishing).await {
        tokio::time::sleep(pause).await;
        broker.clean_start();
    }
}

/// What is known of the broker from one connection to the next.
struct Broker<'h> {
    options: Options,
    /// Between two connections.
    node: Option<Node>,
    hub: &'h Hub,
    outbox: &'h Outbox,
    search: Search,
    suspect: Suspect,
    /// Before the next attempt.
    pause: Duration,
    /// When the broker was last heard.
    away_since: Option<Instant>,
    /// When the broker closed a connection for no reason.
    closed_at: Option<Instant>,
    /// How long the broker keeps commands.
    max_age: Duration,
}

impl<'h> Broker<'h> {
    fn new(mut options: Options, hub: &'h Hub, outbox: &'h Outbox) -> Self {
        let max_age_s = options.five.session_expiry_interval().unwrap_or_default();
        Self {
            search: Search::new(options.protocol),
            node: options.node.take(),
            options,
            hub,
            outbox,
            suspect: Suspect::default(),
            pause: PAUSE.0,
            away_since: None,
            closed_at: None,
            max_age: Duration::from_secs(max_age_s.into()),
        }
    }

    /// One connection.
    ///
    /// # Errors
    /// It has ended, or was not made: how long to wait before the next.
    async fn connect(&mut self, finishing: &CancellationToken) -> Result<(), Duration> {
        let version = self.search.version();
        let purpose = if self.search.is_trial() {
            Purpose::Trial
        } else {
            Purpose::Work {
                careful_until: self.suspect.careful_until(),
            }
        };
        let Options { three, five, .. } = &mut self.options;
        let mut node = self.node.take();
        let requests = requests(node.as_ref());
        if let Some(node) = &mut node {
            v3::set_will(three, node.will());
            v5::set_will(five, node.death());
        }
        let mut session = Session::new(self.hub, self.outbox, version, purpose, node);
        let ended = match version {
            Version::Three => {
                let connection = v3::connection(three, requests);
                session.run(connection, finishing).await
            }
            Version::Five => {
                let connection = v5::connection(five, requests);
                session.run(connection, finishing).await
            }
        };
        self.node = session.take_node();
        self.hub.broker.is_connected.store(false, Ordering::Relaxed);
        if let Some(heard_at) = session.heard_at {
            self.away_since = Some(heard_at);
        }
        if self.search.is_trial() && session.is_connected {
            self.search.taken();
            info!(
                "broker: {version} is taken; next attempt by {}",
                self.search.version()
            );
            return Err(PAUSE.0);
        }
        match ended {
            Ok(()) => Ok(()),
            Err(error) if session.is_connected => Err(self.lost(session, error)),
            Err(error) => Err(self.refused(version, error)),
        }
    }

    /// A connection has ended.
    fn lost(&mut self, mut session: Session<'_>, mut error: Ended) -> Duration {
        self.search.taken();
        self.search.lost();
        self.pause = PAUSE.0;
        let was_idle = session.window.is_empty();
        // What is retained comes first, and may be the first that is refused.
        let first = session.window.first();
        let is_retained = first.is_some_and(|first| first.is_retained);
        let has_answered = session.has_acknowledged || is_retained && session.has_answered;
        if self.suspect.is_convicted(&session.window, has_answered)
            && let Some(message) = session.window.take_first()
        {
            let times = suspect::SUSPICIONS;
            let reason = format!("{times} times the end of a connection");
            self.hub.refused(self.outbox, message, &reason);
        }
        session.window.restore(self.outbox);
        let name = || self.options.five.client_id();
        let is_closed = was_idle && error.cause() == Cause::Closed;
        let closed_before = mem::replace(&mut self.closed_at, is_closed.then(Instant::now));
        if error.cause() == Cause::Stolen {
            error = Ended::Stolen(name());
            // Two that take it from each other are no help.
            self.pause = PAUSE.1;
        } else if is_closed && closed_before.is_some_and(|at| at.elapsed() < THEFT) {
            error = Ended::ClosedAgain(name());
        }
        self.pause(&error.to_string())
    }

    /// A connection was not made.
    fn refused(&mut self, version: Version, error: Ended) -> Duration {
        self.closed_at = None;
        let refusal = match error.cause() {
            Cause::Version => Refusal::Named,
            Cause::Closed | Cause::Garbled => Refusal::Silent,
            Cause::Other | Cause::Stolen => Refusal::Other,
        };
        self.search.refused(refusal);
        let next = self.search.version();
        if next == version {
            return self.pause(&error.to_string());
        }
        // That the other one is taken is soon known.
        info!("broker: {version}: {error}; next attempt by {next}");
        if next == Version::Three && !self.max_age.is_zero() {
            warn!("broker: {next} has no command_max_age_s: commands are not kept");
        }
        PAUSE.0
    }

    fn pause(&mut self, error: &str) -> Duration {
        let pause = self.pause;
        self.pause = (2 * pause).min(PAUSE.1);
        warn!("broker: {error}; next attempt in {pause:?}");
        pause
    }

    /// A broker that has missed the end of the connection keeps commands for too long.
    fn clean_start(&mut self) {
        let is_stale = self
            .away_since
            .is_some_and(|since| since.elapsed() >= self.max_age);
        let is_clean = self.max_age.is_zero() || is_stale;
        self.options.five.set_clean_start(is_clean);
    }
}
