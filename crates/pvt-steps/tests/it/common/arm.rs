//! A line of a two-link arm as rows: 244 mm at 300 mm/s and 3000 mm/s², from rest to rest.

use pvt_steps::{PvtKnot, PvtQuantiser, PvtRow, Rate, StepScale};

/// Both links of the arm, in mm.
const LINK_MM: f64 = 132.0;
/// Start of the line, and from there to its end, in mm.
const START: [f64; 2] = [60.0, 150.0];
const CHANGE: [f64; 2] = [140.0, -200.0];
/// Of the tool, in mm/s.
const SPEED: f64 = 300.0;
/// From rest to the speed.
pub(crate) const RAMP_S: f64 = 0.1;
/// The whole line: its length of sqrt(140² + 200²) mm at the speed, and one ramp.
pub(crate) const END_S: f64 = 244.131_112_314_674_06 / SPEED + RAMP_S;

/// Angles of shoulder and elbow, in radians.
fn inverse([x, y]: [f64; 2]) -> [f64; 2] {
    let half = (x.hypot(y) / (2.0 * LINK_MM)).acos();
    [y.atan2(x) - half, 2.0 * half]
}

/// Their speeds.
fn inverse_speeds([shoulder, elbow]: [f64; 2], [vx, vy]: [f64; 2]) -> [f64; 2] {
    let (upper, lower) = (shoulder, shoulder + elbow);
    let determinant = LINK_MM * elbow.sin();
    let first = (vx * lower.cos() + vy * lower.sin()) / determinant;
    let second = -(vx * upper.cos() + vy * upper.sin()) / determinant;
    [first, second - first]
}

/// Fraction of the line, and its change a second.
fn at(time_s: f64) -> [f64; 2] {
    let up = time_s.min(RAMP_S);
    let down = (time_s - END_S + RAMP_S).max(0.0);
    let distance =
        SPEED * (up * up / (2.0 * RAMP_S) + (time_s - up) - down * down / (2.0 * RAMP_S));
    let length = SPEED * (END_S - RAMP_S);
    [distance / length, SPEED * (up - down) / RAMP_S / length]
}

/// The knot at the start, and rows that end at `times_s`.
pub(crate) fn line(
    tick_hz: u32,
    steps_per_turn: f64,
    times_s: &[f64],
) -> ([PvtKnot; 2], Vec<PvtRow<2>>) {
    let rate = Rate::from_hz(tick_hz).unwrap();
    let scale = StepScale::new(steps_per_turn / core::f64::consts::TAU).unwrap();
    let mut table = PvtQuantiser::new(rate, [scale; 2], inverse(START)).unwrap();
    let start = table.knots();
    let [x, y] = START;
    let [dx, dy] = CHANGE;
    let rows = times_s.iter().map(|&time_s| {
        let [fraction, speed] = at(time_s);
        let joints = inverse([x + dx * fraction, y + dy * fraction]);
        let speeds = inverse_speeds(joints, [dx * speed, dy * speed]);
        table.row(time_s, joints, speeds).unwrap()
    });
    (start, rows.collect())
}
