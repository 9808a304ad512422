//! Step and direction pins, by a state machine of the PIO.

use arm_machine::{Block, Panel, Word};
use embassy_rp::Peri;
use embassy_rp::dma::Channel;
use embassy_rp::interrupt::typelevel::Binding;
use embassy_rp::peripherals::{PIN_2, PIN_3, PIN_4, PIN_5, PIO0};
use embassy_rp::pio::program::pio_asm;
use embassy_rp::pio::{
    Common, Config, Direction, FifoJoin, InterruptHandler, Pio, ShiftConfig, ShiftDirection,
    StateMachine,
};
use embassy_time::Timer;

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
    dma: Channel<'static>,
    /// The program lives as long as this.
    _pio: Common<'static, PIO0>,
}

/// Cycles of a word that counts down from 0.
const LEAST_CYCLES: u32 = 3;
/// Bits of a word for the cycles.
const WAIT_BITS: u32 = 28;

impl Player {
    /// Cycles of the system's clock in a tick. A word takes three at least.
    pub const CYCLES_PER_TICK: u32 = 10;

    pub fn new(
        pio: Peri<'static, PIO0>,
        irqs: impl Binding<<PIO0 as embassy_rp::pio::Instance>::Interrupt, InterruptHandler<PIO0>>,
        (a, b, c, d): Drivers,
        dma: Channel<'static>,
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
            _pio: common,
        }
    }

    /// Plays the blocks of a panel. While the planner is late the pins stay as they are: what comes
    /// then comes later, and nothing is lost.
    pub async fn play(mut self, panel: &Panel) -> ! {
        loop {
            let block = panel.next_block().await;
            let mut words = [0; Block::MAX_WORDS];
            for (place, word) in words.iter_mut().zip(&block.words) {
                *place = encoded(word);
            }
            let words = &words[..block.words.len()];
            self.machine
                .tx()
                .dma_push(&mut self.dma, words, false)
                .await;
            // Of what the state machine has seen before, nothing counts.
            self.machine.tx().stalled();
            while panel.has_no_block() {
                if self.machine.tx().empty() && self.machine.tx().stalled() {
                    panel.ran_out_after(block.end);
                    break;
                }
                Timer::after_micros(20).await;
            }
            panel.played(block.end);
        }
    }
}

/// `out x, 28` takes the low bits, `out pins, 4` the others.
fn encoded(word: &Word) -> u32 {
    let cycles = word.ticks * Player::CYCLES_PER_TICK - LEAST_CYCLES;
    cycles | u32::from(word.levels) << WAIT_BITS
}
