//! When and which axis steps.

use core::hint::black_box;

use motor_phases::{Accumulation, LatchWrites, Latches, Phases, SpeedLaw, Stepping, Wiring};
use pulse_interp::{Arc, AxisLoop, Line, LoopSettings, Rule, ScaleRatio, StepIntervals, Turn};
use pvt_steps::{JoinedSegments, PvtQuantiser, PvtSteps, Ramp, RampLimits, Segment};
use stepper_sync::{Position, Rate, StepDirTiming, StepScale, Timer, Trains};

use super::holds;
/// Trains that end together, timer reloads, positions.
pub fn trains() -> Option<()> {
    let timer = Timer::mcs51_mode1(black_box(11_059_200)).ok()?;
    let rate = Rate::from_millihertz(black_box(112_800)).ok()?;
    let half_period = timer.half_period(rate).ok()?.nearest();
    holds(timer.reload(half_period) == Ok(0xF00B))?;
    let trains = Trains::new(black_box([30, -7]), half_period).ok()?;
    holds(trains.edges().last()?.ticks == trains.end_ticks())?;
    let [fast, slow] = trains.axes();
    holds(fast.sum::<u64>() == slow.clone().sum())?;
    let mut ticks = 0;
    for reload in timer.reloads(slow) {
        ticks += reload.ok()?.ticks;
    }
    holds(ticks == trains.end_ticks())?;
    let mut position = Position::home();
    position.apply(trains.steps()).ok()?;
    holds(position.homing() == [-30, 7])
}

/// A rapid move whose axes end together.
pub fn ramp() -> Option<()> {
    let limits = RampLimits {
        start_millihertz: 0,
        max_millihertz: 2_000_000,
        accel_steps_per_s2: black_box(10_000),
    };
    let ramp = Ramp::new([4000, -1500], &limits, Rate::from_hz(1_000_000).ok()?).ok()?;
    holds(ramp.end_ticks() == 2_200_000)?;
    // The last edge ends the pulse of the last step, half a step before the end.
    holds(ramp.edges().last()?.ticks < ramp.end_ticks())
}

/// From rest to rest along a cubic: merged in time, and over a wire.
pub fn cubic() -> Option<()> {
    let tick_rate = Rate::from_hz(black_box(72_000_000)).ok()?;
    let least = StepDirTiming::DRV8825.min_intervals(tick_rate);
    let scale = StepScale::new(black_box(80.0)).ok()?;
    let mut table = PvtQuantiser::new(tick_rate, [scale; 2], [0.0; 2]).ok()?;
    let start = table.knots();
    let row = table.row(0.5, black_box([5.0, -1.0]), [0.0; 2]).ok()?;
    let mut merged = PvtSteps::new(start, least);
    merged.push(&row).ok()?;
    holds(merged.by_ref().count() == 480 && merged.steps() == [400, -80])?;
    let ([start, _], [end, _]) = (start, row.knots);
    let mut axis = JoinedSegments::new(start, least);
    axis.push(row.ticks, end).ok()?;
    axis.finish();
    let mut buffer = [0; Segment::MAX_ENCODED_LEN];
    let mut played = 0;
    for segment in axis {
        let (segment, rest) = Segment::decode(segment.encode(&mut buffer)).ok()?;
        holds(rest.is_empty())?;
        played += 1 + segment.intervals().count();
    }
    holds(played == 400)
}

/// A frame for two motors through accumulators, phases and latches.
pub fn dance() -> Option<()> {
    let tick = Rate::from_hz(1000).ok()?;
    let mut motors = Accumulation::new(SpeedLaw::CarrySigned, black_box(600), tick)
        .ok()?
        .motors();
    motors.set_speeds(black_box([119, -60]));
    let windings = Phases::new(Stepping::Half, Wiring::UNIPOLAR).ok()?;
    let mut phases = [windings.start(); 2];
    let mut latches = Latches::new();
    let mut position = Position::home();
    for _ in 0..200 {
        let steps = motors.tick();
        position.apply(steps).ok()?;
        for (phase, step) in phases.iter_mut().zip(steps) {
            *phase = windings.advance(*phase, step);
        }
        for write in LatchWrites::new(phases.map(|phase| Some(windings.byte(phase)))) {
            latches.write(write).ok()?;
        }
    }
    // 119 · 200 / 600 = 39.67; 39 half steps are 7 past a turn, 20 back are 4.
    holds(position.homing() == [-39, 20] && latches.outputs() == [9, 4])
}

/// A line, and an arc that ends where it should, at constant speed.
pub fn interpolation() -> Option<()> {
    let line = Line::new(black_box([30, -7])).ok()?;
    holds(line.steps(Rule::Nearest).remaining() == 37)?;
    let arc = Arc::new(black_box([500, 0]), [-300, 400], Turn::CounterClockwise).ok()?;
    let (mut steps, mut intervals) = (arc.steps(Rule::Nearest), StepIntervals::new(1000));
    let (mut at, mut ticks) = ([500, 0], 0);
    loop {
        let factor = steps.factor();
        let Some(step) = steps.next() else { break };
        at = [at[0] + step.dx(), at[1] + step.dy()];
        ticks += intervals.next(factor)?;
    }
    // 500 steps of radius by 2.2143 rad.
    holds(at == [-300, 400] && ticks.abs_diff(1_107_149) < 5000)?;
    holds(arc.moves().remaining() < arc.steps(Rule::Published).remaining())
}

/// An axis that has lost two steps.
pub fn closed_loop() -> Option<()> {
    let mut axis = AxisLoop::new(LoopSettings {
        ratio: ScaleRatio::new(black_box(5), 1).ok()?,
        dead_band_counts: 3,
        alarm_counts: 100,
    })
    .ok()?;
    holds(axis.correction(black_box(-10)) == Ok(2))?;
    holds(axis.correction(black_box(-101)).is_err())
}
