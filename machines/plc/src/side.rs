//! One side of the line: an RK512 endpoint, its memory and its work. Its 3964R station is the
//! caller's.

use core::time::Duration;

use anyhow::{Result, ensure};
use proto3964r::{Event as LineEvent, Line, Priority};
use rk512::{Command, Config, DataBlock, Endpoint, Event, Memory, Outcome, Telegram};
use serde::Serialize;

use crate::order::{BLOCK, Blocks, Order, expected, orders};

/// What a side did.
#[derive(Debug, Default, Clone, Copy, Serialize)]
pub(crate) struct Tally {
    /// Data blocks that were written and read back.
    pub(crate) done: usize,
    /// Of their data, both ways.
    pub(crate) bytes: usize,
    /// Data blocks that read back otherwise than they were written.
    pub(crate) different: usize,
    pub(crate) jobs_repeated: usize,
    pub(crate) blocks_rejected: usize,
}

/// QVZ; the line may have no bit rate, so its times are short.
const QVZ_MS: u16 = 100;

/// Which side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(clippy::exhaustive_enums, reason = "a line has two ends")]
pub enum Role {
    /// The PC, of high priority.
    Pc,
    /// The PLC, of low priority.
    Plc,
}

impl Role {
    /// The settings of its 3964R station on such a line.
    #[must_use]
    pub const fn line_config(self, line: Line) -> proto3964r::Config {
        let priority = match self {
            Self::Pc => Priority::High,
            Self::Plc => Priority::Low,
        };
        proto3964r::Config {
            qvz_ms: QVZ_MS,
            zvz_ms: QVZ_MS / 2,
            bwz_ms: 4 * QVZ_MS,
            ..proto3964r::Config::siemens_3964r(priority, line)
        }
    }

    /// A byte of its data that the partner's have not.
    const fn salt(self) -> u8 {
        match self {
            Self::Pc => 0xA1,
            Self::Plc => 0xB2,
        }
    }
}

/// A side that writes data blocks of its partner, reads them back, compares, and repeats a job that
/// failed; its own memory takes what the partner writes.
///
/// ```text
/// loop { event of the station -> handle; wants_recall -> cancel; poll_transmit -> submit }
/// ```
#[derive(Debug)]
pub struct Side {
    role: Role,
    rounds: u8,
    endpoint: Endpoint<BLOCK>,
    memory: Blocks,
    /// The next one last.
    orders: Vec<Order>,
    written: bool,
    tally: Tally,
}

impl Side {
    /// The most rounds: each begins one word further on in the data blocks.
    pub const MAX_ROUNDS: u8 = 60;

    /// A side with a number of data blocks to write and to read back.
    ///
    /// # Errors
    /// More than [`Self::MAX_ROUNDS`].
    pub fn new(role: Role, rounds: u8) -> Result<Self> {
        let most = Self::MAX_ROUNDS;
        ensure!(rounds <= most, "{rounds} rounds: at most {most}");
        let mut orders = orders(rounds, role.salt());
        orders.reverse();
        let config = Config {
            reaction_time: Duration::from_secs(2),
            resync: Duration::from_millis(QVZ_MS.into()),
            ..Config::DEFAULT
        };
        Ok(Self {
            role,
            rounds,
            endpoint: Endpoint::new(config),
            memory: [[0; BLOCK]; 2],
            orders,
            written: false,
            tally: Tally::default(),
        })
    }

    /// Takes what its station reports, or nothing but the time.
    ///
    /// # Errors
    /// A job cannot be asked for.
    pub fn handle(&mut self, now: Duration, event: Option<LineEvent<'_>>) -> Result<()> {
        let [db, dx] = &mut self.memory;
        let mut memory = Memory::new([DataBlock::db(1, db), DataBlock::dx(2, dx)]);
        self.endpoint.handle_timeout(now, &mut memory);
        match event {
            Some(LineEvent::Received(block)) => {
                self.endpoint.handle_block(now, block, &mut memory);
            }
            Some(LineEvent::Sent { .. }) => self.endpoint.handle_delivered(now),
            Some(LineEvent::Failed(_)) => self.endpoint.handle_failed(now, &mut memory),
            Some(LineEvent::Rejected(_)) => self.tally.blocks_rejected += 1,
            _ => {}
        }
        self.note_outcomes();
        self.submit_next()
    }

    /// When [`Self::handle`] is due though the station reports nothing.
    #[must_use]
    pub fn poll_timeout(&self) -> Option<Duration> {
        self.endpoint.poll_timeout()
    }

    /// Whether the telegram that the station has is out of date.
    #[must_use]
    pub const fn wants_recall(&self) -> bool {
        self.endpoint.wants_recall()
    }

    /// The next telegram for the station; only asked for while that has none.
    pub fn poll_transmit(&mut self, now: Duration) -> Option<Telegram> {
        self.endpoint.poll_transmit(now)
    }

    /// Whether all is written and read back; the partner may still want answers.
    #[must_use]
    pub const fn is_done(&self) -> bool {
        self.orders.is_empty()
    }

    pub(crate) const fn tally(&self) -> Tally {
        self.tally
    }

    /// Whether the memory holds what the partner had to write.
    pub(crate) fn holds_all_of(&self, partner: &Self) -> bool {
        self.memory == expected(&orders(partner.rounds, partner.role.salt()))
    }

    fn note_outcomes(&mut self) {
        while let Some(event) = self.endpoint.poll_event() {
            match event {
                Event::Own(Outcome::Sent { .. }) => self.written = true,
                Event::Own(Outcome::Fetched { data, .. }) => {
                    let order = self.orders.pop();
                    let differs = order.is_none_or(|order| data != order.data);
                    self.tally.different += usize::from(differs);
                    self.tally.done += 1;
                    self.tally.bytes += 2 * data.len();
                    self.written = false;
                }
                Event::Own(_) => {
                    self.tally.jobs_repeated += 1;
                    self.written = false;
                }
                Event::Partner(_) => {}
            }
        }
    }

    /// Writes the next data, or reads them back.
    fn submit_next(&mut self) -> Result<()> {
        if let Some(order) = self.orders.last()
            && !self.endpoint.is_busy()
        {
            let words = u16::try_from(order.data.len() / 2)?;
            if self.written {
                let read_back = Command::fetch(order.area, words)?;
                self.endpoint.submit(read_back, &[])?;
            } else {
                let write = Command::send(order.area, words)?;
                self.endpoint.submit(write, &order.data)?;
            }
        }
        Ok(())
    }
}
