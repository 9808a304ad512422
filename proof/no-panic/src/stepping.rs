//! stepper-sync.

use std::hint::black_box;

use no_panic::no_panic;
use stepper_sync::{
    AxisRamp, AxisTrain, Direction, Edge, Edges, Periods, Position, PositionError, Ramp,
    RampLimits, Rate, Reload, Reloads, Timer, TimerError, Trains,
};

#[no_panic]
#[inline(never)]
fn train_next(train: &mut AxisTrain) -> Option<u64> {
    train.next()
}

#[no_panic]
#[inline(never)]
fn ramp_next(ramp: &mut AxisRamp) -> Option<u64> {
    ramp.next()
}

#[no_panic]
#[inline(never)]
fn train_edges_next(edges: &mut Edges<AxisTrain, 2>) -> Option<Edge> {
    edges.next()
}

#[no_panic]
#[inline(never)]
fn ramp_edges_next(edges: &mut Edges<AxisRamp, 2>) -> Option<Edge> {
    edges.next()
}

#[no_panic]
#[inline(never)]
fn periods_next(periods: &mut Periods) -> Option<u64> {
    periods.next()
}

#[no_panic]
#[inline(never)]
fn reloads_next(reloads: &mut Reloads<AxisTrain>) -> Option<Result<Reload, TimerError>> {
    reloads.next()
}

#[no_panic]
#[inline(never)]
fn reload(timer: &Timer, ticks: u64) -> Result<u32, TimerError> {
    timer.reload(ticks)
}

#[no_panic]
#[inline(never)]
fn compensated_reload(
    timer: &Timer,
    count: u32,
    ticks: u64,
    stopped_ticks: u32,
) -> Result<u32, TimerError> {
    timer.compensated_reload(count, ticks, stopped_ticks)
}

#[no_panic]
#[inline(never)]
fn apply(position: &mut Position<3>, steps: [i32; 3]) -> Result<(), PositionError> {
    position.apply(steps)
}

#[no_panic]
#[inline(never)]
fn step(
    position: &mut Position<3>,
    axis: usize,
    direction: Direction,
) -> Result<(), PositionError> {
    position.step(axis, direction)
}

pub fn run() {
    if let Ok(trains) = Trains::new(black_box([30, -7]), black_box(4096)) {
        let [mut train, _] = black_box(trains.axes());
        black_box(train_next(&mut train));
        black_box(train_edges_next(&mut black_box(trains.edges())));
        if let Ok(timer) = Timer::mcs51_mode1(black_box(11_059_200)) {
            let timer = black_box(timer);
            let _ = black_box(reload(&timer, black_box(4096)));
            let _ = black_box(compensated_reload(
                &timer,
                black_box(8),
                black_box(4096),
                black_box(9),
            ));
            if let Ok(periods) = timer.periods(black_box(70_000)) {
                black_box(periods_next(&mut black_box(periods)));
            }
            black_box(reloads_next(&mut black_box(timer.reloads(train))))
                .transpose()
                .ok();
        }
    }
    let limits = RampLimits {
        start_millihertz: black_box(100_000),
        max_millihertz: black_box(600_000),
        accel_steps_per_s2: black_box(1500),
    };
    let rate = Rate::from_hz(black_box(921_600));
    if let Some(ramp) = rate
        .ok()
        .and_then(|rate| Ramp::new([2000, -450], &limits, rate).ok())
    {
        let [mut axis, _] = black_box(ramp.axes());
        black_box(ramp_next(&mut axis));
        black_box(ramp_edges_next(&mut black_box(ramp.edges())));
    }
    let mut position = black_box(Position::home());
    let _ = black_box(apply(&mut position, black_box([1, 2, -3])));
    let _ = black_box(step(
        &mut position,
        black_box(1),
        black_box(Direction::Negative),
    ));
}
