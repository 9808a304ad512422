//! Proves hot paths free of panics: each stands in a function of its own under `#[no_panic]`, and
//! the program does not link unless the optimiser has removed every way to a panic from it.
//!
//! All inputs and states pass through `black_box`, so that nothing is known of them but their
//! types. Running the program proves nothing more; it must link.

mod curves;
mod delta;
mod frames;
mod jobs;
mod kinematics;
mod line;
mod machines;
mod paths;
mod patterns;
mod poses;
mod shaping;
mod stepping;
mod tables;
mod timing;
mod torque;
mod trig;
mod unit;

fn main() {
    kinematics::run();
    delta::run();
    poses::run();
    tables::run();
    shaping::run();
    torque::run();
    timing::run();
    curves::run();
    machines::run();
    stepping::run();
    paths::run();
    patterns::run();
    frames::run();
    line::run();
    jobs::run();
    unit::run();
    trig::run();
}
