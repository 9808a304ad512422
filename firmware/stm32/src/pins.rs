//! Step and direction pins, by a timer whose every update makes the DMA write to the port.

use board_machine::{Block, BlockEnd, Panel};
use embassy_stm32::dma::{self, Channel, TransferOptions, WritableRingBuffer};
use embassy_stm32::gpio::{Level, Output, Pin, Speed};
use embassy_stm32::interrupt::typelevel::Binding;
use embassy_stm32::peripherals::{DMA2_CH5, PA0, PA1, PA4, PA10, TIM1};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::UpDma;
use embassy_stm32::timer::low_level::{RoundTo, Timer};
use embassy_stm32::{Peri, pac};
use heapless::Deque;
use static_cell::ConstStaticCell;

/// Step and direction of the shoulder, step and direction of the elbow.
pub type Drivers = (
    Peri<'static, PA0>,
    Peri<'static, PA1>,
    Peri<'static, PA4>,
    Peri<'static, PA10>,
);

/// Words of the port's set and reset register, one a tick: the DMA plays one half while the other
/// is filled. 2 ms.
const RING: usize = 512;
/// Filled at a time.
const CHUNK: usize = 64;
/// Blocks that the DMA has not played. One of fewer ticks than a chunk comes before a rest or a long
/// word.
const IN_FLIGHT: usize = 16;

/// Plays words, one tick after the other.
pub struct Player {
    timer: Timer<'static, TIM1>,
    ring: WritableRingBuffer<'static, u32>,
    masks: [u32; 4],
    _pins: [Output<'static>; 4],
}

impl Player {
    pub const TICK_HZ: u32 = 250_000;

    pub fn new(
        timer: Peri<'static, TIM1>,
        dma: Peri<'static, DMA2_CH5>,
        irqs: impl Binding<
            <DMA2_CH5 as dma::ChannelInstance>::Interrupt,
            dma::InterruptHandler<DMA2_CH5>,
        > + 'static,
        (a, b, c, d): Drivers,
    ) -> Self {
        static WORDS: ConstStaticCell<[u32; RING]> = ConstStaticCell::new([0; RING]);

        let masks = [a.pin(), b.pin(), c.pin(), d.pin()].map(|pin| 1 << pin);
        let output = |pin| Output::new(pin, Level::Low, Speed::Low);
        let pins: [Peri<'static, embassy_stm32::gpio::AnyPin>; 4] =
            [a.into(), b.into(), c.into(), d.into()];
        let request = UpDma::<TIM1>::request(&*dma);
        let port = pac::GPIOA.bsrr().as_ptr().cast();
        // SAFETY: that register takes any word at any time; only pins of the mask are set in them.
        let ring = unsafe {
            let channel = Channel::new(dma, irqs);
            WritableRingBuffer::new(
                channel,
                request,
                port,
                WORDS.take(),
                TransferOptions::default(),
            )
        };
        let timer = Timer::new(timer);
        timer.set_frequency(Hertz(Self::TICK_HZ), RoundTo::Slower);
        timer.enable_update_dma(true);
        Self {
            timer,
            ring,
            masks,
            _pins: pins.map(output),
        }
    }

    /// Plays the blocks of a panel. While the planner is late the pins stay as they are: what comes
    /// then comes later, and nothing is lost.
    pub async fn play(mut self, panel: &Panel) -> ! {
        let mut source = Source::new();
        let mut in_flight = Deque::<(u64, BlockEnd), IN_FLIGHT>::new();
        let mut written = 0;
        self.ring.start();
        self.timer.start();
        loop {
            let mut chunk = [0; CHUNK];
            for (place, tick) in chunk.iter_mut().zip(written..) {
                if source.is_empty() && !in_flight.is_full() {
                    source.next_block(panel);
                }
                if let Some(levels) = source.tick() {
                    *place = self.port_word(levels);
                }
                if let Some(end) = source.take_end() {
                    // There is room: else no block would have been taken.
                    let _ = in_flight.push_back((tick, end));
                }
            }
            if self.ring.write_exact(&chunk).await.is_err() {
                // The DMA has come round to words that it has played before.
                self.timer.stop();
                panic!("the pins were not served in time");
            }
            written += CHUNK as u64;
            while let Some(&(tick, end)) = in_flight.front()
                && tick + (RING as u64) < written
            {
                panel.played(end);
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

/// Blocks tick by tick.
struct Source {
    block: Block,
    next: usize,
    /// Of the next word.
    ticks_left: u32,
    /// The panel has been told that there is no block.
    ran_out: bool,
    end: Option<BlockEnd>,
}

impl Source {
    /// At rest.
    fn new() -> Self {
        Self {
            block: Block::default(),
            next: 0,
            ticks_left: 0,
            ran_out: true,
            end: None,
        }
    }

    fn is_empty(&self) -> bool {
        self.next >= self.block.words.len()
    }

    fn next_block(&mut self, panel: &Panel) {
        match panel.try_next_block() {
            Some(block) => {
                self.ticks_left = block.words.first().map_or(0, |word| word.ticks);
                (self.block, self.next, self.ran_out) = (block, 0, false);
            }
            None if !self.ran_out => {
                self.ran_out = true;
                panel.ran_out_after(self.block.end);
            }
            None => {}
        }
    }

    /// One tick: levels of the pins, if they change.
    fn tick(&mut self) -> Option<u8> {
        let word = self.block.words.get(self.next)?;
        self.ticks_left -= 1;
        if self.ticks_left > 0 {
            return None;
        }
        self.next += 1;
        match self.block.words.get(self.next) {
            Some(next) => self.ticks_left = next.ticks,
            None => self.end = Some(self.block.end),
        }
        Some(word.levels)
    }

    /// The end of the block, once.
    fn take_end(&mut self) -> Option<BlockEnd> {
        self.end.take()
    }
}
