//! The figures of the book's chapter on how it works, from the crates themselves: the time law of an
//! arm's line, its departure between rows, and what a shaper does to a machine that rings.
//!
//! `cargo run --example how_it_works -- [FOLDER]`

use core::error::Error;
use core::f64::consts::TAU;
use std::path::PathBuf;

use machine_sim::{Axis, Figure, Plot, Point, Stroke};
use nalgebra::Vector2;
use pose2pulse::path_timing::{
    Accuracy, AxisLimits, Cubic, Curve, Knot, Mode, Row, Shaped, Shaper, Table,
};
use pose2pulse::scara_kin::{Arm, ArmPath, Elbow, Joints};

type Result<T, E = Box<dyn Error>> = core::result::Result<T, E>;

const FROM_MM: [f64; 2] = [-80.0, 100.0];
const TO_MM: [f64; 2] = [80.0, 100.0];
const JOINT: AxisLimits = AxisLimits {
    speed: 3.0,         // rad/s
    acceleration: 30.0, // rad/s²
    jerk: None,
};
/// Places of a cubic that are drawn.
const PLACES: u32 = 24;

fn main() -> Result<()> {
    let folder = std::env::args_os().nth(1).map(PathBuf::from);
    let folder = folder.unwrap_or_else(|| "target/how_it_works".into());
    std::fs::create_dir_all(&folder)?;
    for (name, figure) in [
        ("time-law.svg", time_law()?),
        ("departure.svg", departure()?),
        ("shaping.svg", shaping()?),
    ] {
        std::fs::write(folder.join(name), figure.to_string())?;
    }
    println!(
        "in {}: time-law.svg, departure.svg, shaping.svg",
        folder.display()
    );
    Ok(())
}

/// The arm of the first example, and the path of its line.
fn line() -> Result<(Arm<f64>, ArmPath)> {
    let arm = Arm::new(132.0, 132.0)?; // mm
    let path = arm.path(Curve::line(FROM_MM, TO_MM)?, Elbow::Right)?;
    Ok((arm, path))
}

/// Times, positions and velocities between the rows of a table, on the cubics that the axes run.
fn between<const N: usize>(
    rows: &[Row<[f64; N]>],
) -> impl Iterator<Item = (f64, [f64; N], [f64; N])> {
    rows.windows(2).flat_map(|pair| {
        let [from, to] = pair else {
            unreachable!("windows of two")
        };
        let (from_s, duration_s) = (from.time_s, to.duration_s);
        let axes: Vec<Cubic> = Cubic::between(from, to).collect();
        (0..PLACES).map(move |place| {
            let part = f64::from(place) / f64::from(PLACES);
            let (mut positions, mut velocities) = ([0.0; N], [0.0; N]);
            let values = positions.iter_mut().zip(&mut velocities);
            for (cubic, (position, velocity)) in axes.iter().zip(values) {
                (*position, *velocity) = (cubic.position(part), velocity_of(cubic, part));
            }
            (from_s + part * duration_s, positions, velocities)
        })
    })
}

/// By the differences of the control points.
fn velocity_of(cubic: &Cubic, part: f64) -> f64 {
    let [a, b, c, d] = cubic.control_points();
    let rest = 1.0 - part;
    let slope = (b - a) * rest * rest + 2.0 * (c - b) * rest * part + (d - c) * part * part;
    3.0 * slope / cubic.duration_s
}

fn limits_of(end_s: f64, limit: f64) -> [Vec<Point>; 2] {
    [limit, -limit].map(|y| vec![[0.0, y], [end_s, y]])
}

/// Speeds and accelerations of both joints and the tool's speed, along the line.
fn time_law() -> Result<Figure> {
    let (arm, path) = line()?;
    let mut knots = [Knot::default(); 101];
    let table = Table::plan([path], [JOINT; 2], |_| 100, &mut knots)?;
    let rows = table.rows().collect::<Vec<_>>();
    let (mut speeds, mut accelerations) = ([vec![], vec![]], [vec![], vec![]]);
    let mut tool = Vec::new();
    for (time_s, [shoulder, elbow], rates) in between(&rows) {
        let joints = Joints::new(shoulder, elbow);
        let velocity = arm.tool_velocity(joints, Vector2::from(rates));
        tool.push([time_s, velocity.norm()]);
        for (line, rate) in speeds.iter_mut().zip(rates) {
            line.push([time_s, rate]);
        }
    }
    for pair in rows.windows(2) {
        let [from, to] = pair else { continue };
        for (line, cubic) in accelerations.iter_mut().zip(Cubic::between(from, to)) {
            let times_s = [from.time_s, to.time_s];
            line.extend(
                times_s
                    .into_iter()
                    .zip(cubic.accelerations())
                    .map(|(t, a)| [t, a]),
            );
        }
    }
    let end_s = table.duration_s();
    let [shoulder, elbow] = speeds;
    let [shoulder_acc, elbow_acc] = accelerations;
    let time = || Axis::new("time in s");
    Ok(Figure::new("A line of 160 mm, as fast as both joints allow")
        .with_note("Two-link arm 132 + 132 mm, at most 3 rad/s and 30 rad/s² in each joint, 100 segments")
        .with_row([Plot::chart(time(), Axis::new("tool in mm/s").including(0.0))
            .line("tool", Stroke::ACTUAL, tool)])
        .with_row([Plot::chart(time(), Axis::new("joints in rad/s"))
            .line("shoulder", Stroke::series(0), shoulder)
            .line("elbow", Stroke::series(1), elbow)
            .lines("limit", Stroke::LIMIT, limits_of(end_s, JOINT.speed))])
        .with_row([Plot::chart(time(), Axis::new("joints in rad/s²"))
            .line("shoulder", Stroke::series(0), shoulder_acc)
            .line("elbow", Stroke::series(1), elbow_acc)
            .lines("limit", Stroke::LIMIT, limits_of(end_s, JOINT.acceleration))]))
}

/// The tool's distance from the line while the joints run their cubics, and its bound.
fn departure() -> Result<Figure> {
    const TOLERANCE_MM: f64 = 0.01;
    let (arm, path) = line()?;
    let accuracy = Accuracy {
        min_segments: 8,
        max_departure: TOLERANCE_MM,
        max_time_ratio: f64::INFINITY,
    };
    let mut knots = [Knot::default(); 200];
    let table = Table::plan_within([path], [JOINT; 2], accuracy, ArmPath::departure, &mut knots)?;
    let rows = table.rows().collect::<Vec<_>>();
    let off = between(&rows).map(|(time_s, [shoulder, elbow], _)| {
        let tool = arm.forward(Joints::new(shoulder, elbow));
        [time_s, (tool.y - FROM_MM[1]) * 1000.0] // the line is parallel to x
    });
    let bounds = table.spans().zip(rows.windows(2)).map(|(span, pair)| {
        let bound_um = path.departure(&span) * 1000.0;
        let times = pair.iter().map(|row| row.time_s);
        times.map(|time_s| [time_s, bound_um]).collect::<Vec<_>>()
    });
    let note = format!(
        "{} segments keep {TOLERANCE_MM} mm; the bound of each is proven, not sampled",
        table.len() - 1
    );
    Ok(
        Figure::new("How far the tool is off its line between two rows")
            .with_note(note)
            .with_row([Plot::chart(
                Axis::new("time in s"),
                Axis::new("off the line in µm").including(10.0),
            )
            .with_height(260.0)
            .line("tool", Stroke::ACTUAL, off.collect::<Vec<_>>())
            .lines(
                "bound of the segment",
                Stroke::LIMIT,
                bounds.collect::<Vec<_>>(),
            )]),
    )
}

/// A mass on a spring whose other end moves by 20 mm, shaped and not.
fn shaping() -> Result<Figure> {
    const MODE: Mode = Mode {
        hz: 40.0,
        damping: 0.03,
    };
    const MOVE_MM: f64 = 20.0;
    /// After the motion, in s.
    const AFTER_S: f64 = 0.1;
    const STEP_S: f64 = 1e-5;
    let axis = AxisLimits {
        speed: 300.0,         // mm/s
        acceleration: 5000.0, // mm/s²
        jerk: None,
    };
    let mut knots = [Knot::default(); 41];
    let table = Table::plan([Curve::line([0.0], [MOVE_MM])?], [axis], |_| 40, &mut knots)?;
    let mut plot = Plot::chart(
        Axis::new("time in s"),
        Axis::new("mass, off its place in mm"),
    )
    .with_height(300.0);
    for (index, (name, shaper)) in [
        ("none", Shaper::none()),
        ("ZV", Shaper::zv(MODE)?),
        ("EI", Shaper::ei(MODE)?),
    ]
    .into_iter()
    .enumerate()
    {
        let mut memory = [Row::default(); 44];
        let rows = Shaped::new(table.rows(), [shaper], &mut memory);
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        let omega = TAU * MODE.hz;
        let (mut x, mut v, mut time_s) = (0.0, 0.0, 0.0);
        let mut left = Vec::new();
        let mut follow = |end: f64, until_s: f64| {
            while time_s < until_s {
                v += (omega * (end - x) - 2.0 * MODE.damping * v) * omega * STEP_S;
                x += v * STEP_S;
                time_s += STEP_S;
            }
            left.push([time_s, x - end]);
        };
        for (time_s, [end], _) in between(&rows) {
            follow(end, time_s);
        }
        let end_s = rows.last().ok_or("no rows")?.time_s;
        for place in 0..=200_u32 {
            follow(MOVE_MM, end_s + AFTER_S * f64::from(place) / 200.0);
        }
        plot = plot.line(name, Stroke::series(index), left);
    }
    Ok(
        Figure::new("A move of 20 mm with a machine that rings at 40 Hz")
            .with_note("The mass rides on a spring: how far it is from where the motor is")
            .with_row([plot]),
    )
}
