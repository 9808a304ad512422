//! Trains, accumulators, lines and arcs.

use core::hint::black_box;

use cortex_m_firmware::meter::Meter;
use motor_phases::{Accumulation, Phases, SpeedLaw, Stepping, Wiring};
use pulse_interp::{Arc, Dda, Line, Rule, StepIntervals, Turn};
use stepper_sync::{Position, Rate, Timer, Trains};

use crate::next;

pub fn count(meter: &Meter) {
    trains(meter);
    motors(meter);
    lines(meter);
    arcs(meter);
}

fn trains(meter: &Meter) {
    let trains = Trains::new(black_box([300, -70]), 4096).expect("not too many");
    let [_, mut slow] = trains.axes();
    meter.count("AxisTrain::next", "ticks", 100, || {
        black_box(next(black_box(&mut slow)));
    });
    let mut edges = trains.edges();
    meter.count("Edges of 2 trains: next", "ticks", 300, || {
        black_box(next(black_box(&mut edges)));
    });
    let four = Trains::new(black_box([300, 299, -200, 70]), 4096).expect("not too many");
    let mut edges = four.edges();
    meter.count("Edges of 4 trains: next", "ticks", 300, || {
        black_box(next(black_box(&mut edges)));
    });
    let timer = Timer::mcs51_mode1(11_059_200).expect("not zero");
    let [_, slow] = trains.axes();
    let mut reloads = timer.reloads(slow);
    meter.count("Reloads of a train: next", "ticks", 100, || {
        black_box(next(black_box(&mut reloads)));
    });
    let mut position = Position::<3>::home();
    meter.count("Position::apply, 3 axes", "ticks", 4, || {
        let _ = black_box(black_box(&mut position).apply(black_box([1, -2, 3])));
    });
}

fn motors(meter: &Meter) {
    let clock = Rate::from_hz(1000).expect("not zero");
    let law = SpeedLaw::CarrySigned;
    let mut motors = Accumulation::new(law, 600, clock)
        .expect("not zero")
        .motors::<8>();
    motors.set_speeds(black_box([60, -60, 119, -119, 7, -7, 127, -128]));
    meter.count("Accumulators::tick, 8 motors", "steps", 100, || {
        black_box(black_box(&mut motors).tick());
    });
    let windings = black_box(Phases::new(Stepping::Half, Wiring::UNIPOLAR).expect("known"));
    let mut phase = windings.start();
    meter.count("Phases::advance and byte", "steps", 20, || {
        phase = windings.advance(black_box(phase), black_box(1));
        black_box(windings.byte(phase));
    });
}

fn lines(meter: &Meter) {
    let line = Line::new(black_box([618, -382])).expect("not too long");
    let mut steps = line.steps(Rule::Nearest);
    meter.count("LineSteps::next", "steps", 400, || {
        black_box(next(black_box(&mut steps)));
    });
    let mut moves = line.moves();
    meter.count("LineMoves::next", "steps", 400, || {
        black_box(next(black_box(&mut moves)));
    });
    let mut dda = Dda::new(black_box([618, -382, 100]))
        .expect("not too long")
        .ticks();
    meter.count("DdaTicks::next, 3 axes", "steps", 400, || {
        black_box(next(black_box(&mut dda)));
    });
}

fn arcs(meter: &Meter) {
    let arc = Arc::new(black_box([500, 0]), [500, 0], Turn::CounterClockwise).expect("a circle");
    let mut steps = arc.steps(Rule::Nearest);
    meter.count("ArcSteps::next", "steps", 2000, || {
        black_box(next(black_box(&mut steps)));
    });
    let mut moves = arc.moves();
    meter.count("ArcMoves::next", "steps", 2000, || {
        black_box(next(black_box(&mut moves)));
    });
    let (mut steps, mut intervals) = (arc.steps(Rule::Nearest), StepIntervals::new(1000));
    meter.count(
        "ArcSteps::factor, StepIntervals::next",
        "steps",
        200,
        || {
            let factor = black_box(&steps).factor();
            black_box(black_box(&mut intervals).next(factor));
            steps.next();
        },
    );
}
