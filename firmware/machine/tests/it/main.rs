//! The machine from outside: its commands, its settings, and all of it with pins that are looked
//! at.

mod boards;
mod commands;
mod delta;
mod double;
mod edges;
mod motion;
mod rig;
mod scales;
mod settings;
mod stage;
