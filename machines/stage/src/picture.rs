//! The picture of a run: the programmed path, the stage's with and without corrections, the largest
//! deviation enlarged, and the deviations over time.

use known_load::{torque_chart, vibration_chart};
use machine_sim::{Axis, Colour, Figure, Mark, Plot, Stroke};

use crate::grid::STEPS_PER_MM;
use crate::motors::FollowedAxes;
use crate::record::{Leg, Seen};
use crate::report::{AXES, TABLES};
use crate::run::Run;
use crate::stage::switches_mm;

const UM_PER_MM: f64 = 1000.0;
/// Half the side of the enlarged square, in steps.
const ENLARGED_STEPS: f64 = 10.0;
const WORST: Colour = Colour::rgb(0, 125, 90);

impl Run {
    /// The programmed path and both stages' as an SVG figure.
    #[must_use]
    pub fn picture(&self) -> Figure {
        let (record, [closed_mm, open_mm]) = (&self.record, self.closing_mm);
        let measured = |name: &str, seen: &Seen, end_mm: f64| {
            let max = seen.worst.deviation_mm;
            format!("{name}: {max:.3} mm off the curve at most, {end_mm:.3} mm off at the end.")
        };
        let [steps_x, steps_y] = record.steps;
        let title = format!(
            "Stage: {steps_x} + {steps_y} steps, {}, in {:.1} s",
            self.settings.stepping.name(),
            self.duration_s
        );
        let figure =
            Figure::new(title).with_note(measured("Closed loop", &record.closed, closed_mm));
        let closed = deviations(self, "closed loop", Stroke::ACTUAL, &record.closed);
        let [speed, acceleration] = motion(self);
        if !is_lossy(self) {
            let figure = figure
                .with_note(motors(self))
                .with_row(maps(self))
                .with_row([speed])
                .with_row([acceleration])
                .with_row([closed]);
            return with_load(self, figure);
        }
        let open = deviations(self, "open loop", Stroke::OTHER, &record.open);
        let [closed_lost, open_lost] = self.lost;
        let lost = format!(
            "Steps lost: {closed_lost} in the closed loop, {} corrected; {open_lost} in the open loop.",
            record.corrected
        );
        let figure = figure
            .with_note(measured("Open loop", &record.open, open_mm))
            .with_note(lost)
            .with_row(maps(self))
            .with_note(motors(self))
            .with_row([speed])
            .with_row([acceleration])
            .with_row([closed, open])
            .with_row([corrections(self)]);
        with_load(self, figure)
    }
}

/// With what the motors are asked for and how the tables swing, where that is known.
fn with_load(run: &Run, mut figure: Figure) -> Figure {
    if let Some(used) = run.torque() {
        let time = Axis::new("time in s").over(0.0..=run.duration_s);
        figure = figure.with_row([torque_chart(used, AXES, time)]);
    }
    for (table, (swings, unshaped)) in TABLES.iter().zip(run.vibration().into_iter().flatten()) {
        figure = figure.with_row([vibration_chart(table, swings, unshaped)]);
    }
    figure
}

fn motors(run: &Run) -> String {
    let lost = |followed: &FollowedAxes| {
        let (s, lost) = (followed.duration_s, followed.lost_steps());
        format!("{lost} steps in {s:.1} s")
    };
    format!(
        "Lost by a simulated motor of limited torque: {}; at the feed throughout: {}.",
        lost(&run.followed),
        lost(&run.at_feed)
    )
}

/// Speed along the path, and the larger axis' acceleration, by the steps.
fn motion(run: &Run) -> [Plot; 2] {
    let motion = &run.followed.motion;
    let window = format!("mean over {:.0} ms", motion.window_s() * 1000.0);
    let speed = time_chart(run, "speed in mm/s")
        .with_title("Speed along the path")
        .line(&window, Stroke::ACTUAL, motion.speeds());
    // Motors start and stop with a speed: over the window that shows as an acceleration, too.
    let with_jumps = format!("{window}, start-stop speeds included");
    let mut acceleration =
        time_chart(run, "acceleration in mm/s²").with_title("Acceleration of X or Y, the larger");
    // Where the load is known, it is torque that limits.
    if run.machine.load.is_none() {
        let limit = [0.0, run.duration_s].map(|t| [t, run.machine.max_acceleration_mm_s2]);
        acceleration = acceleration.line("limit of an axis", Stroke::LIMIT, limit);
    }
    [
        speed,
        acceleration.line(&with_jumps, Stroke::ACTUAL, motion.axis_accelerations()),
    ]
}

fn is_lossy(run: &Run) -> bool {
    let [closed, open] = run.lost;
    closed + open > 0
}

fn maps(run: &Run) -> Vec<Plot> {
    let programmed = |with_rapids: bool| {
        let motions = run.record.programmed.iter();
        let motions = motions.filter(move |it| with_rapids || !it.is_rapid);
        motions.map(|it| it.points().into_iter().map(|at| [at.x, at.y]))
    };
    let whole = map(
        run,
        Plot::map(Axis::new("X in mm"), Axis::new("Y in mm"))
            .with_weight(2.1)
            .lines("programmed", Stroke::COMMANDED, programmed(false)),
    );
    let worst = &run.record.closed.worst;
    let Some(at) = worst.at else {
        return vec![whole];
    };
    let half = ENLARGED_STEPS / STEPS_PER_MM;
    let around = |name: &str, mm: f64| Axis::new(name).over(mm - half..=mm + half);
    let steps = worst.steps.iter().map(|at| [at.x, at.y]);
    let near = Plot::map(around("X in mm", at.x), around("Y in mm", at.y))
        .with_title("Enlarged: largest deviation")
        .lines("", Stroke::COMMANDED, programmed(true))
        .line("", Stroke::ACTUAL, steps);
    let ring = |plot: Plot, name: &str| plot.marks(name, Mark::Ring, WORST, [[at.x, at.y]]);
    vec![ring(whole, "largest deviation"), ring(near, "")]
}

/// Switches, and the paths of both stages.
fn map(run: &Run, plot: Plot) -> Plot {
    let legs = |seen: &Seen, is_rapid: bool| -> Vec<Vec<[f64; 2]>> {
        let point = |&[_, x, y]: &[f64; 3]| [x, y];
        let line = |leg: &Leg| leg.points.iter().map(point).collect();
        let legs = seen.legs.iter().filter(|leg| leg.is_rapid == is_rapid);
        legs.map(line).collect()
    };
    let [[x0, x1], [y0, y1]] = switches_mm();
    let switches = [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]];
    let (closed, open) = (&run.record.closed, &run.record.open);
    let mut plot = plot.line("limit switches", Stroke::LIMIT, switches);
    if is_lossy(run) {
        plot = plot.lines("open loop", Stroke::OTHER, legs(open, false));
    }
    plot = plot
        .lines("rapid", Stroke::RAPID, legs(closed, true))
        .lines("closed loop", Stroke::ACTUAL, legs(closed, false));
    match closed.legs.first().and_then(|leg| leg.points.first()) {
        Some(&[_, x, y]) => plot.start([x, y]),
        None => plot,
    }
}

/// How far a stage is from the programmed curve.
fn deviations(run: &Run, name: &str, stroke: Stroke, seen: &Seen) -> Plot {
    let points = seen.deviations().map(|[t, mm]| [t, mm * UM_PER_MM]);
    time_chart(run, "distance in µm")
        .with_title("Distance from the programmed curve")
        .line(name, stroke, points)
}

fn corrections(run: &Run) -> Plot {
    let start = [[0.0, 0.0]].into_iter();
    let corrected = run.corrections();
    time_chart(run, "steps")
        .with_title("Corrections so far")
        .line("corrected", Stroke::series(2), start.chain(corrected))
}

fn time_chart(run: &Run, name: &str) -> Plot {
    let time = Axis::new("time in s").over(0.0..=run.duration_s);
    Plot::chart(time, Axis::new(name).including(0.0))
}
