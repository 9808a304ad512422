//! Real work with each crate; `None` when a result is not the expected one.

mod arm;
mod body;
mod codecs;
mod delta;
mod line;
mod machine;
mod pulses;
mod timing;
mod trig;
mod unit;

/// The checks; the number of each is its exit status.
pub const ALL: &[fn() -> Option<()>] = &[
    arm::inverse,
    arm::follow,
    arm::path,
    arm::calibration,
    delta::delta,
    delta::calibration,
    delta::path,
    machine::path,
    body::pose,
    body::tables,
    timing::table,
    timing::curve,
    timing::stream,
    timing::shaped,
    timing::torque,
    timing::set_points,
    pulses::trains,
    pulses::ramp,
    pulses::cubic,
    pulses::dance,
    pulses::interpolation,
    pulses::closed_loop,
    codecs::records,
    codecs::dance_header,
    line::stations,
    line::monitor,
    line::read_data_block,
    unit::unit_telegrams,
    unit::wheel,
    trig::angles,
];

/// A thousandth of a micrometre: far above the rounding of an arm of 264 mm, far below any machine.
const CLOSE_MM: f64 = 1e-6;

fn holds(condition: bool) -> Option<()> {
    condition.then_some(())
}
