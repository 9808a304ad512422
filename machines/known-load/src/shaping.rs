//! Rows shaped for a mode, and what that takes them off by.

use anyhow::Result;
use path_timing::{Cubic, Row, Shaped, Shaper};

use crate::torque::spans;

/// Shaped rows.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ShapedRows<const N: usize> {
    /// The rows.
    pub rows: Vec<Row<[f64; N]>>,
    /// Seconds after which shaping has let all of a motion pass.
    pub delay_s: f64,
}

/// Shapes each axis of a motion from rest to rest.
///
/// # Errors
/// Those of [`Shaped`].
pub fn shape<const N: usize>(
    rows: &[Row<[f64; N]>],
    shapers: [Shaper; N],
) -> Result<ShapedRows<N>> {
    let rows = rows.iter().copied();
    let mut memory = vec![Row::default(); Shaped::memory_for(rows.clone(), &shapers)];
    let mut shaped = Shaped::new(rows, shapers, &mut memory);
    let rows: Result<Vec<_>, _> = shaped.by_ref().collect();
    Ok(ShapedRows {
        rows: rows?,
        delay_s: shaped.longest_delay_s(),
    })
}

/// The most by which each axis of shaped rows is off the rows, later by the shaper's delay: what
/// its accelerations make of it, and what the jumps of its speed within a shaper's time do.
#[must_use]
pub fn off<const N: usize>(rows: &[Row<[f64; N]>], shapers: &[Shaper; N]) -> [f64; N] {
    let mut off = [0.0_f64; N];
    for span in spans(rows) {
        let [from, to] = &span.rows;
        let axes = off.iter_mut().zip(shapers);
        for ((off, shaper), cubic) in axes.zip(Cubic::between(from, to)) {
            let [a0, a1] = cubic.accelerations();
            *off = off.max(shaper.departure(a0.abs().max(a1.abs())));
        }
    }
    for (axis, (off, shaper)) in off.iter_mut().zip(shapers).enumerate() {
        *off += shaper.departure_of_jumps(jumps(rows, axis, shaper.duration_s()));
    }
    off
}

/// The largest sum of the jumps of an axis' speed within a time.
fn jumps<const N: usize>(rows: &[Row<[f64; N]>], axis: usize, within_s: f64) -> f64 {
    let speed = |row: &Row<[f64; N]>| row.velocity.get(axis).copied().unwrap_or_default();
    let jumps = rows.windows(2).filter_map(|pair| match pair {
        [from, to] if to.duration_s <= 0.0 => Some((to.time_s, (speed(to) - speed(from)).abs())),
        _ => None,
    });
    let jumps: Vec<_> = jumps.filter(|(_, jump)| *jump > 0.0).collect();
    let sums = jumps.iter().enumerate().map(|(first, (first_s, _))| {
        let later = jumps.iter().skip(first);
        let near = later.take_while(|(time_s, _)| *time_s <= first_s + within_s);
        near.map(|(_, jump)| jump).sum()
    });
    sums.fold(0.0, f64::max)
}
