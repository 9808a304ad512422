//! The tools `station`, `monitor` and `plc` from outside, as their users run them.
#![cfg(test)]
#![cfg(all(unix, feature = "proto3964r"))]

mod tools {
    pub(crate) mod command;
    pub(crate) mod example;
    mod exchange;
    mod monitor;
    #[cfg(feature = "rk512")]
    mod plc;
    mod refusal;
    mod station;
}
