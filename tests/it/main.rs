//! Tests of the machines as programs, of the C sources and of the facade: one program, which is
//! linked once.
#![cfg(test)]

#[cfg(unix)]
mod align;
mod commissioning;
#[cfg(all(feature = "motor-phases", feature = "pattern-codec"))]
mod dance;
mod delta;
#[cfg(all(
    feature = "scara-kin",
    feature = "stepper-sync",
    feature = "pattern-codec"
))]
mod engrave;
mod generators;
#[cfg(all(
    unix,
    feature = "motor-phases",
    feature = "pattern-codec",
    feature = "stepper-sync"
))]
mod mcs51;
#[cfg(unix)]
mod plc;
#[cfg(all(unix, feature = "pvt-steps"))]
mod segments;
mod stage;
mod tools;
