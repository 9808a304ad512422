//! By a timer whose every update makes the DMA write to the port: every edge in its tick.

use core::fmt::{self, Display, Formatter};

use embassy_stm32::Peri;
use embassy_stm32::dma::{self, Channel, TransferOptions, WritableRingBuffer};
use embassy_stm32::gpio::{AnyPin, Level, Output, Pin, Speed};
use embassy_stm32::interrupt::typelevel::Binding;
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::{RoundTo, Timer};
use embassy_stm32::timer::{BasicInstance, UpDma};
use heapless::Deque;

use crate::Source;
use crate::ticks::Ticks;

/// Words of the port's set and reset register, one a tick: the DMA plays one half while the other
/// is filled. 2 ms at 250 kHz.
pub const RING: usize = 512;
/// Filled at a time.
const CHUNK: usize = 64;
/// Blocks that the DMA has not played. One of fewer ticks than a chunk comes before a rest or a
/// long word.
const IN_FLIGHT: usize = 16;

/// Pins that are not of one port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PinsError {
    /// The first such pin, from 0.
    pub index: usize,
}

impl Display for PinsError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { index } = self;
        write!(f, "pin {index} is of another port than pin 0")
    }
}

impl core::error::Error for PinsError {}

/// Plays words by a timer and the DMA, one tick after the other.
pub struct DmaPlayer<'d, T: BasicInstance, const P: usize> {
    timer: Timer<'d, T>,
    ring: WritableRingBuffer<'d, u32>,
    masks: [u32; P],
    _pins: [Output<'d>; P],
}

impl<'d, T: BasicInstance, const P: usize> DmaPlayer<'d, T, P> {
    /// A player of up to eight pins of one port, the first in bit 0 of the levels; all are low.
    /// `dma` has to reach the port: on an STM32F4 that is a stream of DMA2.
    ///
    /// # Errors
    /// [`PinsError`].
    pub fn new<D: UpDma<T>>(
        timer: Peri<'d, T>,
        dma: Peri<'d, D>,
        irqs: impl Binding<D::Interrupt, dma::InterruptHandler<D>> + 'd,
        pins: [Peri<'d, AnyPin>; P],
        words: &'d mut [u32; RING],
        tick_hz: u32,
    ) -> Result<Self, PinsError> {
        const { assert!(0 < P && P <= 8, "levels are of one to eight pins") };
        let of_port = pins[0].port();
        if let Some(index) = pins.iter().position(|pin| pin.port() != of_port) {
            return Err(PinsError { index });
        }
        let masks = pins.each_ref().map(|pin| 1 << pin.pin());
        let port = pins[0].block().bsrr().as_ptr().cast();
        let request = dma.request();
        // SAFETY: that register takes any word at any time; only pins of the mask are set in them.
        let ring = unsafe {
            let channel = Channel::new(dma, irqs);
            WritableRingBuffer::new(channel, request, port, words, TransferOptions::default())
        };
        let timer = Timer::new(timer);
        timer.set_frequency(Hertz(tick_hz), RoundTo::Slower);
        timer.enable_update_dma(true);
        Ok(Self {
            timer,
            ring,
            masks,
            _pins: pins.map(|pin| Output::new(pin, Level::Low, Speed::Low)),
        })
    }

    /// Plays the blocks of a source, for ever.
    ///
    /// # Panics
    /// Where it has not run for as long as the ring takes: the DMA has come round to words that it
    /// has played before. The pins have stopped then.
    pub async fn play<S: Source>(mut self, source: &S) -> ! {
        let mut ticks = Ticks::new();
        let mut in_flight = Deque::<(u64, S::End), IN_FLIGHT>::new();
        let mut written = 0;
        self.ring.start();
        self.timer.start();
        loop {
            let mut chunk = [0; CHUNK];
            let mut free = &mut chunk[..];
            while !free.is_empty() {
                if ticks.is_empty() && !in_flight.is_full() {
                    ticks.next_block(source);
                }
                let (passed, levels) = ticks.advance(free.len() as u32);
                let (places, rest) = free.split_at_mut(passed as usize);
                free = rest;
                if let (Some(levels), Some(place)) = (levels, places.last_mut()) {
                    *place = self.port_word(levels);
                }
                if let Some(end) = ticks.take_end() {
                    let tick = written + (CHUNK - free.len()) as u64 - 1;
                    // There is room: else no block would have been taken.
                    let _ = in_flight.push_back((tick, end));
                }
            }
            if self.ring.write_exact(&chunk).await.is_err() {
                self.timer.stop();
                panic!("the pins were not served in time");
            }
            written += CHUNK as u64;
            while let Some(&(tick, end)) = in_flight.front()
                && tick + (RING as u64) < written
            {
                source.played(end);
                in_flight.pop_front();
            }
        }
    }

    /// Set bits below, reset bits above.
    fn port_word(&self, levels: u8) -> u32 {
        let pins = self.masks.iter().enumerate();
        pins.fold(0, |word, (bit, mask)| {
            word | if levels >> bit & 1 == 1 {
                *mask
            } else {
                mask << 16
            }
        })
    }
}
