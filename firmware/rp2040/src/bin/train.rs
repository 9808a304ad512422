//! A step train on GP2 of a Raspberry Pi Pico, 1000 steps a second, with GP3 as its direction.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embassy_executor::Executor;
use embassy_rp::peripherals::{DMA_CH0, PIO0};
use embassy_rp::{bind_interrupts, dma, pio};
use panic_probe as _;
use static_cell::StaticCell;
use step_player::{PioPlayer, Source, Word};

bind_interrupts!(struct Irqs {
    DMA_IRQ_0 => dma::InterruptHandler<DMA_CH0>;
    PIO0_IRQ_0 => pio::InterruptHandler<PIO0>;
});

/// A step at a time, for ever, each of so many ticks.
struct Train(u32);

impl Source for Train {
    type Block = [Word; 2];
    type End = ();

    async fn next_block(&self) -> Self::Block {
        // A pause with the direction in bit 1, a pulse of 2 us with the step in bit 0.
        [(self.0 - 25, 0b11), (25, 0b10)].map(|(ticks, levels)| Word { ticks, levels })
    }

    fn try_next_block(&self) -> Option<Self::Block> {
        None
    }

    fn end(_: &Self::Block) {}
}

#[embassy_executor::task]
async fn play(player: PioPlayer<'static, PIO0, 0>, train: Train) {
    player.play(&train).await
}

#[entry]
fn main() -> ! {
    let p = embassy_rp::init(embassy_rp::config::Config::default());
    let mut pio = pio::Pio::new(p.PIO0, Irqs);
    let pins = [
        pio.common.make_pio_pin(p.PIN_2),
        pio.common.make_pio_pin(p.PIN_3),
    ];
    let dma = dma::Channel::new(p.DMA_CH0, Irqs);
    let player = PioPlayer::new(&mut pio.common, pio.sm0, &pins.each_ref(), dma);
    let train = Train(player.tick_hz() / 1000);
    static EXECUTOR: StaticCell<Executor> = StaticCell::new();
    EXECUTOR.init(Executor::new()).run(|spawner| {
        spawner.spawn(play(player, train).expect("spawned once"));
    })
}
