//! A rotary Delta on a Nucleo-F411RE.
#![no_std]
#![no_main]

#[path = "../board.rs"]
mod board;

use board::Board;
use board_settings::delta as machine;
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
    // Step and direction of each arm.
    let drivers = [
        p.PA0.into(),  // A0
        p.PA1.into(),  // A1
        p.PA4.into(),  // A2
        p.PA10.into(), // D2
        p.PA8.into(),  // D7
        p.PA9.into(),  // D8
    ];
    board.run(drivers, [p.PC1.into(), p.PC0.into(), p.PC7.into()]) // A4, A5, D9
}
