//! Curves of a tool, and the paths of an arm's joints and a Delta's arms along them.

use core::convert::Infallible;
use std::array::IntoIter;
use std::hint::black_box;
use std::iter::Flatten;

use delta_kin::{Delta, DeltaPath, DeltaPathError, Dimensions};
use no_panic::no_panic;
use path_timing::{
    Accuracy, AxisLimits, Curve, CurveError, CurvePoint, Knot, LookAhead, Path, PathPoint,
    PlanError, Row, Smoothed, Span, Table, Vertex, segments_within,
};
use scara_kin::{Arm, ArmPath, ArmPathError, DiscPath, Elbow};

#[no_panic]
#[inline(never)]
fn line(from: [f64; 3], to: [f64; 3]) -> Result<Curve<3>, CurveError> {
    Curve::line(from, to)
}

#[no_panic]
#[inline(never)]
fn arc(points: [[f64; 2]; 3], angle: f64) -> Result<Curve<2>, CurveError> {
    let [start, centre, direction] = points;
    Curve::arc(start, centre, direction, angle)
}

#[no_panic]
#[inline(never)]
fn bezier(control_points: [[f64; 2]; 4]) -> Result<Curve<2>, CurveError> {
    Curve::bezier(control_points)
}

#[no_panic]
#[inline(never)]
fn curve_at(curve: &Curve<2>, s: f64) -> CurvePoint<2> {
    curve.at(s)
}

#[no_panic]
#[inline(never)]
fn curve_departure(curve: &Curve<2>, span: &Span<[f64; 2]>) -> f64 {
    curve.departure(span)
}

type Corners = IntoIter<[f64; 2], 4>;

#[no_panic]
#[inline(never)]
fn smoothed_next(smoothed: &mut Smoothed<'_, Corners, 2>) -> Option<Result<Curve<2>, CurveError>> {
    smoothed.next()
}

type Stream<'m> = Flatten<Smoothed<'m, Corners, 2>>;

#[no_panic]
#[inline(never)]
fn stream_next(
    motion: &mut LookAhead<'_, Curve<2>, Stream<'_>, impl FnMut(&Curve<2>) -> Segments>,
) -> Result<Option<Row<[f64; 2]>>, PlanError<Infallible>> {
    motion.next_row()
}

#[no_panic]
#[inline(never)]
fn plan_within(
    curve: Curve<2>,
    limits: [AxisLimits; 2],
    knots: &mut [Knot<[f64; 2]>],
) -> Result<Table<'_, [f64; 2]>, PlanError<Infallible>> {
    let accuracy = Accuracy {
        min_segments: 4,
        max_departure: 0.01,
        max_time_ratio: 1.02,
    };
    Table::plan_within([curve], limits, accuracy, Curve::departure, knots)
}

type Segments = Result<u32, PlanError<Infallible>>;

#[no_panic]
#[inline(never)]
fn segments_of(curve: &Curve<2>) -> Segments {
    segments_within(curve, 4, 0.01, Curve::departure)
}

#[no_panic]
#[inline(never)]
fn arm_path(arm: &Arm, curve: Curve<2>, elbow: Elbow) -> Result<ArmPath, ArmPathError> {
    arm.path(curve, elbow)
}

#[no_panic]
#[inline(never)]
fn arm_point(path: &ArmPath, s: f64) -> Result<PathPoint<[f64; 2]>, ArmPathError> {
    path.point(s)
}

#[no_panic]
#[inline(never)]
fn arm_departure(path: &ArmPath, span: &Span<[f64; 2]>) -> f64 {
    path.departure(span)
}

#[no_panic]
#[inline(never)]
fn arm_check(path: &ArmPath, span: &Span<[f64; 2]>) -> Result<(), ArmPathError> {
    path.check(span)
}

#[no_panic]
#[inline(never)]
fn with_disc(path: ArmPath, tool_angle: f64) -> Result<DiscPath, ArmPathError> {
    path.with_disc(tool_angle)
}

#[no_panic]
#[inline(never)]
fn disc_point(path: &DiscPath, s: f64) -> Result<PathPoint<[f64; 3]>, ArmPathError> {
    path.point(s)
}

#[no_panic]
#[inline(never)]
fn disc_departure(path: &DiscPath, span: &Span<[f64; 3]>) -> f64 {
    path.departure(span)
}

#[no_panic]
#[inline(never)]
fn delta_path(delta: &Delta, curve: Curve<3>) -> Result<DeltaPath, DeltaPathError> {
    delta.path(curve)
}

#[no_panic]
#[inline(never)]
fn pick_and_place(
    delta: &Delta,
    [from, to]: [[f64; 3]; 2],
    z: f64,
) -> Result<[DeltaPath; 7], DeltaPathError> {
    delta.pick_and_place(from, to, z, 5.0, None)
}

#[no_panic]
#[inline(never)]
fn delta_point(path: &DeltaPath, s: f64) -> Result<PathPoint<[f64; 3]>, DeltaPathError> {
    path.point(s)
}

#[no_panic]
#[inline(never)]
fn delta_check(path: &DeltaPath, span: &Span<[f64; 3]>) -> Result<(), DeltaPathError> {
    path.check(span)
}

#[no_panic]
#[inline(never)]
fn delta_departure(path: &DeltaPath, span: &Span<[f64; 3]>) -> f64 {
    path.departure(span)
}

fn span<const N: usize>() -> Span<[f64; N]> {
    let row = Row {
        time_s: 1.0,
        duration_s: 0.1,
        position: [0.5; N],
        velocity: [0.1; N],
        leg: 0,
        s: 2.0,
    };
    black_box(Span {
        s: [1.0, 2.0],
        rows: [row; 2],
    })
}

pub fn run() {
    let limits = black_box(AxisLimits {
        speed: 100.0,
        acceleration: 1000.0,
        jerk: None,
    });
    let _ = black_box(arc(
        black_box([[100.0, 100.0], [90.0, 100.0], [0.0, 1.0]]),
        black_box(2.0),
    ));
    let corners = black_box([[0.0, 0.0], [40.0, 0.0], [40.0, 40.0], [0.0, 40.0]]);
    let mut vertices = black_box([Vertex::default(); 8]);
    if let Ok(mut smoothed) = Smoothed::new(corners, black_box(0.05), &mut vertices) {
        black_box(smoothed_next(black_box(&mut smoothed)).is_some());
        let mut window = black_box([Knot::default(); 16]);
        let curves = black_box(smoothed).flatten();
        if let Ok(mut motion) = LookAhead::new(curves, [limits; 2], segments_of, &mut window) {
            black_box(stream_next(black_box(&mut motion)).is_ok());
        }
    }
    let drawn = black_box([[100.0, 100.0], [80.0, 130.0], [0.0, 120.0], [-90.0, 90.0]]);
    if let Ok(curve) = bezier(drawn) {
        run_curve(&black_box(curve), limits);
    }
    let ends = black_box([[50.0, 50.0, -300.0], [-50.0, 50.0, -300.0]]);
    let Ok(delta) = Delta::new(Dimensions {
        base: black_box(42.0),
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    }) else {
        return;
    };
    let delta = black_box(delta);
    black_box(pick_and_place(&delta, ends, black_box(-280.0)).is_ok());
    if let Ok(line) = line(ends[0], ends[1])
        && let Ok(path) = delta_path(&delta, black_box(line))
    {
        let path = black_box(path);
        black_box(delta_point(&path, black_box(3.0)).is_ok());
        black_box(delta_departure(&path, &span()));
        black_box(delta_check(&path, &span()).is_ok());
    }
}

fn run_curve(curve: &Curve<2>, limits: AxisLimits) {
    black_box(curve_at(curve, black_box(3.0)));
    black_box(curve_departure(curve, &span()));
    black_box(segments_of(curve).is_ok());
    let mut knots = black_box([Knot::default(); 64]);
    black_box(plan_within(*curve, [limits; 2], &mut knots).is_ok());
    let Ok(arm) = Arm::new(black_box(132.0), 132.0) else {
        return;
    };
    let Ok(path) = arm_path(&black_box(arm), *curve, black_box(Elbow::Right)) else {
        return;
    };
    let path = black_box(path);
    black_box(arm_point(&path, black_box(3.0)).is_ok());
    black_box(arm_departure(&path, &span()));
    black_box(arm_check(&path, &span()).is_ok());
    if let Ok(path) = with_disc(path, black_box(0.3)) {
        let path = black_box(path);
        black_box(disc_point(&path, black_box(3.0)).is_ok());
        black_box(disc_departure(&path, &span()));
    }
}
