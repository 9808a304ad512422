//! How long a stop takes with a limit of jerk, wherever it begins.

use path_timing::{AxisLimits, Cubic, Curve, Knot, LookAhead, Row, Table};

use crate::support::limits::check_limits;
use crate::support::machine::limits;

/// A line of one axis, and where the machine is told to stop: each fourth of so many rows.
struct Case {
    limits: AxisLimits,
    length_mm: f64,
    segments: u32,
    rows: usize,
}

const CASES: [Case; 5] = [
    case(250.0, 2000.0, 20_000.0, 2000.0, 4000),
    case(250.0, 2000.0, 20_000.0, 200.0, 400),
    case(250.0, 2000.0, 20_000.0, 500.0, 500),
    case(250.0, 2000.0, 80_000.0, 500.0, 1000),
    case(50.0, 250.0, 2500.0, 200.0, 400),
];

const fn case(speed: f64, acceleration: f64, jerk: f64, length_mm: f64, segments: u32) -> Case {
    Case {
        limits: limits(speed, acceleration, Some(jerk)),
        length_mm,
        segments,
        rows: if segments > 400 { 200 } else { 190 },
    }
}

/// Of v/a + a/J: what rounding to knots takes, and steps of the acceleration at them.
const LONGEST: f64 = 1.1;

impl Case {
    /// The time from the row of the stop to rest, over that of three phases of constant jerk behind the
    /// end of what the machine gains, a row more and a tenth.
    fn check(&self, rows: &[Row<[f64; 1]>], stopped: usize) -> f64 {
        check_limits(&[self.limits], None, rows);
        let [before, at] = [&rows[stopped - 2], &rows[stopped - 1]];
        let [end] = rows.last_chunk().unwrap();
        assert!(end.velocity[0] == 0.0, "{end:?}");
        let gained = Cubic::between(before, at).next().unwrap().accelerations()[1].max(0.0);
        let AxisLimits {
            acceleration, jerk, ..
        } = self.limits;
        let jerk = jerk.unwrap();
        let highest = at.velocity[0] + gained * gained / (2.0 * jerk);
        let stop_s = highest / acceleration + acceleration / jerk;
        (end.time_s - at.time_s) / (LONGEST * stop_s + gained / jerk + end.duration_s)
    }
}

#[test]
fn a_stop_rests_in_time_wherever_it_begins() {
    for case in &CASES {
        let line = Curve::line([0.0], [case.length_mm]).unwrap();
        let mut knots = vec![Knot::default(); 4002];
        let table = Table::plan([line], [case.limits], |_| case.segments, &mut knots).unwrap();
        let mut worst = [0.0_f64; 2];
        for stopped in (14..case.rows).step_by(13) {
            let mut playback = table.playback(1.0, &mut []).unwrap();
            let mut rows = Vec::new();
            while let Some(row) = playback.next_row() {
                rows.push(row);
                if rows.len() == stopped {
                    playback.stop();
                }
            }
            worst[0] = worst[0].max(case.check(&rows, stopped));
        }
        for stopped in (14..case.rows).step_by(30) {
            let mut window = vec![Knot::default(); 401];
            let segments = |_: &_| Ok(case.segments);
            let mut stream = LookAhead::new([line], [case.limits], segments, &mut window).unwrap();
            let mut rows = Vec::new();
            while let Some(row) = stream.next_row().unwrap() {
                rows.push(row);
                if rows.len() == stopped {
                    stream.stop();
                }
            }
            worst[1] = worst[1].max(case.check(&rows, stopped));
        }
        println!("{:?}, {} mm: {worst:.3?}", case.limits, case.length_mm);
        assert!(worst.iter().all(|worst| *worst <= 1.0), "{worst:?}");
    }
}
