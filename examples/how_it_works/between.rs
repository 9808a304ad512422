//! What axes do between two rows.

use pose2pulse::path_timing::{Cubic, Row};

/// Places of a cubic that are drawn.
const PLACES: u32 = 24;

/// Times, positions and velocities between the rows of a table, on the cubics that the axes run.
pub(crate) fn between<const N: usize>(
    rows: &[Row<[f64; N]>],
) -> impl Iterator<Item = (f64, [f64; N], [f64; N])> {
    rows.windows(2).flat_map(|pair| {
        let [from, to] = pair else {
            unreachable!("windows of two")
        };
        let (from_s, duration_s) = (from.time_s, to.duration_s);
        let axes: Vec<Cubic> = Cubic::between(from, to).collect();
        (0..PLACES).map(move |place| {
            let part = f64::from(place) / f64::from(PLACES);
            let (mut positions, mut velocities) = ([0.0; N], [0.0; N]);
            let values = positions.iter_mut().zip(&mut velocities);
            for (cubic, (position, velocity)) in axes.iter().zip(values) {
                (*position, *velocity) = (cubic.position(part), velocity_of(cubic, part));
            }
            (from_s + part * duration_s, positions, velocities)
        })
    })
}

/// By the differences of the control points.
fn velocity_of(cubic: &Cubic, part: f64) -> f64 {
    let [a, b, c, d] = cubic.control_points();
    let rest = 1.0 - part;
    let slope = (b - a) * rest * rest + 2.0 * (c - b) * rest * part + (d - c) * part * part;
    3.0 * slope / cubic.duration_s
}
