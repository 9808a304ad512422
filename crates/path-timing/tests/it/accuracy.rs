//! What `Accuracy` asks for is kept.

use path_timing::{Accuracy, Knot, Path, Table};
use test_support::{Random, setting};

use crate::support::machine::{Line, limits};
use crate::support::waves::Waves;

/// So many segments that nothing is lost.
const FINE: u32 = 2000;

/// Ratios that are asked for, and by what part of it times may miss them: the fine plan is not the best.
const RATIOS: [f64; 7] = [1.005, 1.01, 1.02, 1.05, 1.1, 1.3, 2.0];

const FEWEST: [u32; 3] = [2, 5, 16];

/// On random paths of two kinds and limits of all sizes, `PATHS` of each.
#[test]
fn times_are_within_their_ratio() {
    let mut random = Random::new(setting("SEED", 1));
    let mut rows = [0; RATIOS.len()];
    let paths = setting("PATHS", 6);
    for _ in 0..paths {
        let mut end = || [random.within(-200.0, 200.0), random.within(10.0, 200.0)];
        let line = Line {
            from: end(),
            to: end(),
        };
        check(&mut random, line, [2.0, 300.0], &mut rows);
        let waves = Waves::random(&mut random).path();
        check(&mut random, waves, [1.0, 1.0], &mut rows);
    }
    let plans = u64::try_from(2 * FEWEST.len()).unwrap() * paths;
    println!("{RATIOS:?}: {:?} rows", rows.map(|rows| rows / plans));
    assert!(rows[0] > rows[6] && rows[6] > 2 * plans, "{rows:?}");
}

fn check<P: Path<Axes = [f64; 2]> + Clone>(
    random: &mut Random,
    path: P,
    speeds: [f64; 2],
    rows: &mut [u64],
) where
    P::Error: core::fmt::Debug,
{
    let own = speeds.map(|speed| {
        let speed = speed * random.size(-0.5, 0.5);
        limits(speed, speed * random.size(0.1, 1.5), None)
    });
    let mut knots = vec![Knot::default(); 20_000];
    let fine = Table::plan([path.clone()], own, |_| FINE, &mut knots);
    let fine_s = fine.unwrap().duration_s();
    for (max_time_ratio, rows) in RATIOS.into_iter().zip(rows) {
        for min_segments in FEWEST {
            let accuracy = Accuracy {
                min_segments,
                max_departure: 1.0,
                max_time_ratio,
            };
            let paths = [path.clone()];
            let table = Table::plan_within(paths, own, accuracy, |_, _| 0.0, &mut knots).unwrap();
            let ratio = table.duration_s() / fine_s;
            assert!(ratio <= max_time_ratio, "{ratio} for {accuracy:?}, {own:?}");
            *rows += u64::try_from(table.len()).unwrap();
        }
    }
}
