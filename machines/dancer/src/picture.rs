//! The picture of a run: the angle of each motor over time, and how far off it would be under the
//! other law.

use machine_sim::{Axis, Figure, Plot, Stroke};

use crate::score::Score;
use crate::simulation::Run;

/// Height of a motor's chart.
const HEIGHT_PX: f64 = 110.0;

/// `dance.svg`: what the motors did, and what they would have done under the other law.
#[must_use]
pub fn picture(score: &Score, run: &Run) -> Figure {
    let steps: u64 = run.steps.iter().sum();
    let title = format!("Danced: {steps} half steps in {} s", run.duration_s);
    let mut figure = Figure::new(title).with_note(score.title());
    let other = run.law.other().name();
    let mut apart = Plot::chart(time(run), Axis::new("half steps").including(0.0)).with_title(
        format!("The same frames under the law {other}: how far from where they were danced"),
    );
    for (motor, (name, half_step_deg)) in score.motors().enumerate() {
        let angle = |[here, _]: [i32; 2]| f64::from(here) * half_step_deg;
        let angle_axis = Axis::new("angle in °").including(0.0);
        let chart = Plot::chart(time(run), angle_axis)
            .with_title(name)
            .with_height(HEIGHT_PX)
            .line("", Stroke::ACTUAL, over_time(run, motor, angle));
        figure = figure.with_row([chart]);
        let off = |[here, there]: [i32; 2]| f64::from(there) - f64::from(here);
        apart = apart.line(name, Stroke::series(motor), over_time(run, motor, off));
    }
    figure.with_row([apart])
}

fn time(run: &Run) -> Axis {
    Axis::new("time in s").over(0.0..=run.duration_s)
}

/// A value of a motor at the end of every frame, from its position as danced and under the other
/// law.
fn over_time(run: &Run, motor: usize, value: impl Fn([i32; 2]) -> f64) -> Vec<[f64; 2]> {
    let (frame_s, both) = (run.frame_s(), run.positions.iter().zip(&run.other));
    let of_motor = both.filter_map(|(here, there)| Some([*here.get(motor)?, *there.get(motor)?]));
    (0_u32..)
        .zip(of_motor)
        .map(|(frame, both)| [f64::from(frame) * frame_s, value(both)])
        .collect()
}
