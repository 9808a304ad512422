//! Input shaping: shapers by themselves, rows, bounds of departure, oscillators driven by edges.

mod bounds;
mod closed_form;
mod course;
mod ringing;
mod rows;
