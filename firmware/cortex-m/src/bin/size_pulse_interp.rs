//! A line step by step at constant speed.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;

use pulse_interp::{Line, Rule, StepIntervals};

fn work() -> Option<u64> {
    let line = Line::new(black_box([30, -7])).ok()?;
    let mut intervals = StepIntervals::new(1000);
    let factor = line.step_factor();
    let mut ticks = 0;
    for step in line.steps(Rule::Nearest) {
        black_box(step.dx());
        ticks += intervals.next(factor)?;
    }
    Some(ticks)
}
