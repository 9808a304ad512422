//! Step and direction pins, by a state machine of the PIO.

use board_machine::{Block, BlockEnd, Panel, Word};
use embassy_futures::select::{Either, select};
use embassy_rp::clocks::clk_sys_freq;
use embassy_rp::interrupt::typelevel::Binding;
use embassy_rp::peripherals::{PIN_2, PIN_3, PIN_4, PIN_5, PIO0};
use embassy_rp::pio::program::pio_asm;
use embassy_rp::pio::{
    Common, Config, Direction, FifoJoin, InterruptHandler, Pio, ShiftConfig, ShiftDirection,
    StateMachine,
};
use embassy_rp::{Peri, dma};
use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::channel::Channel;
use embassy_time::{Instant, Timer};

/// Step and direction of the shoulder, step and direction of the elbow.
pub type Drivers = (
    Peri<'static, PIN_2>,
    Peri<'static, PIN_3>,
    Peri<'static, PIN_4>,
    Peri<'static, PIN_5>,
);

/// Plays words: each waits, then sets the pins, to the cycle.
pub struct Player {
    machine: StateMachine<'static, PIO0, 0>,
    dma: dma::Channel<'static>,
    tick_hz: u32,
    /// The program lives as long as this.
    _pio: Common<'static, PIO0>,
}

/// Cycles of a word that counts down from 0.
const LEAST_CYCLES: u32 = 3;
/// Bits of a word for the cycles.
const WAIT_BITS: u32 = 28;

/// Cycles of the system's clock in a tick. A word takes three at least.
const CYCLES_PER_TICK: u32 = 10;
/// From here to the first word's begin, at most.
const DMA_MICROS: u64 = 10;

/// Blocks that are put into the FIFO: at which time they will have been played, and what is so then.
/// The FIFO has room for eight.
type Played = Channel<NoopRawMutex, (u64, BlockEnd), 10>;

impl Player {
    pub fn new(
        pio: Peri<'static, PIO0>,
        irqs: impl Binding<<PIO0 as embassy_rp::pio::Instance>::Interrupt, InterruptHandler<PIO0>>,
        (a, b, c, d): Drivers,
        dma: dma::Channel<'static>,
    ) -> Self {
        let Pio {
            mut common,
            sm0: mut machine,
            ..
        } = Pio::new(pio, irqs);
        let program = pio_asm!(
            ".wrap_target",
            "    out x, 28",
            "count:",
            "    jmp x-- count",
            "    out pins, 4",
            ".wrap",
        );
        let pins = [
            common.make_pio_pin(a),
            common.make_pio_pin(b),
            common.make_pio_pin(c),
            common.make_pio_pin(d),
        ];
        let pins = pins.each_ref();
        let mut config = Config::default();
        config.use_program(&common.load_program(&program.program), &[]);
        config.set_out_pins(&pins);
        config.fifo_join = FifoJoin::TxOnly;
        config.shift_out = ShiftConfig {
            auto_fill: true,
            threshold: 32,
            direction: ShiftDirection::Right,
        };
        machine.set_pin_dirs(Direction::Out, &pins);
        machine.set_config(&config);
        machine.set_enable(true);
        Self {
            machine,
            dma,
            tick_hz: clk_sys_freq() / CYCLES_PER_TICK,
            _pio: common,
        }
    }

    /// Ticks a second.
    pub const fn tick_hz(&self) -> u32 {
        self.tick_hz
    }

    /// Plays the blocks of a panel. While the planner is late the pins stay as they are: what comes
    /// then comes later, and nothing is lost.
    pub async fn play(self, panel: &Panel) -> ! {
        let played = Played::new();
        match select(self.push(panel, &played), tell(panel, &played)).await {
            Either::First(never) | Either::Second(never) => never,
        }
    }

    /// Puts the words into the FIFO, and says until when they will be played: a FIFO of long words is
    /// far ahead of the pins.
    async fn push(mut self, panel: &Panel, played: &Played) -> ! {
        let micros_of = |ticks: u64| (ticks * 1_000_000).div_ceil(self.tick_hz.into());
        let (mut begin_micros, mut ticks) = (0, 0);
        let mut last: Option<BlockEnd> = None;
        loop {
            let block = panel.next_block().await;
            if has_run_dry(&mut self.machine) {
                if let Some(last) = last {
                    panel.ran_out_after(last);
                }
                (begin_micros, ticks) = (Instant::now().as_micros() + DMA_MICROS, 0);
            }
            let mut words = [0; Block::MAX_WORDS];
            for (place, word) in words.iter_mut().zip(&block.words) {
                *place = encoded(word);
                ticks += u64::from(word.ticks);
            }
            played
                .send((begin_micros + micros_of(ticks), block.end))
                .await;
            last = Some(block.end);
            let words = &words[..block.words.len()];
            self.machine
                .tx()
                .dma_push(&mut self.dma, words, false)
                .await;
        }
    }
}

/// Tells the panel what has been played.
async fn tell(panel: &Panel, played: &Played) -> ! {
    loop {
        let (micros, end) = played.receive().await;
        Timer::at(Instant::from_micros(micros)).await;
        panel.played(end);
    }
}

/// Whether the state machine waits for a word.
fn has_run_dry(machine: &mut StateMachine<'static, PIO0, 0>) -> bool {
    // What has been is cleared first: it comes back at once where it still is so.
    machine.tx().stalled();
    machine.tx().stalled()
}

/// `out x, 28` takes the low bits, `out pins, 4` the others.
fn encoded(word: &Word) -> u32 {
    let cycles = word.ticks * CYCLES_PER_TICK - LEAST_CYCLES;
    cycles | u32::from(word.levels) << WAIT_BITS
}
