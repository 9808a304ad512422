//! stepper-sync, pvt-steps, motor-phases.

use std::hint::black_box;

use motor_phases::{
    Accumulation, Accumulators, BusError, BusWrite, LatchWrites, Latches, Phase, Phases, SpeedLaw,
    Stepping, Wiring,
};
use no_panic::no_panic;
use pvt_steps::{
    AxisRamp, AxisSegments, PvtKnot, PvtRow, PvtSteps, Ramp, RampLimits, RowError, Segment,
    SegmentError, SegmentPlayer, Step,
};
use stepper_sync::{
    AxisTrain, Direction, Edge, Edges, MinIntervals, Periods, Position, PositionError, Rate,
    Reload, Reloads, Timer, TimerError, Trains,
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
fn row_push(axis: &mut AxisSegments, ticks: u32, knot: PvtKnot) -> Result<(), RowError> {
    axis.push(ticks, knot)
}

#[no_panic]
#[inline(never)]
fn segments_next(axis: &mut AxisSegments) -> Option<Segment> {
    axis.next()
}

#[no_panic]
#[inline(never)]
fn rows_push(steps: &mut PvtSteps<3>, row: &PvtRow<3>) -> Result<(), RowError> {
    steps.push(row)
}

#[no_panic]
#[inline(never)]
fn steps_next(steps: &mut PvtSteps<3>) -> Option<Step> {
    steps.next()
}

#[no_panic]
#[inline(never)]
fn segment_encode<'b>(
    segment: &Segment,
    buffer: &'b mut [u8; Segment::MAX_ENCODED_LEN],
) -> &'b [u8] {
    segment.encode(buffer)
}

#[no_panic]
#[inline(never)]
fn segment_decode(bytes: &[u8]) -> Result<(Segment, &[u8]), SegmentError> {
    Segment::decode(bytes)
}

#[no_panic]
#[inline(never)]
fn player_load(player: &mut SegmentPlayer, segment: &Segment) -> u64 {
    player.load(segment)
}

#[no_panic]
#[inline(never)]
fn player_next(player: &mut SegmentPlayer) -> Option<u32> {
    player.next()
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

#[no_panic]
#[inline(never)]
fn set_speeds(motors: &mut Accumulators<8>, speeds: [i8; 8]) {
    motors.set_speeds(speeds);
}

#[no_panic]
#[inline(never)]
fn tick(motors: &mut Accumulators<8>) -> [i32; 8] {
    motors.tick()
}

#[no_panic]
#[inline(never)]
fn advance(phases: &Phases, phase: Phase, steps: i32) -> Phase {
    phases.advance(phase, steps)
}

#[no_panic]
#[inline(never)]
fn phase_byte(phases: &Phases, phase: Phase) -> u8 {
    phases.byte(phase)
}

#[no_panic]
#[inline(never)]
fn latch_writes_next(writes: &mut LatchWrites<8>) -> Option<BusWrite> {
    writes.next()
}

#[no_panic]
#[inline(never)]
fn latches_write(latches: &mut Latches<8>, write: BusWrite) -> Result<(), BusError> {
    latches.write(write)
}

pub fn run() {
    motion();
    cubics();
    dance();
}

fn cubics() {
    let least = black_box(MinIntervals {
        step_ticks: 100,
        reversal_ticks: 200,
    });
    let (start, end) = (
        black_box(PvtKnot::at_rest(0)),
        black_box(PvtKnot::at_rest(-3)),
    );
    let mut axis = black_box(AxisSegments::new(start, least));
    let _ = black_box(row_push(&mut axis, black_box(10_000), end));
    if let Some(segment) = segments_next(&mut axis) {
        let mut buffer = [0; Segment::MAX_ENCODED_LEN];
        let bytes = black_box(segment_encode(black_box(&segment), &mut buffer));
        if let Ok((segment, _)) = segment_decode(bytes) {
            let mut player = black_box(SegmentPlayer::new());
            black_box(player_load(&mut player, black_box(&segment)));
            black_box(player_next(&mut player));
        }
    }
    let mut steps = black_box(PvtSteps::new([start; 3], least));
    let row = black_box(PvtRow {
        ticks: 10_000,
        knots: [end; 3],
    });
    let _ = black_box(rows_push(&mut steps, &row));
    black_box(steps_next(&mut steps));
}

fn dance() {
    let rate = Rate::from_hz(black_box(1000));
    let law = black_box(SpeedLaw::CarrySigned);
    if let Some(accumulation) = rate
        .ok()
        .and_then(|rate| Accumulation::new(law, black_box(600), rate).ok())
    {
        let mut motors = black_box(accumulation.motors());
        set_speeds(&mut motors, black_box([60, -60, 0, 127, -128, 1, 2, 3]));
        black_box(tick(black_box(&mut motors)));
    }
    if let Ok(phases) = Phases::new(black_box(Stepping::Half), black_box(Wiring::UNIPOLAR)) {
        let phases = black_box(phases);
        let phase = advance(&phases, black_box(phases.start()), black_box(-3));
        black_box(phase_byte(&phases, black_box(phase)));
    }
    let mut writes = black_box(LatchWrites::new(black_box([Some(9); 8])));
    if let Some(write) = latch_writes_next(&mut writes) {
        let mut latches = black_box(Latches::new());
        let _ = black_box(latches_write(&mut latches, black_box(write)));
    }
}

fn motion() {
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
