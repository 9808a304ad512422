//! The picture of a run: workspace, mechanism and paths from above and from the front, and the
//! platform's speed and acceleration over time.

use anyhow::Result;
use known_load::{torque_chart, vibration_chart};
use machine_sim::{Axis, Figure, Plot, Stroke};
use nalgebra::{Point3, Vector3};

use crate::motion::Motion;
use crate::plan::seconds;
use crate::report::ARMS;
use crate::simulation::{Driven, Run};

/// Points of an outline.
const OUTLINE: u32 = 240;

/// A point seen along an axis.
type View = fn(&Point3<f64>) -> [f64; 2];
type Line = Vec<Point3<f64>>;

impl Run<'_> {
    /// Workspace, mechanism and paths, and the platform's speed and acceleration, as an SVG figure.
    ///
    /// # Errors
    /// The machine has no workspace around its path.
    pub fn picture(&self) -> Result<Figure> {
        let duration_s = seconds(self.record.duration_ticks());
        let title = format!(
            "Delta: {} moves, {} steps in {duration_s:.1} s",
            self.record.moves.len(),
            self.driven.steps
        );
        let note = |name: &str, driven: &Driven| {
            let lost: u64 = driven.motors.iter().map(|motor| motor.lost_steps).sum();
            format!(
                "{name}: {:.1} s, at most {:.4} mm off the lines; a simulated motor loses {lost} steps.",
                driven.duration_s, driven.max_path_error_mm
            )
        };
        let tick = format!("By the {:.0} ms control tick", self.machine.tick_s * 1000.0);
        let motion = match self.record.motion {
            Motion::Rounded => "Round the corners, from rest to rest",
            Motion::Trains => "Each line at its feed, without ramps",
        };
        let window = format!("mean over {:.0} ms", self.motion.window_s() * 1000.0);
        let time = || Axis::new("time in s").over(0.0..=duration_s);
        let speed = Plot::chart(time(), Axis::new("speed in mm/s").including(0.0))
            .with_title("Speed of the platform")
            .line("feed", Stroke::COMMANDED, feeds(self))
            .line(&window, Stroke::ACTUAL, self.motion.speeds());
        let acceleration = Plot::chart(time(), Axis::new("acceleration in m/s²").including(0.0))
            .with_title("Acceleration of the platform")
            .line(&window, Stroke::ACTUAL, accelerations(self));
        let mut figure = Figure::new(title)
            .with_note(note(motion, &self.driven))
            .with_note(note("By trains at the feed", &self.trains))
            .with_note(note(&tick, &self.ticked))
            .with_row(maps(self)?)
            .with_row([speed])
            .with_row([acceleration]);
        if let Some(used) = &self.record.torque {
            figure = figure.with_row([torque_chart(used, ARMS, time())]);
        }
        if let Some(vibration) = &self.driven.vibration {
            figure = figure.with_row([vibration_chart("the tool", vibration, self.unshaped())]);
        }
        Ok(figure)
    }
}

/// What was asked for, over time.
fn feeds(run: &Run<'_>) -> impl Iterator<Item = [f64; 2]> {
    let mut start_s = 0.0;
    run.record.moves.iter().flat_map(move |line| {
        let end_s = seconds(line.end_ticks);
        let begin_s = core::mem::replace(&mut start_s, end_s);
        [[begin_s, line.feed_mm_s], [end_s, line.feed_mm_s]]
    })
}

fn accelerations(run: &Run<'_>) -> impl Iterator<Item = [f64; 2]> {
    const MM_PER_M: f64 = 1000.0;
    let samples = run.motion.accelerations();
    samples.map(|[t_s, mm_s2]| [t_s, mm_s2 / MM_PER_M])
}

/// From above and from the front.
fn maps(run: &Run<'_>) -> Result<[Plot; 2]> {
    let home = run.machine.point([0; 3])?.z;
    let lowest = run.driven.path.iter().fold(home, |z, point| z.min(point.z));
    let centre = f64::midpoint(home, lowest);
    let delta = run.machine.delta;
    let flat = delta.horizontal_slice(centre, OUTLINE)?.collect();
    let upright = delta.vertical_slice(0.0, centre, OUTLINE)?.collect();
    let [x, y, z] = ["x in mm", "y in mm", "z in mm"];
    let map = |across: &str, up: &str| Plot::map(Axis::new(across), Axis::new(up));
    let above = map(x, y).with_title("Seen from above");
    let front = map(x, z).with_title("Seen from the front");
    Ok([
        drawn(
            run,
            above,
            (&format!("workspace at z = {centre:.0} mm"), flat),
            |at| [at.x, at.y],
        )?,
        drawn(run, front, ("workspace at y = 0", upright), |at| {
            [at.x, at.z]
        })?,
    ])
}

fn drawn(
    run: &Run<'_>,
    plot: Plot,
    (workspace, outline): (&str, Line),
    view: View,
) -> Result<Plot> {
    let seen = |line: &Line| line.iter().map(view).collect::<Vec<_>>();
    let asked = run
        .record
        .moves
        .iter()
        .map(|it| [view(&it.from), view(&it.to)]);
    let mechanism = mechanism(run)?;
    let plot = plot
        .line(workspace, Stroke::LIMIT, seen(&closed(outline)))
        .lines(
            "mechanism at the end",
            Stroke::MACHINE,
            mechanism.iter().map(seen),
        )
        .lines("lines", Stroke::COMMANDED, asked)
        .line("control tick", Stroke::OTHER, seen(&run.ticked.path))
        .line(
            run.record.motion.name(),
            Stroke::ACTUAL,
            seen(&run.driven.path),
        );
    Ok(match run.driven.path.first() {
        Some(start) => plot.start(view(start)),
        None => plot,
    })
}

/// Base, arms and platform where the steps ended.
fn mechanism(run: &Run<'_>) -> Result<Vec<Line>> {
    let machine = run.machine;
    let pose = machine.delta.pose_of(machine.angles(run.driven.end))?;
    let platform = pose.point();
    let (mut shoulders, mut wrists, mut parts) = (Vec::new(), Vec::new(), Vec::new());
    for (geometry, elbow) in machine.delta.arms().iter().zip(pose.elbows()) {
        let (sin, cos) = geometry.azimuth.sin_cos();
        let outward = Vector3::new(cos, sin, 0.0);
        let shoulder = Point3::from(outward * geometry.base);
        let wrist = platform + outward * geometry.platform;
        shoulders.push(shoulder);
        wrists.push(wrist);
        parts.push(vec![shoulder, *elbow, wrist]);
    }
    parts.extend([closed(shoulders), closed(wrists)]);
    Ok(parts)
}

/// A line that ends where it begins.
fn closed(mut line: Line) -> Line {
    line.extend(line.first().copied());
    line
}
