//! The rows along the legs: as fast as arms and motors may go, and shaped for the mode of the tool.

use anyhow::Result;
use delta_kin::DeltaPath;
use known_load::{TorqueUsed, off, shape, spans, within_share};
use path_timing::{Accuracy, Knot, Promise, Row, Shaper, Span, Table, Verifier};

use crate::machine::Machine;

/// Segments of a leg at the least: of fewer it cannot be told whether ball joints hold.
const LEAST_SEGMENTS: u32 = 16;
/// The time is at most so many times the best.
const TIME_RATIO: f64 = 1.02;

/// A motion from rest to rest.
pub(crate) struct Planned {
    pub(crate) rows: Vec<Row<[f64; 3]>>,
    /// Proven bounds in mm: how far the platform leaves its curves between rows, and by shaping.
    pub(crate) departure_mm: f64,
    pub(crate) shaped_mm: Option<f64>,
    /// Seconds after which shaping has let all of a motion pass.
    pub(crate) delay_s: f64,
    pub(crate) torque: Option<TorqueUsed<3>>,
}

impl Planned {
    /// Along paths, with room for so many knots.
    pub(crate) fn new(machine: &Machine, paths: &[DeltaPath], knots: usize) -> Result<Self> {
        let mut knots = vec![Knot::default(); knots];
        within_share(|share| {
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
            let mut most = 0.0;
            if let Some(load) = machine.load {
                let mut torque = TorqueUsed::none(load.reserve);
                torque.add(&load, &planned.rows, 0.0);
                most = torque.most_of_planned();
                planned.torque = Some(torque);
            }
            Ok((planned, most))
        })
    }

    /// Shapes each arm.
    fn shape(&mut self, paths: &[DeltaPath], shaper: &Shaper) -> Result<()> {
        let shapers = [*shaper; 3];
        let off = off(&self.rows, &shapers);
        let bounds = spans(&self.rows).filter_map(|span| {
            let [_, to] = &span.rows;
            Some(paths.get(to.leg)?.shifted_departure(&span, off))
        });
        self.shaped_mm = Some(bounds.fold(0.0, f64::max));
        let shaped = shape(&self.rows, shapers)?;
        (self.rows, self.delay_s) = (shaped.rows, shaped.delay_s);
        Ok(())
    }
}

/// The fastest rows with a share of the motors' torque, verified, and the bound of their departure.
fn timed(
    machine: &Machine,
    paths: &[DeltaPath],
    share: f64,
    knots: &mut [Knot<[f64; 3]>],
) -> Result<(Vec<Row<[f64; 3]>>, f64)> {
    let limits = machine.axis_limits();
    let accuracy = Accuracy {
        min_segments: LEAST_SEGMENTS,
        max_departure: machine.tolerance_mm,
        max_time_ratio: TIME_RATIO,
    };
    let bound = |path: &&DeltaPath, span: &Span<[f64; 3]>| path.departure(span);
    let (rows, spans): (Vec<_>, Vec<_>) = if let Some(load) = machine.load {
        let torque = load.limits_at(share)?;
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
        tool_feed: Some(1.0),
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
