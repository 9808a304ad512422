//! NATS with `JetStream`: each message once, as far back as its streams look for duplicates.
//!
//! Each message of a line waits for the answer to the one before it, and is published again under
//! its own identifier until there is one. So nothing overtakes what came before it on its line, and
//! what was stored and not answered is stored once all the same.

mod lanes;
mod streams;

use alloc::collections::BTreeSet;
use core::{sync::atomic::Ordering, time::Duration};

use anyhow::Result;
use async_nats::{
    Client, ConnectOptions, Event, ServerAddr, ServerError,
    jetstream::{
        Context, ErrorCode,
        context::{ContextBuilder, PublishError, PublishErrorKind},
        message::PublishMessage,
    },
};
use futures_util::{StreamExt as _, future::BoxFuture, stream::FuturesUnordered};
use log::{debug, error, info, warn};
use tokio::{
    sync::{mpsc, watch},
    time::{interval, sleep},
};
use tokio_util::sync::CancellationToken;

use self::{
    lanes::{Lane, Lanes},
    streams::Streams,
};
use super::{
    config::{Config, Nats},
    hub::Hub,
    job::Reply,
    outbox::Outbox,
    store::Message,
    tls,
};

/// How long an answer is waited for: an election of a leader takes some seconds, and what was
/// published before it may be lost.
const ANSWER: Duration = Duration::from_secs(3);

/// From one attempt to publish a message to the next.
const PAUSE: Duration = Duration::from_millis(500);

/// From one attempt to reach a server to the next: doubled with each, between these.
const RECONNECT: (Duration, Duration) = (Duration::from_millis(250), Duration::from_secs(4));

/// How often the status is told again: there is no will that a server would tell for a gateway that
/// is gone, but its age.
const ALIVE: Duration = Duration::from_secs(30);

/// The settings of the connection.
pub(crate) struct Options {
    connect: ConnectOptions,
    servers: Vec<ServerAddr>,
    streams: Streams,
}

/// The settings of the connection.
///
/// # Errors
/// Those of the files that the configuration names.
pub(crate) fn options(config: &Config, nats: &Nats) -> Result<Options> {
    let mut connect = ConnectOptions::new()
        .name(config.name.as_str())
        .retry_on_initial_connect()
        .reconnect_delay_callback(|attempts| {
            let doublings = u32::try_from(attempts).unwrap_or(u32::MAX).min(8);
            RECONNECT
                .1
                .min(RECONNECT.0 * 2_u32.saturating_pow(doublings))
        });
    if let Some(user) = &nats.user {
        connect = connect.user_and_password(user.clone(), nats.password()?);
    } else if let Some(token) = nats.token()? {
        connect = connect.token(token);
    }
    if nats.is_tls() {
        let client = tls::client(nats.tls())?;
        connect = connect.require_tls(true).tls_client_config(client);
    }
    Ok(Options {
        connect,
        servers: nats.servers.iter().map(|server| server.0.clone()).collect(),
        streams: Streams::new(nats),
    })
}

/// Publishes until `finishing` and everything is delivered.
pub(crate) async fn run(
    options: Options,
    hub: &Hub,
    outbox: &Outbox,
    finishing: &CancellationToken,
) {
    let Options {
        connect,
        servers,
        streams,
    } = options;
    let (told, events) = mpsc::unbounded_channel();
    let connect = connect.event_callback(move |event| {
        // Nobody may listen any more.
        drop(told.send(event));
        async {}
    });
    let client = match connect.connect(servers).await {
        Ok(client) => client,
        // It is made in the background: no server is asked before.
        Err(error) => {
            error!("broker: {error}");
            return;
        }
    };
    let (is_connected, connected) = watch::channel(false);
    let context = ContextBuilder::new()
        .timeout(ANSWER)
        .ack_timeout(ANSWER)
        .build(client.clone());
    let session = Session {
        hub,
        outbox,
        client,
        context,
        streams,
        is_connected,
        connected,
        lanes: Lanes::default(),
        under_way: FuturesUnordered::new(),
        forbidden: BTreeSet::new(),
        complaint: None,
    };
    session.work(events, finishing).await;
}

/// A message that was published, and what became of it.
struct Answered {
    lane: Lane,
    message: Message,
    result: Result<(), PublishError>,
}

struct Session<'h> {
    hub: &'h Hub,
    outbox: &'h Outbox,
    client: Client,
    context: Context,
    streams: Streams,
    is_connected: watch::Sender<bool>,
    connected: watch::Receiver<bool>,
    lanes: Lanes,
    under_way: FuturesUnordered<BoxFuture<'static, Answered>>,
    /// Subjects that the server has forbidden.
    forbidden: BTreeSet<String>,
    /// The last that was logged, until something is published.
    complaint: Option<String>,
}

impl Session<'_> {
    async fn work(
        mut self,
        mut events: mpsc::UnboundedReceiver<Event>,
        finishing: &CancellationToken,
    ) {
        let subject = subject(&format!("{}/*/command", self.hub.topic));
        let mut commands = match self.client.subscribe(subject).await {
            Ok(commands) => commands,
            Err(error) => return error!("broker: {error}"),
        };
        let mut alive = interval(ALIVE);
        alive.tick().await;
        loop {
            if finishing.is_cancelled() && self.lanes.is_empty() && self.outbox.is_empty() {
                // Answers to requests have none of their own.
                drop(self.client.flush().await);
                return;
            }
            tokio::select! {
                Some(event) = events.recv() => self.happened(event).await,
                Some(command) = commands.next() => self.command(&command),
                Some(answered) = self.under_way.next() => self.answered(answered).await,
                message = self.outbox.next(), if self.lanes.have_room() => self.take(message),
                _ = alive.tick(), if !finishing.is_cancelled() => {
                    self.outbox.retain_again(&format!("{}/status", self.hub.topic));
                }
                () = finishing.cancelled(), if !finishing.is_cancelled() => {}
            }
        }
    }

    async fn happened(&mut self, event: Event) {
        match event {
            Event::Connected => {
                self.hub.broker.is_connected.store(true, Ordering::Relaxed);
                self.hub.broker.connects.fetch_add(1, Ordering::Relaxed);
                let server = self.client.server_info();
                let (name, version) = (server.server_name, server.version);
                let waiting = self.outbox.len();
                info!("broker: connected to {name}, NATS {version}, {waiting} messages wait");
                self.forbidden.clear();
                self.make_streams().await;
                self.is_connected.send_replace(true);
            }
            Event::Disconnected => {
                self.hub.broker.is_connected.store(false, Ordering::Relaxed);
                self.is_connected.send_replace(false);
                warn!("broker: disconnected; next attempt in {:?}", RECONNECT.0);
            }
            Event::ServerError(ServerError::Other(text)) => {
                if let Some(subject) = forbidden(&text) {
                    self.forbidden.insert(subject.to_owned());
                }
                self.complain(&text);
            }
            Event::ServerError(_) | Event::ClientError(_) => self.complain(&event.to_string()),
            _ => debug!("broker: {event}"),
        }
    }

    async fn make_streams(&mut self) {
        if let Err(message) = self.streams.make(&self.context, &self.hub.topic).await {
            self.complain(&message);
        }
    }

    /// Logs what goes wrong, once until something goes well or else wrong.
    fn complain(&mut self, message: &str) {
        if self.complaint.as_deref() != Some(message) {
            warn!("broker: {message}");
            self.complaint = Some(message.to_owned());
        }
    }

    fn take(&mut self, message: Message) {
        let lane = Lane::of(&self.hub.topic, &message);
        if let Some(message) = self.lanes.push(&lane, message) {
            self.publish(lane, message, Duration::ZERO);
        }
    }

    /// Publishes a message after a pause, as soon as there is a connection.
    fn publish(&self, lane: Lane, message: Message, pause: Duration) {
        let mut connected = self.connected.clone();
        let (context, run) = (self.context.clone(), &self.hub.run);
        let id = lane.message_id(run, &message);
        let subject = lane.subject(&message);
        let is_ours = lane.is_ours();
        self.under_way.push(Box::pin(async move {
            sleep(pause).await;
            // The session ends before its sender does.
            drop(connected.wait_for(|is_connected| *is_connected).await);
            let payload = message.payload.clone();
            let result = if is_ours {
                let publish = PublishMessage::build().payload(payload);
                let publish = match id {
                    Some(id) => publish.message_id(id),
                    None => publish,
                };
                acknowledged(&context, subject, publish).await
            } else {
                // Who has asked may have left: there is no answer to wait for.
                let published = context.client().publish(subject, payload).await;
                published.map_err(|error| PublishError::with_source(PublishErrorKind::Other, error))
            };
            Answered {
                lane,
                message,
                result,
            }
        }));
    }

    async fn answered(&mut self, answered: Answered) {
        let Answered {
            lane,
            message,
            result,
        } = answered;
        match result {
            Ok(()) => {
                self.outbox.done(&message);
                self.hub.broker.published.fetch_add(1, Ordering::Relaxed);
                self.complaint = None;
            }
            Err(error) => {
                let is_forbidden = self.forbidden.contains(&lane.subject(&message));
                if is_forbidden || is_refusal(&error) {
                    let reason = if is_forbidden {
                        "the server forbids to publish it".to_owned()
                    } else {
                        error.to_string()
                    };
                    self.hub.refused(self.outbox, message, &reason);
                } else {
                    self.complain(&error.to_string());
                    if error.kind() == PublishErrorKind::StreamNotFound {
                        self.make_streams().await;
                    }
                    return self.publish(lane, message, PAUSE);
                }
            }
        }
        if let Some(next) = self.lanes.answered(&lane) {
            self.publish(lane, next, Duration::ZERO);
        }
    }

    fn command(&self, command: &async_nats::Message) {
        let mut levels = command.subject.rsplit('.');
        let (_, Some(line)) = (levels.next(), levels.next()) else {
            return;
        };
        let reply = command.reply.as_ref().map(|subject| Reply {
            topic: subject.to_string(),
            correlation: None,
        });
        self.hub.command(line, &command.payload, reply, false);
    }
}

async fn acknowledged(
    context: &Context,
    subject: String,
    publish: PublishMessage,
) -> Result<(), PublishError> {
    context.send_publish(subject, publish).await?.await?;
    Ok(())
}

/// Whether a message will never be taken.
fn is_refusal(error: &PublishError) -> bool {
    let source = core::error::Error::source(error);
    let code = source.and_then(|source| source.downcast_ref::<async_nats::jetstream::Error>());
    error.kind() == PublishErrorKind::MaxPayloadExceeded
        || code.is_some_and(|code| code.error_code() == ErrorCode::STREAM_MESSAGE_EXCEEDS_MAXIMUM)
}

/// The subject that a server forbids to publish to.
fn forbidden(text: &str) -> Option<&str> {
    let rest = text.split_once("ermissions Violation for Publish to \"")?.1;
    Some(rest.split_once('"')?.0)
}

/// Levels of a topic as those of a subject.
fn subject(topic: &str) -> String {
    topic.replace('/', ".")
}
