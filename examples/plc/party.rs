//! One side of the line: a 3964R station, an RK512 endpoint on it, its memory and its work.

use core::error::Error;
use core::mem::take;
use core::sync::atomic::{AtomicUsize, Ordering};
use core::time::Duration;
use std::time::Instant;

use proto3964r::{self, serialport::Driver};
use rk512::{Area, Command, Config, DataBlock, Endpoint, Event, MAX_TELEGRAM, Memory, Outcome};
use serialport::TTYPort;

/// Bytes of the longest job and of each data block.
pub(crate) const BLOCK: usize = 512;
/// QVZ of the example: a pseudo-terminal has no bit rate, so its times are short.
pub(crate) const QVZ_MS: u16 = 100;
/// How soon an order or a reaction time that ran out is noticed.
const TURN: Duration = Duration::from_millis(1);

/// Data for a DB of the partner.
pub(crate) struct Order {
    pub(crate) area: Area,
    pub(crate) data: Vec<u8>,
}

/// What a side did.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) done: usize,
    pub(crate) failed: usize,
    pub(crate) different: usize,
    pub(crate) rejected: usize,
    pub(crate) bytes: usize,
}

pub(crate) struct Party {
    start: Instant,
    line: Driver<MAX_TELEGRAM>,
    endpoint: Endpoint<BLOCK>,
    /// The next one last.
    orders: Vec<Order>,
    written: bool,
    tally: Tally,
}

impl Party {
    pub(crate) fn new(
        port: TTYPort,
        line: proto3964r::Config,
        mut orders: Vec<Order>,
        start: Instant,
    ) -> Result<Self, Box<dyn Error + Send + Sync>> {
        orders.reverse();
        let config = Config {
            reaction_time: Duration::from_secs(2),
            resync: Duration::from_millis(QVZ_MS.into()),
            ..Config::DEFAULT
        };
        Ok(Self {
            start,
            line: Driver::new(Box::new(port), line)?,
            endpoint: Endpoint::new(config),
            orders,
            written: false,
            tally: Tally::default(),
        })
    }

    /// Works until no side has anything left to do; `blocks` is the own memory. The port stays open:
    /// a closed one is an error at the other end.
    pub(crate) fn run(
        &mut self,
        blocks: &mut [[u8; BLOCK]; 2],
        working: &AtomicUsize,
    ) -> Result<Tally, Box<dyn Error + Send + Sync>> {
        let [first, second] = blocks;
        let mut memory = Memory::new([DataBlock::db(1, first), DataBlock::dx(2, second)]);
        let mut at_work = true;
        while working.load(Ordering::Relaxed) > 0 {
            self.receive(&mut memory)?;
            self.work()?;
            self.transmit()?;
            if at_work && self.orders.is_empty() {
                at_work = false;
                working.fetch_sub(1, Ordering::Relaxed);
            }
        }
        Ok(take(&mut self.tally))
    }

    fn now(&self) -> Duration {
        self.start.elapsed()
    }

    /// The next event of the line, for the endpoint.
    fn receive(&mut self, memory: &mut Memory<'_, 2>) -> Result<(), Box<dyn Error + Send + Sync>> {
        self.endpoint.handle_timeout(self.now(), memory);
        let event = self.line.wait(TURN)?;
        let now = self.start.elapsed();
        match event {
            Some(proto3964r::Event::Received(block)) => {
                self.endpoint.handle_block(now, block, memory);
            }
            Some(proto3964r::Event::Sent { .. }) => self.endpoint.handle_delivered(now),
            Some(proto3964r::Event::Failed(_)) => self.endpoint.handle_failed(now, memory),
            Some(proto3964r::Event::Rejected(_)) => self.tally.rejected += 1,
            _ => {}
        }
        Ok(())
    }

    /// Writes the next data, reads them back, compares; begins again when a job fails.
    fn work(&mut self) -> Result<(), Box<dyn Error + Send + Sync>> {
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
                    self.tally.failed += 1;
                    self.written = false;
                }
                Event::Partner(_) => {}
            }
        }
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

    /// Telegrams from the endpoint to the line, and back what is out of date.
    fn transmit(&mut self) -> Result<(), Box<dyn Error + Send + Sync>> {
        if self.endpoint.wants_recall() {
            self.line.cancel();
        }
        if !self.line.is_busy()
            && let Some(telegram) = self.endpoint.poll_transmit(self.now())
        {
            self.line.submit(&telegram)?;
        }
        Ok(())
    }
}
