//! Checks of every crate that need no operating system: firmware runs them too.
#![no_std]

pub mod checks;
