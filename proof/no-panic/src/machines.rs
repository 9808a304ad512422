//! Machines by their inverse alone: paths, checks, departures.

use std::hint::black_box;

use machine_kin::{Elbow, FiveBar, Machine, MachinePath, PathError};
use no_panic::no_panic;
use path_timing::{Curve, Path, PathPoint, Row, Span};

type Made = MachinePath<FiveBar, 2>;

const OUTWARDS: [Elbow; 2] = [Elbow::Left, Elbow::Right];

#[no_panic]
#[inline(never)]
fn path(machine: &FiveBar, curve: Curve<2>) -> Result<Made, PathError<2>> {
    machine.path(curve, OUTWARDS)
}

#[no_panic]
#[inline(never)]
fn point(path: &Made, s: f64) -> Result<PathPoint<[f64; 2]>, PathError<2>> {
    path.point(s)
}

#[no_panic]
#[inline(never)]
fn check(path: &Made, span: &Span<[f64; 2]>) -> Result<(), PathError<2>> {
    path.check(span)
}

#[no_panic]
#[inline(never)]
fn departure(path: &Made, span: &Span<[f64; 2]>) -> f64 {
    path.departure(span)
}

#[no_panic]
#[inline(never)]
fn clearance(machine: &FiveBar, tool: [f64; 2]) -> f64 {
    machine.clearance(tool, OUTWARDS)
}

pub fn run() {
    let Ok(machine) = FiveBar::new(black_box(80.0), 100.0, 160.0) else {
        return;
    };
    let machine = black_box(machine);
    black_box(clearance(&machine, black_box([0.0, 180.0])));
    let Ok(line) = Curve::line(black_box([-60.0, 150.0]), [60.0, 180.0]) else {
        return;
    };
    let Ok(path) = path(&machine, black_box(line)) else {
        return;
    };
    let path = black_box(path);
    black_box(point(&path, black_box(3.0)).is_ok());
    let row = Row {
        time_s: 1.0,
        duration_s: 0.1,
        position: [0.5; 2],
        velocity: [0.1; 2],
        leg: 0,
        s: 2.0,
    };
    let span = black_box(Span {
        s: [1.0, 2.0],
        rows: [row; 2],
    });
    black_box(check(&path, &span).is_ok());
    black_box(departure(&path, &span));
}
