#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(test)]
extern crate alloc;

mod diagnosis;
mod monitor;

pub use diagnosis::{BaudRatio, Diagnosis, Formula, Totals, Verdict, diagnose};
pub use monitor::{Character, Monitor, Observation, Observations, Side};
