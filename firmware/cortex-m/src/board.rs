//! What the programs use of the boards MPS2 with AN385 (Cortex-M3) or AN386 (M4F): timers, a serial
//! port, and the end of a run in QEMU.
//!
//! Arm, *Cortex-M System Design Kit*, Technical Reference Manual (ARM DDI 0479), chapter 4.

use core::ptr::{read_volatile, write_volatile};

use cortex_m::interrupt::InterruptNumber;
use cortex_m_semihosting::debug;
use stepper_sync::Direction;

/// The timers' clock.
pub const CLOCK_HZ: u32 = 25_000_000;

/// A clock that counts down.
#[derive(Debug)]
pub struct Clock {
    registers: Registers,
}

/// One of two timers that share interrupt 10. What it counts next can be set while it counts.
#[derive(Debug)]
pub struct StepTimer {
    registers: Registers,
}

#[derive(Debug)]
struct Registers(*mut u32);

/// The interrupt of both step timers.
#[derive(Clone, Copy, Debug)]
pub struct StepInterrupt;

// SAFETY: the number of an interrupt that the boards have.
unsafe impl InterruptNumber for StepInterrupt {
    fn number(self) -> u16 {
        10
    }
}

const ENABLE_CLOCK: u32 = 1;
/// Of 32 bits, again and again, with interrupts.
const ENABLE_STEPS: u32 = 1 << 7 | 1 << 6 | 1 << 5 | 1 << 1;

impl Registers {
    fn write(&self, number: usize, value: u32) {
        // SAFETY: registers of a timer or port, which the boards have there.
        unsafe { write_volatile(self.0.add(number), value) }
    }

    fn read(&self, number: usize) -> u32 {
        // SAFETY: as above.
        unsafe { read_volatile(self.0.add(number)) }
    }
}

impl Clock {
    const CTRL: usize = 0;
    const VALUE: usize = 1;
    const RELOAD: usize = 2;

    /// Timer 0, started: down from the largest number, again and again.
    #[must_use]
    pub fn start() -> Self {
        let clock = Self::started();
        clock.registers.write(Self::RELOAD, u32::MAX);
        clock.registers.write(Self::CTRL, ENABLE_CLOCK);
        clock
    }

    /// The same again, where it was started before.
    #[must_use]
    pub const fn started() -> Self {
        Self {
            registers: Registers(0x4000_0000 as *mut u32),
        }
    }

    #[inline]
    pub fn value(&self) -> u32 {
        self.registers.read(Self::VALUE)
    }
}

impl StepTimer {
    const LOAD: usize = 0;
    const VALUE: usize = 1;
    const CONTROL: usize = 2;
    const CLEAR_INTERRUPT: usize = 3;
    const MASKED_INTERRUPT: usize = 5;
    const NEXT_LOAD: usize = 6;

    /// Both parts of the dual timer.
    pub const BOTH: [Self; 2] = [
        Self {
            registers: Registers(0x4000_2000 as *mut u32),
        },
        Self {
            registers: Registers(0x4000_2020 as *mut u32),
        },
    ];

    /// Counts `first` ticks, then `second`; an interrupt after each.
    pub fn start(&self, first: u32, second: u32) {
        self.registers.write(Self::LOAD, first - 1);
        self.registers.write(Self::NEXT_LOAD, second - 1);
        self.registers.write(Self::CONTROL, ENABLE_STEPS);
    }

    /// The ticks after those that it counts now.
    #[inline]
    pub fn set_next(&self, ticks: u32) {
        self.registers.write(Self::NEXT_LOAD, ticks - 1);
    }

    /// Ticks until the next interrupt.
    pub fn ticks_left(&self) -> u32 {
        self.registers.read(Self::VALUE)
    }

    #[inline]
    pub fn is_due(&self) -> bool {
        self.registers.read(Self::MASKED_INTERRUPT) != 0
    }

    #[inline]
    pub fn clear_interrupt(&self) {
        self.registers.write(Self::CLEAR_INTERRUPT, 1);
    }

    #[inline]
    pub fn stop(&self) {
        self.registers.write(Self::CONTROL, 0);
    }
}

/// The serial port UART 0.
#[derive(Debug)]
pub struct Uart {
    registers: Registers,
}

impl Uart {
    const DATA: usize = 0;
    const STATE: usize = 1;
    const CONTROL: usize = 2;
    const BAUD_DIVIDER: usize = 4;
    const TRANSMITTER_FULL: u32 = 1;
    const RECEIVER_FULL: u32 = 2;
    /// Transmitter and receiver.
    const ENABLE: u32 = 3;
    const BAUD: u32 = 115_200;

    /// The port, at work.
    #[must_use]
    pub fn start() -> Self {
        let uart = Self {
            registers: Registers(0x4000_4000 as *mut u32),
        };
        uart.registers
            .write(Self::BAUD_DIVIDER, CLOCK_HZ / Self::BAUD);
        uart.registers.write(Self::CONTROL, Self::ENABLE);
        uart
    }

    /// A byte that has come in.
    #[must_use]
    pub fn read(&self) -> Option<u8> {
        let is_full = self.registers.read(Self::STATE) & Self::RECEIVER_FULL != 0;
        is_full.then(|| self.registers.read(Self::DATA) as u8)
    }

    /// Whether a byte can be written.
    #[must_use]
    pub fn has_room(&self) -> bool {
        self.registers.read(Self::STATE) & Self::TRANSMITTER_FULL == 0
    }

    pub fn write(&self, byte: u8) {
        self.registers.write(Self::DATA, byte.into());
    }
}

/// The edges of a joint's step pin.
#[derive(Debug)]
pub struct Trace {
    /// Twice the clock at each step, and 1 where the direction is negative.
    edges: [u32; Self::MAX_STEPS],
    len: usize,
}

impl Trace {
    const MAX_STEPS: usize = 16_384;
    pub const EMPTY: Self = Self {
        edges: [0; Self::MAX_STEPS],
        len: 0,
    };

    /// A step now, by a clock that has been started.
    #[inline]
    pub fn push(&mut self, direction: Direction) {
        if let Some(place) = self.edges.get_mut(self.len) {
            *place = Clock::started().value() << 1 | u32::from(direction == Direction::Negative);
        }
        self.len += 1;
    }

    /// Sign of each step, and the lower 31 bits of the clock.
    ///
    /// # Panics
    /// For more steps than there is room for.
    pub fn edges(&self) -> impl Iterator<Item = (char, u32)> {
        assert!(self.len <= Self::MAX_STEPS, "{} steps", self.len);
        self.edges[..self.len].iter().map(|edge| {
            let sign = if edge & 1 == 0 { '+' } else { '-' };
            (sign, edge >> 1)
        })
    }
}

/// The program has done its work.
pub fn exit() -> ! {
    loop {
        debug::exit(debug::EXIT_SUCCESS);
    }
}
