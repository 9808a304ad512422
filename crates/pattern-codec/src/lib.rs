#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]
#![cfg_attr(
    not(test),
    warn(
        clippy::arithmetic_side_effects,
        clippy::integer_division_remainder_used
    )
)]

#[cfg(any(test, feature = "std"))]
extern crate std;

pub mod c_header;
pub mod dance;
pub mod engraving;
mod size_hint;
