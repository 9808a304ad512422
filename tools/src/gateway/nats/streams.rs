//! The streams that keep what is published.

use core::time::Duration;

use async_nats::jetstream::{Context, stream};

use super::subject;
use crate::gateway::config::Nats;

/// Their names and what they are made with.
pub(super) struct Streams {
    name: String,
    replicas: usize,
    duplicate_window: Duration,
}

impl Streams {
    pub(super) fn new(nats: &Nats) -> Self {
        Self {
            name: nats.stream.to_string(),
            replicas: nats.replicas.get().into(),
            duplicate_window: nats.duplicate_window(),
        }
    }

    /// Makes those that are not there; others stay as they are. `topic` is where all of a gateway
    /// begin: the streams are for all gateways of its prefix.
    ///
    /// # Errors
    /// What the servers say, in a sentence.
    pub(super) async fn make(&self, context: &Context, topic: &str) -> Result<(), String> {
        let prefix = topic.rsplit_once('/').map_or("", |(prefix, _)| prefix);
        for config in self.configs(&subject(prefix)) {
            let name = config.name.clone();
            let made = context.get_or_create_stream(config).await;
            made.map_err(|error| format!("stream {name}: {error}"))?;
        }
        Ok(())
    }

    /// What happens, all of it; and what holds, the last under each subject.
    fn configs(&self, prefix: &str) -> [stream::Config; 2] {
        let Self {
            name,
            replicas,
            duplicate_window,
        } = self;
        let subjects = |ends: &[&str]| ends.iter().map(|end| format!("{prefix}.*{end}")).collect();
        let common = stream::Config {
            num_replicas: *replicas,
            duplicate_window: *duplicate_window,
            allow_direct: true,
            ..stream::Config::default()
        };
        [
            stream::Config {
                name: name.clone(),
                subjects: subjects(&[".*.telegram", ".*.telegram.*", ".*.area.*", ".*.outcome"]),
                ..common.clone()
            },
            stream::Config {
                name: format!("{name}_state"),
                subjects: subjects(&[".status", ".*.status", ".*.health", ".*.verdict"]),
                max_messages_per_subject: 1,
                ..common
            },
        ]
    }
}
