//! Says the instructions and the stack of every hot call.
#![no_std]
#![no_main]

mod kinematics;
mod line;
mod memory;
mod motion;
mod steps;

use core::hint::black_box;

use cortex_m_firmware::board::exit;
use cortex_m_firmware::meter::Meter;
use panic_semihosting as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    let meter = Meter::start();
    kinematics::count::<f32>(&meter);
    kinematics::count::<f64>(&meter);
    motion::count(&meter);
    steps::count(&meter);
    line::count(&meter);
    memory::say();
    exit()
}

/// As a function of its own, as an interrupt handler has it.
#[inline(never)]
fn next<I: Iterator>(iterator: &mut I) -> Option<I::Item> {
    iterator.next()
}

/// One after the other, from the front again at the end.
fn cycle<T: Copy>(values: &[T]) -> impl FnMut() -> T {
    let mut rest = values.iter().cycle();
    move || black_box(*rest.next().expect("not empty"))
}
