//! A quarter of a circle on two axes: the pulses of X and Y, when each is due, and the path.
#![expect(clippy::print_stdout, reason = "that is what an example is for")]

use pulse_interp::{Arc, Rule, StepIntervals, Turn};

/// Timer ticks per step at the feed wanted: 10 mm/s, 100 steps/mm, a timer of 1 MHz.
const TICKS_PER_STEP: u32 = 1000;

fn main() -> Result<(), pulse_interp::ArcError> {
    // Start and end in steps from the centre.
    let arc = Arc::new([16, 0], [0, 16], Turn::CounterClockwise)?;
    let mut steps = arc.steps(Rule::Nearest);
    let mut intervals = StepIntervals::new(TICKS_PER_STEP);

    println!("{} steps\n   ticks   x   y", steps.remaining());
    let [mut x, mut y] = arc.start();
    let (mut ticks, mut picture) = (0, [[' '; 17]; 17]);
    loop {
        if let Some(cell) = cell(&mut picture, x, y) {
            *cell = '#';
        }
        // The interval before a step is read before the step is taken.
        let interval = intervals.next(steps.factor());
        let (Some(interval), Some(step)) = (interval, steps.next()) else {
            break;
        };
        ticks += interval;
        x += step.dx();
        y += step.dy();
        println!("{ticks:8} {x:3} {y:3}");
    }
    assert_eq!([x, y], arc.end());

    for row in picture.iter().rev() {
        println!("{}", row.iter().collect::<String>());
    }
    Ok(())
}

fn cell(picture: &mut [[char; 17]; 17], x: i32, y: i32) -> Option<&mut char> {
    let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
    picture.get_mut(y)?.get_mut(x)
}
