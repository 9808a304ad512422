//! Vectors and start: what every program has.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

fn work() {}
