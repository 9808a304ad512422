//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

extern crate alloc;

mod accuracy;
mod attack;
mod corners;
mod curves;
mod departure;
mod jerk;
mod jerk_corners;
mod jerk_stream;
mod look_ahead;
mod monotonic;
mod nlp;
mod optimum;
mod run;
mod set_points;
mod shaper;
mod short_rows;
mod single;
mod slow_corners;
mod smoothed;
mod smoothed_jerk;
mod stops;
mod support;
mod table;
mod tool;
mod toppra;
mod torque;
mod touched;
mod verify;
