//! Counts the instructions and the stack of a call.
//!
//! With `-icount shift=10` QEMU lets 1024 ns pass for each instruction, and its timers count them.

use core::hint::black_box;

use cortex_m::asm;
use cortex_m::register::msp;
use cortex_m_semihosting::hprintln;

use crate::board::{CLOCK_HZ, Clock};

/// Nanoseconds of an instruction.
const INSTRUCTION_NS: u64 = 1 << 10;
/// Below the caller's frame, watched for changes.
const STACK_BYTES: usize = 64 << 10;
/// Left to the meter itself.
const OWN_BYTES: usize = 64;
const UNTOUCHED: u32 = 0xA5C3_5A3C;

/// Counts instructions.
#[derive(Debug)]
pub struct Meter {
    clock: Clock,
    /// Of a call that does nothing.
    empty_ticks: u32,
    empty_stack_bytes: usize,
}

impl Meter {
    /// Starts the clock and checks the scale.
    ///
    /// # Panics
    /// If 1000 instructions are not counted as 1000: QEMU runs without `-icount shift=10`.
    pub fn start() -> Self {
        let mut meter = Self {
            clock: Clock::start(),
            empty_ticks: 0,
            empty_stack_bytes: stack_bytes(&mut || {}),
        };
        meter.empty_ticks = (0..4).map(|_| meter.ticks(&mut || {})).min().unwrap_or(0);
        let nops = meter.instructions(&mut || {
            for _ in 0..100 {
                asm::nop();
            }
        });
        // Of the loop nothing is left but its counting.
        assert!((100..1000).contains(&nops), "{nops} instructions for 100");
        meter
    }

    /// Calls `work` several times; says the least, mean and most instructions of a call, and the
    /// deepest stack in bytes.
    pub fn count(&self, name: &str, kind: &str, calls: u32, mut work: impl FnMut()) {
        // The first call may take a way of its own.
        let (mut least, mut most, mut sum) = (u32::MAX, 0, 0);
        for _ in 0..calls {
            let count = self.instructions(&mut work);
            (least, most, sum) = (least.min(count), most.max(count), sum + u64::from(count));
        }
        let deepest = (0..2).map(|_| stack_bytes(&mut work)).max().unwrap_or(0);
        let mean = (sum + u64::from(calls / 2)) / u64::from(calls);
        let stack = deepest.saturating_sub(self.empty_stack_bytes);
        hprintln!("{};{};{};{};{};{}", name, kind, least, mean, most, stack);
    }

    fn instructions(&self, work: &mut dyn FnMut()) -> u32 {
        let ticks = u64::from(self.ticks(work).saturating_sub(self.empty_ticks));
        let ns = ticks * (1_000_000_000 / u64::from(CLOCK_HZ));
        ((ns + INSTRUCTION_NS / 2) / INSTRUCTION_NS) as u32
    }

    #[inline(never)]
    fn ticks(&self, work: &mut dyn FnMut()) -> u32 {
        let start = self.clock.value();
        work();
        start.wrapping_sub(self.clock.value())
    }
}

/// Bytes of stack of one call.
#[inline(never)]
fn stack_bytes(work: &mut dyn FnMut()) -> usize {
    let top = (msp::read() as usize & !3) - OWN_BYTES;
    let bottom = top - STACK_BYTES;
    for address in (bottom..top).step_by(4) {
        // SAFETY: free stack; the boards have 4 MB.
        unsafe { (address as *mut u32).write_volatile(UNTOUCHED) };
    }
    work();
    // SAFETY: as above.
    let is_untouched =
        |&address: &usize| unsafe { (address as *const u32).read_volatile() } == UNTOUCHED;
    let untouched = (bottom..top).step_by(4).take_while(is_untouched).count();
    black_box(STACK_BYTES - 4 * untouched)
}
