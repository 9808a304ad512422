//! A Raspberry Pi Pico that runs a machine: see the README for wiring and commands. What the
//! machine is its program says: `KIND`, `AXES`, settings and pins.

use board_machine::{Inputs, Machine, Motion, Panel, PlanMemory, product, talk};
use embassy_executor::{Executor, InterruptExecutor};
use embassy_rp::gpio::{AnyPin, Input, Pull};
use embassy_rp::interrupt;
use embassy_rp::interrupt::{InterruptExt, Priority};
use embassy_rp::peripherals::{DMA_CH0, PIN_0, PIN_1, PIO0, UART0};
use embassy_rp::uart::{self, BufferedUart, BufferedUartRx, BufferedUartTx};
use embassy_rp::{Peri, bind_interrupts, dma, pio};
use panic_probe as _;
use proto3964r::{CharacterError, Line};
use static_cell::{ConstStaticCell, StaticCell};
use step_player::PioPlayer;

use crate::machine::{AXES, Kind, SETTINGS};

/// Of the serial line: 8 data bits, even parity, 1 stop bit.
const BAUD: u32 = 9600;

bind_interrupts!(pub struct Irqs {
    DMA_IRQ_0 => dma::InterruptHandler<DMA_CH0>;
    PIO0_IRQ_0 => pio::InterruptHandler<PIO0>;
    UART0_IRQ => uart::BufferedInterruptHandler<UART0>;
});

static PANEL: Panel<AXES> = Panel::new();
static MACHINE: StaticCell<Machine<Kind, AXES>> = StaticCell::new();
static SWITCHES: StaticCell<Switches> = StaticCell::new();
static MEMORY: StaticCell<PlanMemory<AXES>> = StaticCell::new();
static PLAYS: InterruptExecutor = InterruptExecutor::new();
static TALKS: InterruptExecutor = InterruptExecutor::new();
static PLANS: StaticCell<Executor> = StaticCell::new();

type Player = PioPlayer<'static, PIO0, 0>;

/// The serial line, and what plays the pins.
pub struct Board {
    pub tx: Peri<'static, PIN_0>,
    pub rx: Peri<'static, PIN_1>,
    pub uart: Peri<'static, UART0>,
    pub dma: Peri<'static, DMA_CH0>,
    pub pio: pio::Pio<'static, PIO0>,
}

/// Home switches, closed to ground.
struct Switches([Input<'static>; AXES]);

impl Inputs<AXES> for Switches {
    fn closed(&self) -> [bool; AXES] {
        self.0.each_ref().map(Input::is_low)
    }
}

impl Board {
    /// Runs the machine: step and direction of the first axis, of the second and so on, which have
    /// to be pins in a row, and the home switches, which close to ground.
    pub fn run(
        mut self,
        drivers: [pio::Pin<'static, PIO0>; 2 * AXES],
        switches: [Peri<'static, AnyPin>; AXES],
    ) -> ! {
        let dma = dma::Channel::new(self.dma, Irqs);
        let pins = drivers.each_ref();
        let player = PioPlayer::new(&mut self.pio.common, self.pio.sm0, &pins, dma);
        let machine = Machine::new(&SETTINGS, player.tick_hz()).expect("good settings");
        let machine: &Machine<Kind, AXES> = MACHINE.init(machine);
        let switches = switches.map(|pin| Input::new(pin, Pull::Up));
        let switches: &Switches = SWITCHES.init(Switches(switches));
        let memory = MEMORY.init_with(PlanMemory::new);

        static BUFFERS: ConstStaticCell<[[u8; 256]; 2]> = ConstStaticCell::new([[0; 256]; 2]);
        let [tx_buffer, rx_buffer] = BUFFERS.take();
        let mut line = uart::Config::default();
        line.baudrate = BAUD;
        line.parity = uart::Parity::ParityEven;
        let line = BufferedUart::new(
            self.uart, self.tx, self.rx, Irqs, tx_buffer, rx_buffer, line,
        );

        // The pins never wait for the line, and the line never for the planner.
        interrupt::SWI_IRQ_0.set_priority(Priority::P1);
        PLAYS
            .start(interrupt::SWI_IRQ_0)
            .spawn(play(player).expect("spawned once"));
        interrupt::SWI_IRQ_1.set_priority(Priority::P2);
        let (tx, rx) = line.split();
        TALKS
            .start(interrupt::SWI_IRQ_1)
            .spawn(converse(machine, switches, tx, rx).expect("spawned once"));
        PLANS.init(Executor::new()).run(|spawner| {
            spawner.spawn(plan(machine, switches, memory).expect("spawned once"));
        })
    }
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
async fn converse(
    machine: &'static Machine<Kind, AXES>,
    switches: &'static Switches,
    tx: BufferedUartTx,
    rx: BufferedUartRx,
) {
    let line_error = |error| match error {
        uart::Error::Overrun => Some(CharacterError::Overrun),
        uart::Error::Break => None,
        uart::Error::Parity => Some(CharacterError::Parity),
        _ => Some(CharacterError::Framing),
    };
    let line = Line::paced(BAUD, 11);
    talk(machine, &PANEL, switches, line, (rx, tx), line_error).await
}

#[embassy_executor::task]
async fn plan(
    machine: &'static Machine<Kind, AXES>,
    switches: &'static Switches,
    memory: &'static mut PlanMemory<AXES>,
) {
    let motion = Motion::new(machine, &PANEL, switches, memory);
    motion.expect("home is within 2^31 steps").run().await
}

unsafe extern "C" {
    fn __muldf3(a: f64, b: f64) -> f64;
}

/// What is called for `a * b`: in place of the compiler's own, which is as exact and takes longer on
/// this processor.
#[unsafe(no_mangle)]
extern "C" fn __aeabi_dmul(a: f64, b: f64) -> f64 {
    // SAFETY: the compiler's own product is a function of its arguments.
    product(a, b, |a, b| unsafe { __muldf3(a, b) })
}
