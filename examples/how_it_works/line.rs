//! A line of a two-link arm: its time law, and how far the tool is off.

use machine_sim::{Axis, Figure, Plot, Point, Stroke};
use nalgebra::Vector2;
use pose2pulse::path_timing::{Accuracy, AxisLimits, Cubic, Curve, Knot, Table};
use pose2pulse::scara_kin::{Arm, ArmPath, Elbow, Joints};

use crate::Result;
use crate::between::between;

const FROM_MM: [f64; 2] = [-80.0, 100.0];
const TO_MM: [f64; 2] = [80.0, 100.0];
const JOINT: AxisLimits = AxisLimits {
    speed: 3.0,         // rad/s
    acceleration: 30.0, // rad/s²
    jerk: None,
};

/// The arm of the first example, and the path of its line.
fn line() -> Result<(Arm<f64>, ArmPath)> {
    let arm = Arm::new(132.0, 132.0)?; // mm
    let path = arm.path(Curve::line(FROM_MM, TO_MM)?, Elbow::Right)?;
    Ok((arm, path))
}

fn limits_of(end_s: f64, limit: f64) -> [Vec<Point>; 2] {
    [limit, -limit].map(|y| vec![[0.0, y], [end_s, y]])
}

/// Speeds and accelerations of both joints and the tool's speed, along the line.
pub(crate) fn time_law() -> Result<Figure> {
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
pub(crate) fn departure() -> Result<Figure> {
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
