//! What of their torque the motors are asked for along rows.

use anyhow::{Result, bail};
use path_timing::{Dynamics, Row, Span};

use crate::load::Load;

/// A sum of delayed motions may ask for more torque than each of them: rounds of planning with
/// less, and how much less than what is missing.
const ROUNDS: u32 = 8;
const LESS: f64 = 0.999;

/// Plans until a shaped motion asks the motors for no more than it may: `plan` gets the share of
/// that which it may use, and gives its plan with the part that this asks for.
///
/// # Errors
/// Those of `plan`, or no share is small enough.
pub fn within_share<R>(mut plan: impl FnMut(f64) -> Result<(R, f64)>) -> Result<R> {
    let mut share = 1.0;
    for _ in 0..ROUNDS {
        let (planned, most) = plan(share)?;
        if most <= 1.0 {
            return Ok(planned);
        }
        share *= LESS / most;
    }
    bail!("[mode] shaper: no motion that is shaped keeps what the motors are asked for");
}

/// The parts of the motors' pull-out torque that a motion asks for.
#[derive(Debug, Clone)]
pub struct TorqueUsed<const N: usize> {
    /// What is planned of the motors.
    pub(crate) planned: f64,
    pub(crate) most: Most<N>,
    /// Of each axis at the ends of each segment, with the time in s; no numbers between motions.
    parts: Vec<(f64, [f64; N])>,
}

/// Where a motor is asked for the most.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Most<const N: usize> {
    /// The largest part of its pull-out torque that is asked of any motor: a proven bound.
    pub(crate) part: f64,
    /// From 0.
    pub(crate) axis: usize,
    pub(crate) t_s: f64,
    position: [f64; N],
}

impl<const N: usize> TorqueUsed<N> {
    /// Of no motion.
    #[must_use]
    pub const fn none(reserve: f64) -> Self {
        Self {
            planned: 1.0 - reserve,
            most: Most {
                part: 0.0,
                axis: 0,
                t_s: 0.0,
                position: [0.0; N],
            },
            parts: Vec::new(),
        }
    }

    /// Of the cubics between rows, too, which begin at a time in s.
    pub fn add<D: Dynamics<Axes = [f64; N]>>(
        &mut self,
        load: &Load<D, N>,
        rows: &[Row<[f64; N]>],
        start_s: f64,
    ) {
        if let Some((last_s, _)) = self.parts.last() {
            self.parts.push((*last_s, [f64::NAN; N]));
        }
        let planned = self.planned;
        for span in spans(rows).filter(|span| span.rows[1].duration_s >= SHORT_S) {
            let ends = parts(load, &span).map(|parts| parts.map(|part| part * planned));
            let times = span.rows.iter().map(|row| start_s + row.time_s);
            self.parts.extend(times.zip(ends));
            let part = load.limits.utilisation(&span) * planned;
            if part > self.most.part {
                let all = ends.iter().flat_map(|parts| parts.iter().zip(0..));
                let axis = all.max_by(|(a, _), (b, _)| a.total_cmp(b));
                let [row, _] = span.rows;
                self.most = Most {
                    part,
                    axis: axis.map_or(0, |(_, axis)| axis),
                    t_s: start_s + row.time_s,
                    position: row.position,
                };
            }
        }
    }

    /// The most, over what is planned of the motors.
    #[must_use]
    pub fn most_of_planned(&self) -> f64 {
        self.most.part / self.planned
    }

    /// The part of the motors' pull-out torque that is planned.
    #[must_use]
    pub const fn planned(&self) -> f64 {
        self.planned
    }

    /// Of the motor of each axis the part of its pull-out torque that is asked for, at times in s;
    /// no numbers between motions.
    pub fn over_time(&self) -> impl Iterator<Item = (f64, [f64; N])> {
        self.parts.iter().copied()
    }

    /// The positions of the axes where a motor is asked for the most.
    #[must_use]
    pub const fn position_at_most(&self) -> [f64; N] {
        self.most.position
    }
}

/// The segments between rows.
pub fn spans<const N: usize>(rows: &[Row<[f64; N]>]) -> impl Iterator<Item = Span<[f64; N]>> {
    rows.windows(2).filter_map(|pair| match pair {
        [from, to] if to.duration_s > 0.0 => {
            let start = if from.leg == to.leg { from.s } else { 0.0 };
            Some(Span {
                s: [start, to.s],
                rows: [*from, *to],
            })
        }
        _ => None,
    })
}

/// The accelerations of shorter segments are those of rounding, and of rows nearer than a
/// nanosecond that a [`Shaped`](path_timing::Shaped) joins; what is asked of the motors shows in
/// the segments on both sides.
const SHORT_S: f64 = 1e-7;

/// The parts of what is planned of each motor, at both ends of a segment.
fn parts<D: Dynamics<Axes = [f64; N]>, const N: usize>(
    load: &Load<D, N>,
    span: &Span<[f64; N]>,
) -> [[f64; N]; 2] {
    let mut torques = load.limits.torques(span);
    for (torques, row) in torques.iter_mut().zip(&span.rows) {
        let axes = torques.iter_mut().zip(row.velocity);
        for ((torque, velocity), motor) in axes.zip(&load.limits.motors) {
            *torque = torque.abs() / motor.at(velocity);
        }
    }
    torques
}
