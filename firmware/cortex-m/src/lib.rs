//! What the programs share: results as hashes, a line of an arm, and on the board a meter.
#![cfg_attr(target_os = "none", no_std)]

pub mod arm_line;
#[cfg(target_os = "none")]
pub mod board;
pub mod kinematics_bits;
#[cfg(target_os = "none")]
pub mod meter;
pub mod motion_bits;
pub mod random;
pub mod stream;

/// Numbers mixed into one, by Fowler, Noll and Vo.
#[derive(Clone, Copy, Debug)]
pub struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }
}

impl Hash {
    /// The hash of all numbers so far.
    pub fn value(self) -> u64 {
        self.0
    }

    pub fn add(&mut self, number: u64) {
        self.0 = (self.0 ^ number).wrapping_mul(0x0100_0000_01B3);
    }

    /// Adds the bits of each number.
    pub fn add_all<T: Real>(&mut self, numbers: impl IntoIterator<Item = T>) {
        numbers.into_iter().for_each(|x| self.add(x.bits()));
    }
}

/// `f32` or `f64`.
pub trait Real: scara_kin::nalgebra::RealField + scara_kin::Trig {
    const NAME: &'static str;

    fn bits(self) -> u64;

    fn of(x: f64) -> Self {
        scara_kin::nalgebra::convert(x)
    }
}

impl Real for f32 {
    const NAME: &'static str = "f32";

    fn bits(self) -> u64 {
        self.to_bits().into()
    }
}

impl Real for f64 {
    const NAME: &'static str = "f64";

    fn bits(self) -> u64 {
        self.to_bits()
    }
}

/// A program that does `$work` once and nothing else, for its size on a board.
#[macro_export]
macro_rules! smallest_program {
    ($work:path) => {
        #[cfg(not(target_os = "none"))]
        fn main() {
            core::hint::black_box($work());
        }

        #[cfg(target_os = "none")]
        #[cortex_m_rt::entry]
        fn main() -> ! {
            core::hint::black_box($work());
            loop {
                cortex_m::asm::wfi();
            }
        }

        #[cfg(target_os = "none")]
        #[panic_handler]
        fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
            loop {
                cortex_m::asm::wfi();
            }
        }
    };
}
