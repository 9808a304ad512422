//! On a board: every check of `proof/no-std`, and the hashes. On a PC: the hashes, to compare.
#![cfg_attr(target_os = "none", no_std, no_main)]

use cortex_m_firmware::{kinematics_bits, motion_bits};

#[cfg(target_os = "none")]
use cortex_m_semihosting::hprintln as println;

fn say_hashes() {
    let mut say = |name: &str, kind: &str, hash: cortex_m_firmware::Hash| {
        println!("{}, {}: {:016x}", name, kind, hash.value());
    };
    kinematics_bits::hashes(&mut say);
    motion_bits::hashes(&mut say);
}

#[cfg(not(target_os = "none"))]
fn main() {
    say_hashes();
}

#[cfg(target_os = "none")]
mod start {
    use cortex_m_firmware::board::exit;
    use no_std_proof::checks;
    use panic_semihosting as _;

    #[cortex_m_rt::entry]
    fn main() -> ! {
        for (number, check) in (1..).zip(checks::ALL) {
            assert!(check().is_some(), "check {number}");
        }
        super::say_hashes();
        exit()
    }
}
