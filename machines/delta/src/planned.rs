//! The rows along the legs: as fast as arms and motors may go, and shaped for the mode of the tool.

use anyhow::{Result, bail};
use delta_kin::DeltaPath;
use path_timing::{Accuracy, Cubic, Knot, Promise, Row, Shaped, Shaper, Span, Table, Verifier};

use crate::load::Load;
use crate::machine::Machine;
use crate::torque::{ArmRow, TorqueUsed, spans};

/// Segments of a leg at the least: of fewer it cannot be told whether ball joints hold.
const LEAST_SEGMENTS: u32 = 16;
/// The time is at most so many times the best.
const TIME_RATIO: f64 = 1.02;
/// A sum of delayed motions may ask for more torque than each of them: rounds of planning with less, and
/// how much less than what is missing.
const ROUNDS: u32 = 8;
const LESS: f64 = 0.999;

/// A motion from rest to rest.
pub(crate) struct Planned {
    pub(crate) rows: Vec<ArmRow>,
    /// Proven bounds in mm: how far the platform leaves its curves between rows, and by shaping.
    pub(crate) departure_mm: f64,
    pub(crate) shaped_mm: Option<f64>,
    /// Seconds after which shaping has let all of a motion pass.
    pub(crate) delay_s: f64,
    pub(crate) torque: Option<TorqueUsed>,
}

impl Planned {
    /// Along paths, with room for so many knots.
    pub(crate) fn new(machine: &Machine, paths: &[DeltaPath], knots: usize) -> Result<Self> {
        let mut knots = vec![Knot::default(); knots];
        let mut share = 1.0;
        for _ in 0..ROUNDS {
            let (rows, departure_mm) = timed(machine, paths, share, &mut knots)?;
            let mut planned = Self {
                rows,
                departure_mm,
                shaped_mm: None,
                delay_s: 0.0,
                torque: None,
            };
            if let Some(elastic) = machine.elastic {
                planned.shape(paths, &elastic.shaper)?;
            }
            let Some(load) = machine.load else {
                return Ok(planned);
            };
            let torque = TorqueUsed::of(&load, &planned.rows);
            let most = torque.most_of_planned();
            planned.torque = Some(torque);
            if most <= 1.0 {
                return Ok(planned);
            }
            share *= LESS / most;
        }
        bail!("[mode] shaper: no motion that is shaped keeps the motors' torque");
    }

    /// Shapes each arm.
    fn shape(&mut self, paths: &[DeltaPath], shaper: &Shaper) -> Result<()> {
        let mut off = [0.0_f64; 3];
        for span in spans(&self.rows) {
            let [from, to] = &span.rows;
            for (off, cubic) in off.iter_mut().zip(Cubic::between(from, to)) {
                let [a0, a1] = cubic.accelerations();
                *off = off.max(shaper.departure(a0.abs().max(a1.abs())));
            }
        }
        let bounds = spans(&self.rows).filter_map(|span| {
            let [_, to] = &span.rows;
            Some(paths.get(to.leg)?.shifted_departure(&span, off))
        });
        self.shaped_mm = Some(bounds.fold(0.0, f64::max));
        let shapers = [*shaper; 3];
        let rows = self.rows.iter().copied();
        let mut memory = vec![Row::default(); Shaped::memory_for(rows.clone(), &shapers)];
        let mut shaped = Shaped::new(rows, shapers, &mut memory);
        let rows: Result<Vec<_>, _> = shaped.by_ref().collect();
        self.delay_s = shaped.longest_delay_s();
        self.rows = rows?;
        Ok(())
    }
}

/// The fastest rows with a share of the motors' torque, verified, and the bound of their departure.
fn timed(
    machine: &Machine,
    paths: &[DeltaPath],
    share: f64,
    knots: &mut [Knot<[f64; 3]>],
) -> Result<(Vec<ArmRow>, f64)> {
    let limits = machine.axis_limits();
    let accuracy = Accuracy {
        min_segments: LEAST_SEGMENTS,
        max_departure: machine.tolerance_mm,
        max_time_ratio: TIME_RATIO,
    };
    let bound = |path: &&DeltaPath, span: &Span<[f64; 3]>| path.departure(span);
    let (rows, spans): (Vec<_>, Vec<_>) = if let Some(Load { limits: torque, .. }) = machine.load {
        let mut torque = torque;
        for motor in &mut torque.motors {
            *motor = motor.scaled(share)?;
        }
        let table = torque.plan_within(paths.iter(), limits, accuracy, bound, knots)?;
        (table.rows().collect(), table.spans().collect())
    } else {
        let table = Table::plan_within(paths.iter(), limits, accuracy, bound, knots)?;
        (table.rows().collect(), table.spans().collect())
    };

    let mut verifier = Verifier::new(Promise {
        limits,
        start_stop: [0.0; 3],
        max_departure: machine.tolerance_mm,
        // The feed may be far below what the arms are capable of.
        max_slowness: f64::INFINITY,
    });
    for row in &rows {
        verifier.add(row, |leg| paths.get(leg), |path, span| path.departure(span))?;
    }
    let departures = spans.iter().filter_map(|span| {
        let [_, to] = &span.rows;
        Some(paths.get(to.leg)?.departure(span))
    });
    Ok((rows, departures.fold(0.0, f64::max)))
}
