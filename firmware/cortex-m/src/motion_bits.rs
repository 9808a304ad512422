//! Hashes of tables, ramps and steps in time.

use core::convert::Infallible;

use path_timing::{AxisLimits, FeedCeiling, Knot, PathFn, PathPoint, Table};
use pulse_interp::{Arc, Rule, Turn};
use pvt_steps::{Ramp, RampLimits};
use stepper_sync::{Rate, Trains};

use crate::Hash;

/// Says a name, a precision and a hash for each calculation.
pub fn hashes(say: &mut dyn FnMut(&str, &str, Hash)) {
    say("table along a path", "f64", table());
    say("ramp and trains", "ticks", edges());
    say("arc", "steps", arc());
}

/// A parabola within jerk, half of it at half the feed.
fn table() -> Hash {
    let parabola = |s: f64| {
        Ok::<_, Infallible>(PathPoint {
            position: [s, 0.01 * s * s],
            slope: [1.0, 0.02 * s],
        })
    };
    let limits = AxisLimits {
        speed: 10.0,
        acceleration: 20.0,
        jerk: Some(200.0),
    };
    let mut hash = Hash::default();
    let (mut knots, mut ceilings) = ([Knot::default(); 65], [FeedCeiling::default(); 65]);
    let path = PathFn::new(100.0, parabola);
    let table = Table::plan([&path], [limits; 2], |_| 64, &mut knots).expect("good limits");
    let playback = table.playback(1.0, &mut ceilings);
    let mut playback = playback.expect("room for all rows");
    let mut number = 0;
    while let Some(row) = playback.next_row() {
        hash.add_all([row.time_s]);
        hash.add_all(row.position);
        hash.add_all(row.velocity);
        number += 1;
        if number == 32 {
            playback.set_feed(0.5).expect("below the highest");
        }
    }
    hash
}

fn edges() -> Hash {
    let mut hash = Hash::default();
    let limits = RampLimits {
        start_millihertz: 100_000,
        max_millihertz: 2_000_000,
        accel_steps_per_s2: 20_000,
    };
    let rate = Rate::from_hz(1_000_000).expect("not zero");
    let ramp = Ramp::new([400, -150], &limits, rate).expect("good limits");
    ramp.edges().for_each(|edge| hash.add(edge.ticks));
    let trains = Trains::new([300, -70], 4096).expect("not too many");
    trains.edges().for_each(|edge| hash.add(edge.ticks));
    hash
}

fn arc() -> Hash {
    let mut hash = Hash::default();
    let arc = Arc::new([500, 0], [-300, 400], Turn::CounterClockwise).expect("on one circle");
    let mut steps = arc.steps(Rule::Nearest);
    loop {
        hash.add(steps.factor().to_q16().into());
        let Some(step) = steps.next() else { break };
        hash.add(u64::from(step.dx() != 0));
    }
    hash
}
