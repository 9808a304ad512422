//! One side of the line: a 3964R station, an RK512 endpoint on it, its memory and its work.

use core::error::Error;
use core::mem::take;
use core::sync::atomic::{AtomicUsize, Ordering};
use core::time::Duration;
use std::io::{ErrorKind, Read, Write};
use std::time::Instant;

use proto3964r::{Event, Station, Transmit};
use rk512::{Area, Config, DataBlock, Endpoint, MAX_TELEGRAM, Memory, Outcome};
use serialport::{ClearBuffer, SerialPort, TTYPort};

/// Bytes of the longest job and of each data block.
pub(crate) const BLOCK: usize = 512;
/// QVZ of the example: a pseudo-terminal has no bit rate, so its times are short.
pub(crate) const QVZ_MS: u16 = 100;
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
    port: TTYPort,
    start: Instant,
    station: Station<MAX_TELEGRAM>,
    endpoint: Endpoint<BLOCK>,
    /// The next one last.
    orders: Vec<Order>,
    written: bool,
    tally: Tally,
}

impl Party {
    pub(crate) fn new(
        mut port: TTYPort,
        line: proto3964r::Config,
        mut orders: Vec<Order>,
        start: Instant,
    ) -> Result<Self, Box<dyn Error + Send + Sync>> {
        orders.reverse();
        port.set_timeout(Duration::from_millis(1))?;
        let config = Config::DEFAULT
            .with_reaction_time(Duration::from_secs(2))
            .with_resync(Duration::from_millis(QVZ_MS.into()));
        Ok(Self {
            port,
            start,
            station: Station::new(line),
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

    fn micros(&self) -> u64 {
        u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX)
    }

    fn line_now(&self) -> proto3964r::Instant {
        proto3964r::Instant::from_micros(self.micros())
    }

    fn now(&self) -> rk512::Instant {
        rk512::Instant::from_micros(self.micros())
    }

    /// Bytes from the port into the station, blocks from the station into the endpoint.
    fn receive(&mut self, memory: &mut Memory<'_, 2>) -> Result<(), Box<dyn Error + Send + Sync>> {
        let mut buffer = [0; 256];
        let count = match self.port.read(&mut buffer) {
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::TimedOut => 0,
            Err(error) => return Err(error.into()),
        };
        let (line_now, now) = (self.line_now(), self.now());
        self.station
            .handle_bytes(line_now, buffer.get(..count).unwrap_or_default());
        self.station.handle_timeout(line_now);
        self.endpoint.handle_timeout(now, memory);
        while let Some(event) = self.station.poll_event() {
            match event {
                Event::Received(block) => self.endpoint.handle_block(now, block, memory),
                Event::Sent { .. } => self.endpoint.handle_delivered(now),
                Event::Failed(_) => self.endpoint.handle_failed(now, memory),
                Event::Rejected(_) => self.tally.rejected += 1,
                _ => {}
            }
            if self.endpoint.wants_recall() {
                self.station.cancel(line_now);
            }
        }
        Ok(())
    }

    /// Writes the next data, reads them back, compares; begins again when a job fails.
    fn work(&mut self) -> Result<(), Box<dyn Error + Send + Sync>> {
        let Some(order) = self.orders.last() else {
            return Ok(());
        };
        match self.endpoint.poll_outcome() {
            Some(Outcome::Sent { .. }) => self.written = true,
            Some(Outcome::Fetched { data, .. }) => {
                self.tally.different += usize::from(data != order.data);
                self.tally.done += 1;
                self.tally.bytes += 2 * data.len();
                self.written = false;
                self.orders.pop();
            }
            Some(Outcome::Failed { .. }) => {
                self.tally.failed += 1;
                self.written = false;
            }
            _ => {}
        }
        if let Some(order) = self.orders.last()
            && !self.endpoint.client().is_busy()
        {
            if self.written {
                let words = u16::try_from(order.data.len() / 2)?;
                self.endpoint.fetch(order.area, words)?;
            } else {
                self.endpoint.send(order.area, &order.data)?;
            }
        }
        Ok(())
    }

    /// Telegrams from the endpoint into the station, bytes from the station into the port.
    fn transmit(&mut self) -> Result<(), Box<dyn Error + Send + Sync>> {
        let (line_now, now) = (self.line_now(), self.now());
        if self.station.can_send()
            && let Some(telegram) = self.endpoint.poll_transmit(now)
        {
            self.station.send(line_now, &telegram)?;
        }
        let mut buffer = [0; 64];
        while let Some(transmit) = self.station.poll_transmit(line_now, &mut buffer) {
            match transmit {
                Transmit::Bytes(bytes) => self.port.write_all(bytes)?,
                Transmit::Discard => self.port.clear(ClearBuffer::Output)?,
            }
        }
        Ok(())
    }
}
