//! Client and server on one line.

use core::time::Duration;

use crate::client::{Client, Outcome, SubmitError};
use crate::command::Command;
use crate::config::Config;
use crate::reaction::ReactionError;
use crate::server::{Server, ServerEvent};
use crate::source::DataSource;
use crate::telegram::{SHORT_HEADER, Telegram, is_reaction};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Client,
    Server,
}

/// What an endpoint reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the line has two sides")]
pub enum Event<'a> {
    /// How the own job ended.
    Own(Outcome<'a>),
    /// What became of the partner's command.
    Partner(ServerEvent),
}

/// Client and server on one line: the quasi-duplex case, in which the partner's command may come
/// before the reaction to the own one.
///
/// It sorts what comes in (byte 3 is 0 in reactions, a letter in commands) and sends one telegram
/// at a time, reactions first. Each side answers at most one command at a time (nesting depth 1);
/// the reaction monitoring time of the own command runs on meanwhile.
///
/// Memory: that of a [`Client<N>`] and a [`Server`] and at most 8 bytes more.
///
/// # Contract
/// After every call, poll in this order until nothing comes:
/// [`poll_transmit`](Self::poll_transmit), [`poll_event`](Self::poll_event),
/// [`poll_timeout`](Self::poll_timeout). A poll too many does nothing.
/// [`handle_timeout`](Self::handle_timeout) too early does nothing, too late only delays.
///
/// Each telegram that `poll_transmit` returns is one block for the transport, which answers
/// exactly once: [`handle_delivered`](Self::handle_delivered) or
/// [`handle_failed`](Self::handle_failed). A report comes before the blocks that were received
/// after it.
#[derive(Debug)]
pub struct Endpoint<const N: usize> {
    client: Client<N>,
    server: Server,
    /// Whose telegram the transport has.
    in_transfer: Option<Side>,
}

impl<const N: usize> Endpoint<N> {
    /// An endpoint without jobs.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            client: Client::new(config),
            server: Server::new(config),
            in_transfer: None,
        }
    }

    /// Starts a job of one's own; see [`Client::submit`].
    ///
    /// # Errors
    /// [`SubmitError`]; the running job goes on.
    pub fn submit(&mut self, command: Command, data: &[u8]) -> Result<(), SubmitError> {
        self.client.submit(command, data)
    }

    /// Whether an own job runs or its outcome waits to be polled.
    #[must_use]
    pub const fn is_busy(&self) -> bool {
        self.client.is_busy()
    }

    /// Gives the own job up; see [`Client::cancel`].
    pub fn cancel(&mut self, now: Duration) {
        self.client.cancel(now);
    }

    /// The next telegram for the transport, if it is time for one.
    #[must_use]
    pub fn poll_transmit(&mut self, now: Duration) -> Option<Telegram> {
        if self.in_transfer.is_some() {
            return None;
        }
        let (side, telegram) = match self.server.poll_transmit() {
            Some(reaction) => (Side::Server, reaction),
            None => (Side::Client, self.client.poll_transmit(now)?),
        };
        self.in_transfer = Some(side);
        Some(telegram)
    }

    /// Whether the telegram in the hands of the transport is out of date; see
    /// [`Server::wants_recall`] and [`Client::wants_recall`].
    #[must_use]
    pub const fn wants_recall(&self) -> bool {
        match self.in_transfer {
            Some(Side::Client) => self.client.wants_recall(),
            Some(Side::Server) => self.server.wants_recall(),
            None => false,
        }
    }

    /// The transport delivered the telegram.
    pub fn handle_delivered(&mut self, now: Duration) {
        match self.in_transfer.take() {
            Some(Side::Client) => self.client.handle_delivered(now),
            Some(Side::Server) => self.server.handle_delivered(now),
            None => {}
        }
    }

    /// The transport gave the telegram up; it may have arrived all the same.
    pub fn handle_failed<D: DataSource + ?Sized>(&mut self, now: Duration, source: &mut D) {
        match self.in_transfer.take() {
            Some(Side::Client) => self.client.handle_failed(now),
            Some(Side::Server) => self.server.handle_failed(source),
            None => {}
        }
    }

    /// Ends the partner's job that the source holds; see [`Server::confirm`].
    pub fn confirm<D: DataSource + ?Sized>(
        &mut self,
        result: Result<(), ReactionError>,
        source: &mut D,
    ) -> bool {
        self.server.confirm(result, source)
    }

    /// A block came from the partner.
    ///
    /// A block that is too short to decide goes to the client if a reaction is due, else to the
    /// server.
    pub fn handle_block<D: DataSource + ?Sized>(
        &mut self,
        now: Duration,
        block: &[u8],
        source: &mut D,
    ) {
        let too_short = block.len() < SHORT_HEADER;
        if is_reaction(block) || (too_short && self.client.awaits_reaction()) {
            self.client.handle_block(now, block);
        } else {
            self.server.handle_block(block, source);
        }
    }

    /// Time has passed.
    pub fn handle_timeout<D: DataSource + ?Sized>(&mut self, now: Duration, source: &mut D) {
        self.client.handle_timeout(now);
        self.server.handle_timeout(now, source);
    }

    /// When [`handle_timeout`](Self::handle_timeout) and then
    /// [`poll_transmit`](Self::poll_transmit) are due next; it may lie in the past.
    #[must_use]
    pub fn poll_timeout(&self) -> Option<Duration> {
        let (client, server) = (self.client.poll_timeout(), self.server.poll_timeout());
        client.into_iter().chain(server).min()
    }

    /// How the own job ended, or what became of the partner's commands, once; see
    /// [`Server::poll_event`] for the latter.
    #[must_use]
    pub fn poll_event(&mut self) -> Option<Event<'_>> {
        match self.server.poll_event() {
            Some(event) => Some(Event::Partner(event)),
            None => self.client.poll_event().map(Event::Own),
        }
    }
}
