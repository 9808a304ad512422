//! Every crate of the family in a program without std, allocator or C library.
//!
//! Exit status: 0 when all checks hold, else the number of the first that does not; 101 for a
//! panic.
#![no_std]
#![no_main]

#[cfg(any(feature = "control-alloc", feature = "control-std"))]
mod controls;
mod memory;

use core::arch::{asm, global_asm};
use core::panic::PanicInfo;

use no_std_proof::checks;

#[cfg(not(all(target_arch = "x86_64", target_os = "linux")))]
compile_error!("entry and exit are written for Linux on x86-64");

// The kernel enters with an aligned stack and no return address.
global_asm!(".globl _start", "_start:", "xor ebp, ebp", "call {main}", "ud2", main = sym main);

extern "C" fn main() -> ! {
    #[cfg(any(feature = "control-alloc", feature = "control-std"))]
    controls::run();
    for (number, check) in (1..).zip(checks::ALL) {
        if check().is_none() {
            exit(number);
        }
    }
    exit(0)
}

fn exit(status: i32) -> ! {
    const EXIT_GROUP: u64 = 231;
    // SAFETY: the system call takes one integer and does not return.
    unsafe { asm!("syscall", in("rax") EXIT_GROUP, in("rdi") status, options(noreturn, nostack)) }
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    exit(101)
}
