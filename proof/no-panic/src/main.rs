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
    #[cfg(feature = "control")]
    control::run();
}

/// What must not link.
#[cfg(feature = "control")]
mod control {
    use std::hint::black_box;

    use no_panic::no_panic;

    #[no_panic]
    #[inline(never)]
    fn index_of_unknown_size(bytes: &[u8], index: usize) -> u8 {
        bytes[index]
    }

    pub fn run() {
        black_box(index_of_unknown_size(black_box(&[1, 2, 3]), black_box(1)));
    }
}
