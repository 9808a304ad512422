//! An arm of two links on a Raspberry Pi Pico: see the README for wiring and commands.
#![no_std]
#![no_main]

mod arm;
mod pins;

use board_machine::{Machine, Motion, Panel, PlanMemory, talk};
use cortex_m_rt::entry;
use embassy_executor::{Executor, InterruptExecutor};
use embassy_rp::gpio::{Input, Pull};
use embassy_rp::interrupt;
use embassy_rp::interrupt::{InterruptExt, Priority};
use embassy_rp::peripherals::{DMA_CH0, PIO0, UART0};
use embassy_rp::uart::{self, BufferedUart, BufferedUartRx, BufferedUartTx};
use embassy_rp::{bind_interrupts, dma, pio};
use panic_probe as _;
use proto3964r::{CharacterError, Line};
use static_cell::{ConstStaticCell, StaticCell};

use crate::pins::Player;

/// Of the serial line: 8 data bits, even parity, 1 stop bit.
const BAUD: u32 = 9600;

bind_interrupts!(struct Irqs {
    DMA_IRQ_0 => dma::InterruptHandler<DMA_CH0>;
    PIO0_IRQ_0 => pio::InterruptHandler<PIO0>;
    UART0_IRQ => uart::BufferedInterruptHandler<UART0>;
});

static PANEL: Panel = Panel::new();
static MACHINE: StaticCell<Machine> = StaticCell::new();
static MEMORY: StaticCell<PlanMemory> = StaticCell::new();
static PLAYS: InterruptExecutor = InterruptExecutor::new();
static TALKS: InterruptExecutor = InterruptExecutor::new();
static PLANS: StaticCell<Executor> = StaticCell::new();

#[entry]
fn main() -> ! {
    let p = embassy_rp::init(embassy_rp::config::Config::default());

    // The pins. Those of the drivers have to be four in a row, in this order: step and direction of
    // the shoulder, step and direction of the elbow.
    let drivers = (p.PIN_2, p.PIN_3, p.PIN_4, p.PIN_5);
    let shoulder_switch = Input::new(p.PIN_6, Pull::Up);
    let elbow_switch = Input::new(p.PIN_7, Pull::Up);
    let (tx, rx) = (p.PIN_0, p.PIN_1);

    let player = Player::new(p.PIO0, Irqs, drivers, dma::Channel::new(p.DMA_CH0, Irqs));
    let machine = Machine::new(&arm::SETTINGS, player.tick_hz()).expect("good settings");
    let machine: &Machine = MACHINE.init(machine);
    let memory = MEMORY.init_with(PlanMemory::new);

    static BUFFERS: ConstStaticCell<[[u8; 256]; 2]> = ConstStaticCell::new([[0; 256]; 2]);
    let [tx_buffer, rx_buffer] = BUFFERS.take();
    let mut line = uart::Config::default();
    line.baudrate = BAUD;
    line.parity = uart::Parity::ParityEven;
    let line = BufferedUart::new(p.UART0, tx, rx, Irqs, tx_buffer, rx_buffer, line);

    // The pins never wait for the line, and the line never for the planner.
    interrupt::SWI_IRQ_0.set_priority(Priority::P1);
    PLAYS
        .start(interrupt::SWI_IRQ_0)
        .spawn(play(player).expect("spawned once"));
    interrupt::SWI_IRQ_1.set_priority(Priority::P2);
    let (tx, rx) = line.split();
    TALKS
        .start(interrupt::SWI_IRQ_1)
        .spawn(converse(machine, tx, rx).expect("spawned once"));
    let switches = [shoulder_switch, elbow_switch];
    PLANS.init(Executor::new()).run(|spawner| {
        spawner.spawn(plan(machine, memory, switches).expect("spawned once"));
    })
}

#[interrupt]
unsafe fn SWI_IRQ_0() {
    // SAFETY: called by this interrupt alone, which is on from the executor's start.
    unsafe { PLAYS.on_interrupt() }
}

#[interrupt]
unsafe fn SWI_IRQ_1() {
    // SAFETY: as above.
    unsafe { TALKS.on_interrupt() }
}

#[embassy_executor::task]
async fn play(player: Player) {
    player.play(&PANEL).await
}

#[embassy_executor::task]
async fn converse(machine: &'static Machine, tx: BufferedUartTx, rx: BufferedUartRx) {
    let line_error = |error| match error {
        uart::Error::Overrun => Some(CharacterError::Overrun),
        uart::Error::Break => None,
        uart::Error::Parity => Some(CharacterError::Parity),
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
