//! The machines that the boards' firmware is built for: for another one, change its file.
#![no_std]

pub mod arm;
pub mod delta;
pub mod stage;
