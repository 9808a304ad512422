//! A line of three axes, step by step, and what a scale says of one of them.
#![expect(clippy::print_stdout, reason = "that is what an example is for")]

use core::error::Error;

use pulse_interp::{Arc, AxesLine, AxisLoop, Direction, LoopSettings, Rule, ScaleRatio, Turn};

fn main() -> Result<(), Box<dyn Error>> {
    // 5 counts a step; corrected from 4 counts on, an alarm above 100.
    let mut x = AxisLoop::new(LoopSettings {
        ratio: ScaleRatio::new(5, 1)?,
        dead_band_counts: 3,
        alarm_counts: 100,
    })?;
    for step in AxesLine::new([7, -4, 2])?.steps() {
        println!("axis {} {:?}", step.axis, step.direction);
        if step.axis == 0 {
            x.command(step.direction);
        }
    }
    let steps = x.correction(28)?; // one step and 2 counts short
    println!(
        "{} steps commanded, {steps} to make up for",
        x.commanded_steps()
    );
    assert_eq!(Direction::Positive.sign(), steps);

    // An arc by moves of both axes: how many of them are diagonal.
    let arc = Arc::new([16, 0], [0, 16], Turn::CounterClockwise)?;
    let diagonal = arc.moves().filter(|it| it.is_diagonal()).count();
    println!(
        "{diagonal} of {} moves are diagonal, within a circle of {} steps²; by single steps {}",
        arc.moves().count(),
        arc.radius_squared(),
        arc.steps(Rule::Nearest).count()
    );
    Ok(())
}
