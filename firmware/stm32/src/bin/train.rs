//! A step train on A0 of a Nucleo-F411RE, 1000 steps a second, with A1 as its direction.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embassy_executor::Executor;
use embassy_stm32::peripherals::{DMA2_CH5, TIM1};
use embassy_stm32::{bind_interrupts, dma};
use panic_probe as _;
use static_cell::{ConstStaticCell, StaticCell};
use step_player::{DmaPlayer, RING, Source, Word};

bind_interrupts!(struct Irqs {
    DMA2_STREAM5 => dma::InterruptHandler<DMA2_CH5>;
});

/// At the internal oscillator's 16 MHz that is enough to do.
const TICK_HZ: u32 = 50_000;

/// A step at a time, for ever.
struct Train;

impl Source for Train {
    type Block = [Word; 2];
    type End = ();

    async fn next_block(&self) -> Self::Block {
        core::future::pending().await // a `DmaPlayer` never waits
    }

    fn try_next_block(&self) -> Option<Self::Block> {
        // A pause with the direction in bit 1, a pulse of a tick with the step in bit 0.
        Some([(49, 0b11), (1, 0b10)].map(|(ticks, levels)| Word { ticks, levels }))
    }

    fn end(_: &Self::Block) {}
}

#[embassy_executor::task]
async fn play(player: DmaPlayer<'static, TIM1, 2>) {
    player.play(&Train).await
}

#[entry]
fn main() -> ! {
    let p = embassy_stm32::init(embassy_stm32::Config::default());
    static WORDS: ConstStaticCell<[u32; RING]> = ConstStaticCell::new([0; RING]);
    let pins = [p.PA0.into(), p.PA1.into()];
    let player = DmaPlayer::new(p.TIM1, p.DMA2_CH5, Irqs, pins, WORDS.take(), TICK_HZ);
    let player = player.expect("pins of one port");
    static EXECUTOR: StaticCell<Executor> = StaticCell::new();
    EXECUTOR.init(Executor::new()).run(|spawner| {
        spawner.spawn(play(player).expect("spawned once"));
    })
}
