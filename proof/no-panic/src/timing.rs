//! Tables along a path and their playback.

use core::convert::Infallible;
use std::hint::black_box;
use std::iter::{Repeat, repeat};

use no_panic::no_panic;
use path_timing::{
    AxisLimits, FeedCeiling, Knot, LookAhead, Path, PathPoint, PlanError, Playback, Row, Rows,
    Table,
};

/// A parabola, one axis by the square of the other.
#[derive(Debug, Clone, Copy)]
struct Parabola;

impl Path for Parabola {
    type Axes = [f64; 2];
    type Error = Infallible;

    fn length(&self) -> f64 {
        black_box(10.0)
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 2]>, Infallible> {
        Ok(PathPoint {
            position: [s, s * s],
            slope: [1.0, 2.0 * s],
        })
    }
}

#[no_panic]
#[inline(never)]
fn plan(
    limits: [AxisLimits; 2],
    segments: u32,
    knots: &mut [Knot<[f64; 2]>],
) -> Result<Table<'_, [f64; 2]>, PlanError<Infallible>> {
    Table::plan([Parabola], limits, |_| segments, knots)
}

#[no_panic]
#[inline(never)]
fn next_row(rows: &mut Rows<'_, [f64; 2]>) -> Option<Row<[f64; 2]>> {
    rows.next()
}

#[no_panic]
#[inline(never)]
fn playback<'a>(
    table: &Table<'a, [f64; 2]>,
    max: f64,
    ceilings: &'a mut [FeedCeiling],
) -> Result<Playback<'a, [f64; 2]>, PlanError<Infallible>> {
    table.playback(max, ceilings)
}

#[no_panic]
#[inline(never)]
fn playback_next(playback: &mut Playback<'_, [f64; 2]>) -> Option<Row<[f64; 2]>> {
    playback.next_row()
}

type Stream = Repeat<Parabola>;

#[no_panic]
#[inline(never)]
fn look_ahead<F: FnMut(&Parabola) -> Result<u32, PlanError<Infallible>>>(
    limits: [AxisLimits; 2],
    segments: F,
    window: &mut [Knot<[f64; 2]>],
) -> Result<LookAhead<'_, Parabola, Stream, F>, PlanError<Infallible>> {
    LookAhead::new(repeat(Parabola), limits, segments, window)
}

#[no_panic]
#[inline(never)]
fn look_ahead_next(
    motion: &mut LookAhead<
        '_,
        Parabola,
        Stream,
        impl FnMut(&Parabola) -> Result<u32, PlanError<Infallible>>,
    >,
) -> Result<Option<Row<[f64; 2]>>, PlanError<Infallible>> {
    motion.next_row()
}

pub fn run() {
    let limits = AxisLimits {
        speed: 1.0,
        acceleration: 2.0,
        jerk: Some(3.0),
    };
    let mut knots = black_box([Knot::default(); 64]);
    let Ok(table) = plan(black_box([limits; 2]), black_box(60), black_box(&mut knots)) else {
        return;
    };
    black_box(next_row(&mut black_box(&table).rows()).is_some());
    let mut ceilings = black_box([FeedCeiling::default(); 64]);
    if let Ok(mut playback) = playback(&table, black_box(1.5), black_box(&mut ceilings)) {
        black_box(playback_next(&mut playback).is_some());
    }
    let limits = AxisLimits {
        jerk: None,
        ..limits
    };
    let mut window = black_box([Knot::default(); 16]);
    if let Ok(mut motion) = look_ahead(
        black_box([limits; 2]),
        |_| Ok(black_box(7)),
        black_box(&mut window),
    ) {
        black_box(look_ahead_next(&mut motion).is_ok());
    }
}
