//! An arm of two links on a Nucleo-F411RE: see the README for wiring and commands.
#![no_std]
#![no_main]

mod arm;
mod pins;

use board_machine::{Machine, Motion, Panel, PlanMemory, talk};
use cortex_m_rt::entry;
use embassy_executor::{Executor, InterruptExecutor};
use embassy_stm32::gpio::{Input, Pull};
use embassy_stm32::interrupt;
use embassy_stm32::interrupt::{InterruptExt, Priority};
use embassy_stm32::peripherals::{DMA2_CH5, USART2};
use embassy_stm32::rcc::{self, AHBPrescaler, APBPrescaler, Pll, PllMul, PllPDiv, PllPreDiv};
use embassy_stm32::usart::{self, BufferedUart, BufferedUartRx, BufferedUartTx};
use embassy_stm32::{bind_interrupts, dma};
use panic_probe as _;
use proto3964r::{CharacterError, Line};
use static_cell::{ConstStaticCell, StaticCell};

use crate::pins::Player;

/// Of the serial line: 8 data bits, even parity, 1 stop bit.
const BAUD: u32 = 9600;

bind_interrupts!(struct Irqs {
    DMA2_STREAM5 => dma::InterruptHandler<DMA2_CH5>;
    USART2 => usart::BufferedInterruptHandler<USART2>;
});

static PANEL: Panel = Panel::new();
static MACHINE: StaticCell<Machine> = StaticCell::new();
static MEMORY: StaticCell<PlanMemory> = StaticCell::new();
static PLAYS: InterruptExecutor = InterruptExecutor::new();
static TALKS: InterruptExecutor = InterruptExecutor::new();
static PLANS: StaticCell<Executor> = StaticCell::new();

#[entry]
fn main() -> ! {
    let p = embassy_stm32::init(clocks());

    // The pins, with their names on the board. Those of the drivers have to be of port A: step and
    // direction of the shoulder, step and direction of the elbow. PA2 and PA3 go to the serial port
    // of the ST-LINK.
    let drivers = (p.PA0, p.PA1, p.PA4, p.PA10); // A0 A1, A2 D2
    let shoulder_switch = Input::new(p.PC1, Pull::Up); // A4
    let elbow_switch = Input::new(p.PC0, Pull::Up); // A5
    let (tx, rx) = (p.PA2, p.PA3);

    let player = Player::new(p.TIM1, p.DMA2_CH5, Irqs, drivers);
    let machine = Machine::new(&arm::SETTINGS, Player::TICK_HZ).expect("good settings");
    let machine: &Machine = MACHINE.init(machine);
    let memory = MEMORY.init_with(PlanMemory::new);

    static BUFFERS: ConstStaticCell<[[u8; 256]; 2]> = ConstStaticCell::new([[0; 256]; 2]);
    let [tx_buffer, rx_buffer] = BUFFERS.take();
    let mut line = usart::Config::default();
    line.baudrate = BAUD;
    line.parity = usart::Parity::ParityEven;
    let line = BufferedUart::new(p.USART2, rx, tx, tx_buffer, rx_buffer, Irqs, line);
    let line = line.expect("a rate that the port has");

    // The pins never wait for the line, and the line never for the planner. The interrupts are those
    // of ports that are not used.
    interrupt::SPI4.set_priority(Priority::P6);
    PLAYS
        .start(interrupt::SPI4)
        .spawn(play(player).expect("spawned once"));
    interrupt::SPI5.set_priority(Priority::P7);
    let (tx, rx) = line.split();
    TALKS
        .start(interrupt::SPI5)
        .spawn(converse(machine, tx, rx).expect("spawned once"));
    let switches = [shoulder_switch, elbow_switch];
    PLANS.init(Executor::new()).run(|spawner| {
        spawner.spawn(plan(machine, memory, switches).expect("spawned once"));
    })
}

/// 84 MHz of the internal oscillator.
fn clocks() -> embassy_stm32::Config {
    let mut config = embassy_stm32::Config::default();
    config.rcc.pll_src = rcc::PllSource::HSI;
    config.rcc.pll = Some(Pll {
        prediv: PllPreDiv::DIV16,
        mul: PllMul::MUL336,
        divp: Some(PllPDiv::DIV4),
        divq: None,
        divr: None,
    });
    config.rcc.ahb_pre = AHBPrescaler::DIV1;
    config.rcc.apb1_pre = APBPrescaler::DIV2;
    config.rcc.apb2_pre = APBPrescaler::DIV1;
    config.rcc.sys = rcc::Sysclk::PLL1_P;
    config
}

#[interrupt]
unsafe fn SPI4() {
    // SAFETY: called by this interrupt alone, which is on from the executor's start.
    unsafe { PLAYS.on_interrupt() }
}

#[interrupt]
unsafe fn SPI5() {
    // SAFETY: as above.
    unsafe { TALKS.on_interrupt() }
}

#[embassy_executor::task]
async fn play(player: Player) {
    player.play(&PANEL).await
}

#[embassy_executor::task]
async fn converse(
    machine: &'static Machine,
    tx: BufferedUartTx<'static>,
    rx: BufferedUartRx<'static>,
) {
    let line_error = |error| match error {
        usart::Error::Overrun | usart::Error::BufferTooLong => Some(CharacterError::Overrun),
        usart::Error::Parity => Some(CharacterError::Parity),
        _ => Some(CharacterError::Framing),
    };
    talk(machine, &PANEL, Line::paced(BAUD, 11), (rx, tx), line_error).await
}

#[embassy_executor::task]
async fn plan(
    machine: &'static Machine,
    memory: &'static mut PlanMemory,
    switches: [Input<'static>; 2],
) {
    let motion = Motion::new(machine, &PANEL, memory).expect("home is within 2^31 steps");
    // Closed to ground.
    motion.run(|| switches.each_ref().map(Input::is_low)).await
}
