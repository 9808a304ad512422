//! Corners: a stop of the tool is one of the joints, which jump by what the path says.

use path_timing::{Corner, Curve, Knot, Table};
use scara_kin::{ArmPath, Elbow};

use super::{JOINT, line};
use crate::common::engraver;

/// What the joints' motors start and stop with, in rad/s.
const JUMP: f64 = 0.1;

/// The largest speed and the largest jump of a joint at the end of the first of two paths.
fn at_corner<const N: usize, P>(paths: [P; 2]) -> [f64; 2]
where
    P: path_timing::Path<Axes = [f64; N], Error: core::fmt::Debug>,
{
    let length = paths[0].length();
    let mut knots = [Knot::default(); 100];
    let table = Table::plan(paths, [JOINT; N], |_| 20, &mut knots).unwrap();
    let rows: Vec<_> = table.rows().collect();
    let ends = rows.iter().position(|row| row.leg == 0 && row.s >= length);
    let [before, after] = [0, 1].map(|next| rows[ends.unwrap() + next]);
    let most = |velocity: [f64; N]| {
        velocity
            .into_iter()
            .fold(0.0_f64, |most, v| most.max(v.abs()))
    };
    let is_jump = after.duration_s == 0.0;
    let jump = core::array::from_fn(|axis| after.velocity[axis] - before.velocity[axis]);
    [
        most(before.velocity),
        if is_jump { most(jump) } else { 0.0 },
    ]
}

/// No speed and no jump.
const AT_REST: [u64; 2] = [0; 2];

fn bits(numbers: [f64; 2]) -> [u64; 2] {
    numbers.map(f64::to_bits)
}

fn paths(curves: [Curve<2>; 2]) -> [ArmPath; 2] {
    curves.map(|curve| engraver().path(curve, Elbow::Right).unwrap())
}

#[test]
fn a_stop_of_the_tool_stops_the_joints() {
    let straight = [
        line([100.0, 100.0], [120.0, 100.0]),
        line([120.0, 100.0], [140.0, 100.0]),
    ];
    let [first, second] = straight;
    let stopped = [first.with_corner(Corner::Stop), second];
    let jumping = [first.with_corner(Corner::Jump([5.0; 2])), second];
    let [smooth, stop, jump] = [straight, stopped, jumping].map(|curves| at_corner(paths(curves)));
    assert!(smooth[0] > 0.5, "{smooth:?}");
    assert_eq!(bits(smooth), bits(jump));
    assert_eq!(bits(stop), AT_REST);
    let disc = |curves| paths(curves).map(|path| path.with_disc(0.0).unwrap());
    assert!(at_corner(disc(straight))[0] > 0.5);
    assert_eq!(bits(at_corner(disc(stopped))), AT_REST);
}

#[test]
fn joints_jump_by_what_their_motors_can() {
    let corner = [
        line([100.0, 100.0], [120.0, 100.0]),
        line([120.0, 100.0], [120.0, 120.0]),
    ];
    assert_eq!(bits(at_corner(paths(corner))), AT_REST);
    let jumps = paths(corner).map(|path| path.with_corner(Corner::Jump([JUMP; 2])));
    let [speed, jump] = at_corner(jumps);
    assert!(speed > 0.0 && (jump - JUMP).abs() < 1e-9, "{speed} {jump}");
}
