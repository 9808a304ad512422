//! By a state machine of the PIO, whose words come by DMA: every edge in its cycle.

use embassy_futures::select::{Either, select};
use embassy_rp::clocks::clk_sys_freq;
use embassy_rp::dma;
use embassy_rp::pio::program::pio_asm;
use embassy_rp::pio::{
    Common, Config, Direction, FifoJoin, Instance, Pin, ShiftConfig, ShiftDirection, StateMachine,
};
use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::channel::Channel;
use embassy_time::{Instant, Timer};

use crate::{Source, Word};

/// Plays words by a state machine of the PIO: each waits, then sets the pins, to the cycle.
///
/// The [`Common`] that it was made with has to live as long as it plays.
pub struct PioPlayer<'d, PIO: Instance, const SM: usize> {
    machine: StateMachine<'d, PIO, SM>,
    dma: dma::Channel<'d>,
    tick_hz: u32,
}

/// Cycles of a word that counts down from 0.
const LEAST_CYCLES: u32 = 3;
/// Bits of a word for the cycles.
const WAIT_BITS: u32 = 24;
/// Cycles of the system's clock in a tick. A word takes three at least.
const CYCLES_PER_TICK: u32 = 10;
/// From here to the first word's begin, at most.
const DMA_MICROS: u64 = 10;
/// Words that go to the FIFO at a time: those of a block are of one time.
const AT_A_TIME: usize = 64;

/// Blocks that are put into the FIFO: at which time they will have been played, and what is so
/// then. The FIFO has room for eight.
type Played<E> = Channel<NoopRawMutex, (u64, E), 10>;

impl<'d, PIO: Instance, const SM: usize> PioPlayer<'d, PIO, SM> {
    /// A player of up to eight pins that follow each other, the first in bit 0 of the levels; all
    /// are low.
    pub fn new(
        common: &mut Common<'d, PIO>,
        mut machine: StateMachine<'d, PIO, SM>,
        pins: &[&Pin<'d, PIO>],
        dma: dma::Channel<'d>,
    ) -> Self {
        let program = pio_asm!(
            ".wrap_target",
            "    out x, 24",
            "count:",
            "    jmp x-- count",
            "    out pins, 8",
            ".wrap",
        );
        let mut config = Config::default();
        config.use_program(&common.load_program(&program.program), &[]);
        config.set_out_pins(pins);
        config.fifo_join = FifoJoin::TxOnly;
        config.shift_out = ShiftConfig {
            auto_fill: true,
            threshold: 32,
            direction: ShiftDirection::Right,
        };
        machine.set_pin_dirs(Direction::Out, pins);
        machine.set_config(&config);
        machine.set_enable(true);
        Self {
            machine,
            dma,
            tick_hz: clk_sys_freq() / CYCLES_PER_TICK,
        }
    }

    /// Ticks a second: a tenth of the system's clock.
    pub const fn tick_hz(&self) -> u32 {
        self.tick_hz
    }

    /// Plays the blocks of a source, for ever.
    pub async fn play(self, source: &impl Source) -> ! {
        let played = Played::new();
        match select(self.push(source, &played), tell(source, &played)).await {
            Either::First(never) | Either::Second(never) => never,
        }
    }

    /// Puts the words into the FIFO, and says until when they will be played: a FIFO of long words
    /// is far ahead of the pins.
    async fn push<S: Source>(mut self, source: &S, played: &Played<S::End>) -> ! {
        let micros_of = |ticks: u64| (ticks * 1_000_000).div_ceil(self.tick_hz.into());
        let (mut begin_micros, mut ticks) = (0, 0);
        let mut last: Option<S::End> = None;
        loop {
            let block = source.next_block().await;
            let (words, end) = (block.as_ref(), S::end(&block));
            if has_run_dry(&mut self.machine) {
                if let Some(last) = last {
                    source.ran_out_after(last);
                }
                (begin_micros, ticks) = (Instant::now().as_micros() + DMA_MICROS, 0);
            }
            ticks += words.iter().map(|word| u64::from(word.wait())).sum::<u64>();
            played.send((begin_micros + micros_of(ticks), end)).await;
            last = Some(end);
            for words in words.chunks(AT_A_TIME) {
                let mut encoded = [0; AT_A_TIME];
                for (place, word) in encoded.iter_mut().zip(words) {
                    *place = encode(*word);
                }
                let encoded = &encoded[..words.len()];
                let (tx, dma) = (self.machine.tx(), &mut self.dma);
                tx.dma_push(dma, encoded, false).await;
            }
        }
    }
}

/// Tells the source what has been played.
async fn tell<S: Source>(source: &S, played: &Played<S::End>) -> ! {
    loop {
        let (micros, end) = played.receive().await;
        Timer::at(Instant::from_micros(micros)).await;
        source.played(end);
    }
}

/// Whether the state machine waits for a word.
fn has_run_dry<PIO: Instance, const SM: usize>(machine: &mut StateMachine<'_, PIO, SM>) -> bool {
    // What has been is cleared first: it comes back at once where it still is so.
    machine.tx().stalled();
    machine.tx().stalled()
}

/// `out x, 24` takes the low bits, `out pins, 8` the others.
fn encode(word: Word) -> u32 {
    let cycles = word.wait() * CYCLES_PER_TICK - LEAST_CYCLES;
    cycles | u32::from(word.levels) << WAIT_BITS
}
