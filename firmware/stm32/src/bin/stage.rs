//! A stage of two axes on a Nucleo-F411RE.
#![no_std]
#![no_main]

#[path = "../board.rs"]
mod board;

use board::Board;
use board_settings::stage as machine;
use cortex_m_rt::entry;
use embassy_stm32::timer::qei::{Config, Qei};

#[entry]
fn main() -> ! {
    let p = embassy_stm32::init(board::clocks());
    let x = Qei::new(p.TIM3, p.PA6, p.PA7, Config::default()); // D12, D11
    let y = Qei::new(p.TIM4, p.PB6, p.PB7, Config::default()); // D10, CN7 21
    let board = Board {
        tx: p.PA2,
        rx: p.PA3,
        usart: p.USART2,
        timer: p.TIM1,
        dma: p.DMA2_CH5,
        scales: Some((x, y)),
    };
    // Step and direction of x, step and direction of y.
    let drivers = [p.PA0.into(), p.PA1.into(), p.PA4.into(), p.PA10.into()]; // A0 A1, A2 D2
    board.run(drivers, [p.PC1.into(), p.PC0.into()]) // A4, A5
}
