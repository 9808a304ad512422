//! How far a shaped tool departs, and what is said of it before anything runs.

use delta_kin::{Delta, Dimensions, nalgebra::Vector3};
use path_timing::{AxisLimits, Curve, Knot, Mode, Row, Table};
use scara_kin::{Arm, Elbow, Joints};

use super::closed_form::SHAPERS;
use super::rows::{at, shaped};
use crate::support::vectors::{norm, sub};

const MODE: Mode = Mode {
    hz: 40.0,
    damping: 0.05,
};

/// A bound is at most so many times what is measured.
const TIGHT: f64 = 3.0;

/// The largest distance of `tool` between the shaped motion and the motion `delay_s` before, in
/// fine samples.
fn measured<const N: usize, const D: usize>(
    rows: &[Row<[f64; N]>],
    shaped: &[Row<[f64; N]>],
    delay_s: f64,
    tool: impl Fn([f64; N]) -> [f64; D],
) -> f64 {
    const SAMPLES: u32 = 20_000;
    let end_s = shaped[shaped.len() - 1].time_s;
    let samples = (0..=SAMPLES).map(|n| end_s * f64::from(n) / f64::from(SAMPLES));
    let places = samples.map(|time_s| {
        let axes = |rows, time_s| core::array::from_fn(|axis| at(rows, time_s, axis));
        let shaped = tool(axes(shaped, time_s));
        norm(sub(shaped, tool(axes(rows, time_s - delay_s))))
    });
    places.fold(0.0, f64::max)
}

/// Of places of 100 mm; an axis that is at its limit all along reaches the bound.
const ROUNDING_MM: f64 = 1e-12;

#[test]
fn a_cartesian_tool_departs_by_at_most_the_bound() {
    let line = Curve::line([0.0, 0.0], [60.0, 80.0]).unwrap();
    let axis = AxisLimits {
        speed: 300.0,
        acceleration: 5000.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 201];
    let table = Table::plan([line], [axis; 2], |_| 200, &mut knots).unwrap();
    let rows: Vec<_> = table.rows().collect();
    for (name, make, ..) in SHAPERS {
        for other in [MODE, Mode { hz: 63.0, ..MODE }] {
            let shapers = [make(MODE).unwrap(), make(other).unwrap()];
            let shaped = shaped(rows.iter().copied(), shapers);
            let delay_s = shapers[0].delay_s();
            let is = measured(&rows, &shaped, delay_s, |place| place);
            // The line's y axis has all of its acceleration, x three quarters of it.
            let [x, y] = shapers.map(|shaper| shaper.departure(5000.0));
            let bound = (0.75 * x).hypot(y);
            println!("{name}: departs by {is:.4} mm, at most {bound:.4}");
            let is_kept = is <= bound + ROUNDING_MM && bound <= TIGHT * is;
            assert!(is_kept, "{name}: {is}, {bound}");
        }
    }
}

/// Speeds alone, that jump once and twice within the shaper's time.
#[test]
fn an_axis_whose_speed_jumps_departs_by_at_most_the_bound() {
    let rows = |speeds: &[f64], gap_s: f64| {
        let (mut time_s, mut place) = (0.0, 0.0);
        let mut rows = vec![Row::default()];
        for speed in speeds {
            let row = |duration_s, time_s, place| Row {
                time_s,
                duration_s,
                position: [place],
                velocity: [*speed],
                ..Row::default()
            };
            rows.push(row(0.0, time_s, place));
            (time_s, place) = (time_s + gap_s, place + speed * gap_s);
            rows.push(row(gap_s, time_s, place));
        }
        rows.push(Row {
            duration_s: 0.0,
            velocity: [0.0],
            ..rows[rows.len() - 1]
        });
        rows
    };
    for (name, make, ..) in SHAPERS {
        let shaper = make(MODE).unwrap();
        for (speeds, gap_s, jump) in [(&[7.0][..], 0.3, 7.0), (&[7.0, 12.0], 1e-4, 12.0)] {
            let rows = rows(speeds, gap_s);
            let shaped = shaped(rows.iter().copied(), [shaper]);
            let is = measured(&rows, &shaped, shaper.delay_s(), |place| place);
            // Back to rest at once, too.
            let bound = shaper.departure_of_jumps(if gap_s < 0.1 { 2.0 * jump } else { jump });
            println!("{name}: departs by {is:.4} mm, at most {bound:.4}");
            assert!(is <= bound + 1e-9, "{name}: {is}, {bound}");
            assert!(gap_s < 0.1 || is > 0.99 * bound, "{name}: {is}, {bound}");
        }
    }
}

#[test]
fn the_tool_of_an_arm_departs_by_at_most_the_bound() {
    let arm = Arm::new(132.0, 132.0).unwrap();
    let lines = [
        [[-80.0, 100.0], [80.0, 100.0]],
        [[40.0, 200.0], [180.0, 90.0]],
        [[100.0, 20.0], [100.0, 160.0]],
    ];
    let joint = AxisLimits {
        speed: 3.0,
        acceleration: 30.0,
        jerk: None,
    };
    for [from, to] in lines {
        let path = arm
            .path(Curve::line(from, to).unwrap(), Elbow::Right)
            .unwrap();
        let mut knots = [Knot::default(); 201];
        let table = Table::plan([path], [joint; 2], |_| 200, &mut knots).unwrap();
        let rows: Vec<_> = table.rows().collect();
        for (name, make, ..) in SHAPERS {
            let shapers = [MODE, Mode { hz: 55.0, ..MODE }].map(|mode| make(mode).unwrap());
            let shaped = shaped(rows.iter().copied(), shapers);
            let tool = |[shoulder, elbow]: [f64; 2]| {
                <[f64; 2]>::from(arm.forward(Joints::new(shoulder, elbow)).coords)
            };
            let is = measured(&rows, &shaped, shapers[0].delay_s(), tool);
            let off = shapers.map(|shaper| shaper.departure(30.0));
            let bound = arm.tool_shift(off);
            println!("{name}: departs by {is:.4} mm, at most {bound:.4}");
            assert!(is <= bound && bound <= TIGHT * is, "{name}: {is}, {bound}");
        }
    }
}

#[test]
fn the_platform_of_a_delta_departs_by_at_most_the_bound() {
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .unwrap();
    let lines = [
        [[-60.0, 20.0, -280.0], [60.0, -10.0, -280.0]],
        [[0.0, 0.0, -300.0], [0.0, 0.0, -230.0]],
        [[40.0, 60.0, -260.0], [-30.0, -50.0, -320.0]],
    ];
    let joint = AxisLimits {
        speed: 6.0,
        acceleration: 100.0,
        jerk: None,
    };
    for [from, to] in lines {
        let path = delta.path(Curve::line(from, to).unwrap()).unwrap();
        let mut knots = [Knot::default(); 201];
        let table = Table::plan([path], [joint; 3], |_| 200, &mut knots).unwrap();
        let rows: Vec<_> = table.rows().collect();
        for (name, make, ..) in SHAPERS {
            let shapers = [40.0, 50.0, 60.0].map(|hz| make(Mode { hz, ..MODE }).unwrap());
            let shaped = shaped(rows.iter().copied(), shapers);
            let platform = |angles: [f64; 3]| {
                let point = delta.forward(Vector3::from(angles)).unwrap();
                <[f64; 3]>::from(point.coords)
            };
            let is = measured(&rows, &shaped, shapers[0].delay_s(), platform);
            let off = shapers.map(|shaper| shaper.departure(100.0));
            let bounds = table.spans().map(|span| path.shifted_departure(&span, off));
            let bound = bounds.fold(0.0, f64::max);
            println!("{name}: departs by {is:.4} mm, at most {bound:.4}");
            assert!(is <= bound && bound <= TIGHT * is, "{name}: {is}, {bound}");
        }
    }
}
