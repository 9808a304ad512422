//! An arm of two links on a Nucleo-F411RE.
#![no_std]
#![no_main]

#[path = "../board.rs"]
mod board;

use board::Board;
use board_settings::arm as machine;
use cortex_m_rt::entry;

#[entry]
fn main() -> ! {
    let p = embassy_stm32::init(board::clocks());
    let board = Board {
        tx: p.PA2,
        rx: p.PA3,
        usart: p.USART2,
        timer: p.TIM1,
        dma: p.DMA2_CH5,
        scales: None,
    };
    // Step and direction of the shoulder, step and direction of the elbow.
    let drivers = [p.PA0.into(), p.PA1.into(), p.PA4.into(), p.PA10.into()]; // A0 A1, A2 D2
    board.run(drivers, [p.PC1.into(), p.PC0.into()]) // A4, A5
}
