//! How near tables with limits of jerk come to the shortest time by another program, ipopt.
//!
//! It runs where `python3` has casadi, and must where `PATH_TIMING_REQUIRE_CASADI` is set:
//! `NLP_PATHS=100 cargo test --release -p path-timing --test it nlp:: -- --nocapture`.

use core::fmt::Write as _;

use path_timing::{Knot, Table};
use test_support::{Random, setting};

use crate::support::machine::limits;
use crate::support::python::{ask, has};
use crate::support::waves::Waves;

/// Least and most of the NLP's time: either side may be caught in an optimum of its own.
const NEAR: [f64; 2] = [0.97, 1.03];

const SEGMENTS: [u32; 2] = [200, 800];

#[test]
fn time_above_that_of_an_nlp() {
    if !has("casadi", "PATH_TIMING_REQUIRE_CASADI") {
        return;
    }
    let paths = setting("NLP_PATHS", 5);
    let mut random = Random::new(setting("SEED", 1));
    // The jerk over the acceleration, in 1/s.
    for rate in [10.0, 40.0] {
        let (mut cases, mut lines) = (Vec::new(), String::new());
        for _ in 0..paths {
            let waves = Waves::random(&mut random);
            let (speed, acceleration) = (random.size(-0.5, 0.5), random.size(-0.5, 1.0));
            let jerk = acceleration * rate;
            writeln!(lines, "{speed} {acceleration} {jerk}{waves}").unwrap();
            cases.push((waves, [limits(speed, acceleration, Some(jerk)); 2]));
        }
        let shortest = ask("nlp/duration.py", &lines);
        for segments in SEGMENTS {
            let mut shares: Vec<_> = (cases.iter().zip(&shortest))
                .map(|((waves, limits), shortest_s)| {
                    let mut knots = [Knot::default(); 801];
                    let paths = [waves.path()];
                    let table = Table::plan(paths, *limits, |_| segments, &mut knots).unwrap();
                    table.duration_s() / shortest_s
                })
                .collect();
            shares.sort_by(f64::total_cmp);
            let [best, median, worst] = [0, shares.len() / 2, shares.len() - 1].map(|i| shares[i]);
            println!(
                "J = {rate} a, {paths} paths, {segments} segments: {best:.4} to {worst:.4} of the \
                 NLP's time, median {median:.4}"
            );
            assert!(best > NEAR[0] && worst < NEAR[1], "{best} {worst}");
        }
    }
}
