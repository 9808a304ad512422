//! A stage of two axes on a Raspberry Pi Pico.
#![no_std]
#![no_main]

#[path = "../board.rs"]
mod board;

use board::{Board, Irqs};
use board_settings::stage as machine;
use cortex_m_rt::entry;
use embassy_rp::pio::Pio;

#[entry]
fn main() -> ! {
    let p = embassy_rp::init(embassy_rp::config::Config::default());
    let mut pio = Pio::new(p.PIO0, Irqs);
    let common = &mut pio.common;
    // Step and direction of x, step and direction of y.
    let drivers = [
        common.make_pio_pin(p.PIN_2),
        common.make_pio_pin(p.PIN_3),
        common.make_pio_pin(p.PIN_4),
        common.make_pio_pin(p.PIN_5),
    ];
    let board = Board {
        tx: p.PIN_0,
        rx: p.PIN_1,
        uart: p.UART0,
        dma: p.DMA_CH0,
        pio,
    };
    board.run(drivers, [p.PIN_6.into(), p.PIN_7.into()])
}
