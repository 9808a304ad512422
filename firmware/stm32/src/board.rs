//! A Nucleo-F411RE that runs a machine: see the README for wiring and commands. What the machine is
//! its program says: `KIND`, `AXES`, settings and pins.

use board_machine::{Inputs, Machine, Motion, Panel, PlanMemory, talk};
use embassy_executor::{Executor, InterruptExecutor};
use embassy_stm32::gpio::{AnyPin, Input, Pull};
use embassy_stm32::interrupt;
use embassy_stm32::interrupt::{InterruptExt, Priority};
use embassy_stm32::peripherals::{DMA2_CH5, PA2, PA3, TIM1, TIM3, TIM4, USART2};
use embassy_stm32::rcc::{self, AHBPrescaler, APBPrescaler, Pll, PllMul, PllPDiv, PllPreDiv};
use embassy_stm32::timer::qei::Qei;
use embassy_stm32::usart::{self, BufferedUart, BufferedUartRx, BufferedUartTx};
use embassy_stm32::{Peri, bind_interrupts, dma};
use panic_probe as _;
use proto3964r::{CharacterError, Line};
use static_cell::{ConstStaticCell, StaticCell};
use step_player::{DmaPlayer, RING};

use crate::machine::{AXES, Kind, SETTINGS};

/// Of the serial line: 8 data bits, even parity, 1 stop bit.
const BAUD: u32 = 9600;
const TICK_HZ: u32 = 250_000;

bind_interrupts!(struct Irqs {
    DMA2_STREAM5 => dma::InterruptHandler<DMA2_CH5>;
    USART2 => usart::BufferedInterruptHandler<USART2>;
});

static PANEL: Panel<AXES> = Panel::new();
static MACHINE: StaticCell<Machine<Kind, AXES>> = StaticCell::new();
static INPUTS: StaticCell<Pins> = StaticCell::new();
static MEMORY: StaticCell<PlanMemory<AXES>> = StaticCell::new();
static PLAYS: InterruptExecutor = InterruptExecutor::new();
static TALKS: InterruptExecutor = InterruptExecutor::new();
static PLANS: StaticCell<Executor> = StaticCell::new();

type Player = DmaPlayer<'static, TIM1, { 2 * AXES }>;

/// The serial line, that of the ST-LINK, and what plays the pins.
pub struct Board {
    pub tx: Peri<'static, PA2>,
    pub rx: Peri<'static, PA3>,
    pub usart: Peri<'static, USART2>,
    pub timer: Peri<'static, TIM1>,
    pub dma: Peri<'static, DMA2_CH5>,
    pub scales: Scales,
}

/// The counters of the scales of the first two axes, if they have some.
pub type Scales = Option<(Qei<'static, TIM3>, Qei<'static, TIM4>)>;

/// What is read.
struct Pins {
    switches: [Input<'static>; AXES],
    scales: Scales,
}

impl Inputs<AXES> for Pins {
    fn closed(&self) -> [bool; AXES] {
        // To ground.
        self.switches.each_ref().map(Input::is_low)
    }

    fn counts(&self) -> Option<[u16; AXES]> {
        let (x, y) = self.scales.as_ref()?;
        let mut counts = [0; AXES];
        counts[..2].copy_from_slice(&[x.count(), y.count()]);
        Some(counts)
    }
}

impl Board {
    /// Runs the machine: step and direction of the first axis, of the second and so on, pins of one
    /// port, and the home switches, which close to ground.
    pub fn run(
        self,
        drivers: [Peri<'static, AnyPin>; 2 * AXES],
        switches: [Peri<'static, AnyPin>; AXES],
    ) -> ! {
        static WORDS: ConstStaticCell<[u32; RING]> = ConstStaticCell::new([0; RING]);
        let words = WORDS.take();
        let player = DmaPlayer::new(self.timer, self.dma, Irqs, drivers, words, TICK_HZ);
        let player = player.expect("pins of one port");
        let machine = Machine::new(&SETTINGS, TICK_HZ).expect("good settings");
        let machine: &Machine<Kind, AXES> = MACHINE.init(machine);
        let inputs: &Pins = INPUTS.init(Pins {
            switches: switches.map(|pin| Input::new(pin, Pull::Up)),
            scales: self.scales,
        });
        let memory = MEMORY.init_with(PlanMemory::new);

        static BUFFERS: ConstStaticCell<[[u8; 256]; 2]> = ConstStaticCell::new([[0; 256]; 2]);
        let [tx_buffer, rx_buffer] = BUFFERS.take();
        let mut line = usart::Config::default();
        line.baudrate = BAUD;
        line.parity = usart::Parity::ParityEven;
        let line = BufferedUart::new(
            self.usart, self.rx, self.tx, tx_buffer, rx_buffer, Irqs, line,
        );
        let line = line.expect("a rate that the port has");

        // The pins never wait for the line, and the line never for the planner. The interrupts are
        // those of ports that are not used.
        interrupt::SPI4.set_priority(Priority::P6);
        PLAYS
            .start(interrupt::SPI4)
            .spawn(play(player).expect("spawned once"));
        interrupt::SPI5.set_priority(Priority::P7);
        let (tx, rx) = line.split();
        TALKS
            .start(interrupt::SPI5)
            .spawn(converse(machine, inputs, tx, rx).expect("spawned once"));
        PLANS.init(Executor::new()).run(|spawner| {
            spawner.spawn(plan(machine, inputs, memory).expect("spawned once"));
        })
    }
}

/// 84 MHz of the internal oscillator.
pub fn clocks() -> embassy_stm32::Config {
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
    machine: &'static Machine<Kind, AXES>,
    inputs: &'static Pins,
    tx: BufferedUartTx<'static>,
    rx: BufferedUartRx<'static>,
) {
    let line_error = |error| match error {
        usart::Error::Overrun | usart::Error::BufferTooLong => Some(CharacterError::Overrun),
        usart::Error::Parity => Some(CharacterError::Parity),
        _ => Some(CharacterError::Framing),
    };
    let line = Line::paced(BAUD, 11);
    talk(machine, &PANEL, inputs, line, (rx, tx), line_error).await
}

#[embassy_executor::task]
async fn plan(
    machine: &'static Machine<Kind, AXES>,
    inputs: &'static Pins,
    memory: &'static mut PlanMemory<AXES>,
) {
    let motion = Motion::new(machine, &PANEL, inputs, memory);
    motion.expect("home is within 2^31 steps").run().await
}
