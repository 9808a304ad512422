//! Pulse trains that can be seen.

use stepper_sync::{Level, Trains};
use test_support::{Pulses, pulses};

/// The trains of axes called `names`.
fn trains<const N: usize>(names: &str, steps: [i32; N], half_period_ticks: u64) -> Pulses {
    let trains = Trains::new(steps, half_period_ticks).unwrap();
    let edges = trains.edges();
    Pulses::of(
        names,
        edges.map(|edge| (edge.ticks, edge.axis, edge.level == Level::High)),
    )
}

#[test]
fn both_trains_end_on_the_same_tick() {
    let two_to_one = pulses!["x __|--|__|--|", "y ____|----|"];
    assert_eq!(trains("xy", [2, 1], 2), two_to_one);
}

#[test]
fn edges_without_a_whole_tick_come_just_before_it() {
    // Edge k of y at floor(24 k / 10): 2, 4, 7, 9, 12, ...
    let six_to_five = pulses![
        "x __|--|__|--|__|--|__|--|__|--|__|--|",
        "y __|--|___|--|___|--|__|---|__|---|",
    ];
    assert_eq!(trains("xy", [6, -5], 2), six_to_five);
}

#[test]
fn an_axis_at_rest_has_no_edges() {
    assert_eq!(
        trains("xyz", [1, 0, 2], 1),
        pulses!["x __|--|", "y ", "z _|-|_|-|"]
    );
}
