//! Pulse trains that can be seen.

use stepper_sync::{Ramp, RampLimits, Rate, Trains};

use crate::common::pulses::{Pulses, pulses};

/// The trains of axes called `names`.
fn trains<const N: usize>(names: &str, steps: [i32; N], half_period_ticks: u64) -> Pulses {
    Pulses::of(
        names,
        Trains::new(steps, half_period_ticks).unwrap().edges(),
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

#[test]
fn a_ramp_starts_slowly_and_ends_slowly() {
    let limits = RampLimits {
        start_millihertz: 100_000,
        max_millihertz: 500_000,
        accel_steps_per_s2: 40_000,
    };
    let ramp = Ramp::new([8], &limits, Rate::from_hz(2000).unwrap()).unwrap();
    // The first step after (√(100² + 40,000) - 100) / 40,000 s, 6.2 ticks; four ticks a step at top.
    let up_and_down = pulses!["x ______|-|______|-|____|-|___|-|___|-|___|-|____|-|______|-|"];
    assert_eq!(Pulses::of("x", ramp.edges()), up_and_down);
}
