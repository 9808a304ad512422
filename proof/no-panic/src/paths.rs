//! pulse-interp.

use std::hint::black_box;

use no_panic::no_panic;
use pulse_interp::{
    Arc, ArcMoves, ArcSteps, AxesLine, AxesSteps, AxisLoop, AxisStep, Dda, DdaTicks, Direction,
    Factor, Homing, HomingError, HomingOrder, HomingSettings, Line, LineMoves, LineSteps,
    LoopSettings, LostSteps, Move, Rule, ScaleRatio, StepIntervals, SwitchError, Switches, Turn,
};

#[no_panic]
#[inline(never)]
fn line_step(steps: &mut LineSteps) -> Option<Move> {
    steps.next()
}

#[no_panic]
#[inline(never)]
fn line_move(moves: &mut LineMoves) -> Option<Move> {
    moves.next()
}

#[no_panic]
#[inline(never)]
fn arc_step(steps: &mut ArcSteps) -> Option<Move> {
    steps.next()
}

#[no_panic]
#[inline(never)]
fn arc_move(moves: &mut ArcMoves) -> Option<Move> {
    moves.next()
}

#[no_panic]
#[inline(never)]
fn arc_step_factor(steps: &ArcSteps) -> Factor {
    steps.factor()
}

#[no_panic]
#[inline(never)]
fn arc_move_factor(moves: &ArcMoves) -> Factor {
    moves.factor()
}

#[no_panic]
#[inline(never)]
fn axes_step(steps: &mut AxesSteps<3>) -> Option<AxisStep> {
    steps.next()
}

#[no_panic]
#[inline(never)]
fn dda_tick(ticks: &mut DdaTicks<3>) -> Option<[i8; 3]> {
    ticks.next()
}

#[no_panic]
#[inline(never)]
fn next_interval(intervals: &mut StepIntervals, factor: Factor) -> Option<u64> {
    intervals.next(factor)
}

#[no_panic]
#[inline(never)]
fn command(axis: &mut AxisLoop, direction: Direction) {
    axis.command(direction);
}

#[no_panic]
#[inline(never)]
fn correction(axis: &mut AxisLoop, counts: i32) -> Result<i32, LostSteps> {
    axis.correction(counts)
}

#[no_panic]
#[inline(never)]
fn permit(switches: Switches, direction: Direction, steps: i32) -> Result<(), SwitchError> {
    switches.permit(direction, steps)
}

#[no_panic]
#[inline(never)]
fn homing_next(homing: &mut Homing, closed: bool) -> Result<HomingOrder, HomingError> {
    homing.next(closed)
}

pub fn run() {
    let mut intervals = black_box(StepIntervals::new(black_box(1000)));
    if let Ok(line) = Line::new(black_box([30, -7])) {
        black_box(line_step(&mut black_box(line.steps(Rule::Nearest))));
        black_box(line_move(&mut black_box(line.moves())));
        black_box(next_interval(&mut intervals, black_box(line.step_factor())));
    }
    let arc = Arc::near(
        black_box([30, -7]),
        black_box([5, 31]),
        Turn::Clockwise,
        900,
    );
    if let Ok(arc) = arc {
        let mut steps = black_box(arc.steps(Rule::Published));
        black_box(arc_step(&mut steps));
        black_box(arc_step_factor(&steps));
        let mut moves = black_box(arc.moves());
        black_box(arc_move(&mut moves));
        black_box(arc_move_factor(&moves));
    }
    if let Ok(line) = AxesLine::new(black_box([30, -7, 2])) {
        black_box(axes_step(&mut black_box(line.steps())));
    }
    if let Ok(dda) = Dda::new(black_box([30, -7, 2])) {
        black_box(dda_tick(&mut black_box(dda.ticks())));
    }
    let axis = ScaleRatio::new(black_box(5), black_box(1)).and_then(|ratio| {
        AxisLoop::new(LoopSettings {
            ratio,
            dead_band_counts: black_box(3),
            alarm_counts: black_box(100),
        })
    });
    if let Ok(axis) = axis {
        let mut axis = black_box(axis);
        command(&mut axis, black_box(Direction::Negative));
        let _ = black_box(correction(&mut axis, black_box(7)));
    }
    let switches = black_box(Switches::default());
    let _ = black_box(permit(
        switches,
        black_box(Direction::Positive),
        black_box(8),
    ));
    let mut homing = black_box(Homing::new(HomingSettings {
        direction: Direction::Negative,
        max_steps: black_box(100),
        clear_steps: black_box(5),
    }));
    let _ = black_box(homing_next(&mut homing, black_box(true)));
}
