//! Tables along paths, and steps along tables.

use core::convert::Infallible;
use core::hint::black_box;

use cortex_m_firmware::arm_line::{JOINT, ROWS, path, plan_in_f32};
use cortex_m_firmware::meter::Meter;
use path_timing::{AxisLimits, FeedCeiling, Knot, Path, PathPoint, Table};
use pvt_steps::{
    AxisSegments, PvtKnot, PvtQuantiser, PvtSteps, Ramp, RampLimits, Segment, SegmentPlayer,
};
use stepper_sync::{MinIntervals, Rate, StepScale};

use crate::next;

const SEGMENTS: u32 = 64;
const LEAST: MinIntervals = MinIntervals {
    step_ticks: 100,
    reversal_ticks: 100,
};

pub fn count(meter: &Meter) {
    line(meter);
    tables(meter);
    rows(meter);
    segments(meter);
    ramps(meter);
}

/// Two axes, one by the square of the other; cheap to place on, so that the table is counted.
#[derive(Clone, Copy, Debug)]
struct Parabola;

impl Path for Parabola {
    type Axes = [f64; 2];
    type Error = Infallible;

    fn length(&self) -> f64 {
        black_box(100.0)
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 2]>, Infallible> {
        Ok(PathPoint {
            position: [s, 0.01 * s * s],
            slope: [1.0, 0.02 * s],
        })
    }
}

/// The line of an arm that `play` plays.
fn line(meter: &Meter) {
    meter.count("Arm::path, 244 mm", "f64", 1, || {
        black_box(path());
    });
    let path = black_box(path());
    let mut knots = [Knot::default(); ROWS + 1];
    meter.count("Table::plan_in_f32, the line, 100 rows", "f64", 1, || {
        black_box(plan_in_f32(&path, &mut knots).len());
    });
    meter.count("Table::plan, the line, 100 rows", "f64", 1, || {
        let table = Table::plan([path], black_box([JOINT; 2]), |_| ROWS as u32, &mut knots);
        black_box(table.is_ok());
    });
    meter.count("ArmPath::point", "f64", 4, || {
        let _ = black_box(path.point(black_box(100.0)));
    });
    let single = path.in_f32().expect("lengths of f32");
    meter.count("ArmPathF32::point", "f32", 4, || {
        let _ = black_box(single.point(black_box(100.0)));
    });
}

fn tables(meter: &Meter) {
    let mut limits = AxisLimits {
        speed: 10.0,
        acceleration: 20.0,
        jerk: None,
    };
    let (mut knots, mut ceilings) = ([Knot::default(); 65], [FeedCeiling::default(); 65]);
    meter.count("Table::plan, 64 rows", "f64", 1, || {
        let table = Table::plan([Parabola], black_box([limits; 2]), |_| SEGMENTS, &mut knots);
        black_box(table.is_ok());
    });
    limits.jerk = Some(200.0);
    // Below 2^32 ticks of the meter.
    meter.count("Table::plan, 16 rows, jerk", "f64", 1, || {
        let table = Table::plan([Parabola], black_box([limits; 2]), |_| 16, &mut knots);
        black_box(table.is_ok());
    });
    let table =
        Table::plan([Parabola], [limits; 2], |_| SEGMENTS, &mut knots).expect("good limits");
    let mut rows = table.rows();
    meter.count("Rows::next", "f64", 32, || {
        black_box(next(&mut rows).is_some());
    });
    let playback = table.playback(1.0, &mut ceilings);
    let mut playback = playback.expect("room for all rows");
    meter.count("Playback::next_row", "f64", 32, || {
        black_box(playback.next_row().is_some());
    });
}

/// From rest over 400 and 80 steps to rest, at 10 MHz.
fn rows(meter: &Meter) {
    let tick_rate = Rate::from_hz(10_000_000).expect("not zero");
    let scale = StepScale::new(80.0).expect("not zero");
    let quantiser = PvtQuantiser::new(tick_rate, [scale; 2], [0.0; 2]).expect("in range");
    meter.count("PvtQuantiser::row, 2 axes", "ticks", 4, || {
        let row = quantiser.clone().row(0.5, black_box([5.0, -1.0]), [0.0; 2]);
        black_box(row.is_ok());
    });
    let row = quantiser
        .clone()
        .row(0.5, [5.0, -1.0], [0.0; 2])
        .expect("in range");
    let start = PvtSteps::new(quantiser.knots(), LEAST);
    meter.count("PvtSteps::push, 2 axes", "ticks", 4, || {
        let _ = black_box(start.clone().push(black_box(&row)));
    });
    let mut steps = start.clone();
    steps.push(&row).expect("slow enough");
    meter.count("PvtSteps::next, 2 axes", "ticks", 400, || {
        black_box(next(black_box(&mut steps)));
    });
}

fn segments(meter: &Meter) {
    let start = AxisSegments::new(PvtKnot::at_rest(0), LEAST);
    let mut axis = start.clone();
    axis.push(5_000_000, PvtKnot::at_rest(400))
        .expect("slow enough");
    let mut made = axis.clone();
    meter.count("AxisSegments::next", "ticks", 2, || {
        black_box(next(black_box(&mut made)));
    });
    let segment = axis.next().expect("400 steps");
    let mut buffer = [0; Segment::MAX_ENCODED_LEN];
    let bytes = segment.encode(&mut buffer);
    meter.count("Segment::decode", "ticks", 4, || {
        let _ = black_box(Segment::decode(black_box(bytes)));
    });
    let mut player = SegmentPlayer::new();
    meter.count("SegmentPlayer::load", "ticks", 4, || {
        black_box(player.load(black_box(&segment)));
    });
    let steps = u32::from(segment.count()).min(64);
    meter.count("SegmentPlayer::next", "ticks", steps, || {
        black_box(next(black_box(&mut player)));
    });
}

fn ramps(meter: &Meter) {
    let limits = RampLimits {
        start_millihertz: 100_000,
        max_millihertz: 2_000_000,
        accel_steps_per_s2: 20_000,
    };
    let rate = Rate::from_hz(1_000_000).expect("not zero");
    meter.count("Ramp::new, 2 axes", "ticks", 4, || {
        let _ = black_box(Ramp::new(black_box([400, -150]), &limits, rate));
    });
    let ramp = Ramp::new([400, -150], &limits, rate).expect("good limits");
    let [mut leading, _] = ramp.axes();
    meter.count("AxisRamp::next", "ticks", 700, || {
        black_box(next(black_box(&mut leading)));
    });
    let mut edges = ramp.edges();
    meter.count("Edges of 2 ramps: next", "ticks", 1000, || {
        black_box(next(black_box(&mut edges)));
    });
}
