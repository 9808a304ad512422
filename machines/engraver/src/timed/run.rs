//! The rows of a run: as fast as joints, disc and motors allow, shaped along its course, and
//! verified.

use anyhow::Result;
use known_load::{TorqueUsed, spans, with_room, within_share};
use path_timing::{Accuracy, AxisLimits, Cubic, Promise, Row, Span, Table, Verifier};

use super::course;
use super::leg::Leg;
use crate::machine::Machine;

/// Fewest segments of a curve.
const MIN_SEGMENTS: u32 = 4;

/// The rows along legs, whose cubics leave the curves by at most `tolerance_mm`.
pub(super) fn rows(
    machine: &Machine,
    run: &[Leg],
    tolerance_mm: f64,
) -> Result<Vec<Row<[f64; 3]>>> {
    let rows = within_share(|share| {
        let rows = planned(machine, run, tolerance_mm, share)?;
        let Some(elastic) = machine.elastic else {
            return Ok((rows, 1.0));
        };
        let rows = course::shaped(run, &rows, &elastic.shaper)?;
        let asked = asked(machine, &rows);
        Ok((rows, asked))
    });
    verified(machine, run, tolerance_mm, rows?)
}

/// The fastest rows with a share of what the motors may be asked for.
fn planned(
    machine: &Machine,
    run: &[Leg],
    tolerance_mm: f64,
    share: f64,
) -> Result<Vec<Row<[f64; 3]>>> {
    let accuracy = Accuracy {
        min_segments: MIN_SEGMENTS,
        max_departure: tolerance_mm,
        max_time_ratio: f64::INFINITY,
    };
    let limits = machine.joint_limits().map(|axis| AxisLimits {
        speed: axis.speed * share,
        acceleration: axis.acceleration * share,
        jerk: None,
    });
    let departure = |leg: &Leg, span: &Span<_>| leg.departure(span);
    let legs = run.iter().map(|leg| leg.with_share(share));
    let torque = match &machine.load {
        Some(load) => Some(load.limits_at(share)?),
        None => None,
    };
    Ok(with_room(|knots| {
        let legs = legs.clone();
        match &torque {
            Some(torque) => torque
                .plan_within(legs, limits, accuracy, departure, knots)
                .map(|table| table.rows().collect()),
            // Shaped, the speeds at both ends of a segment become others.
            None if machine.elastic.is_some() => {
                Table::plan_within_at_any_feed(legs, limits, accuracy, departure, knots)
                    .map(|table| table.rows().collect())
            }
            None => Table::plan_within(legs, limits, accuracy, departure, knots)
                .map(|table| table.rows().collect()),
        }
    })?)
}

/// The largest part of a limit, or of what is planned of a motor, that rows ask for.
fn asked(machine: &Machine, rows: &[Row<[f64; 3]>]) -> f64 {
    let mut asked = 0.0_f64;
    if let Some(load) = &machine.load {
        let mut torque = TorqueUsed::none(load.reserve);
        torque.add(load, rows, 0.0);
        asked = torque.most_of_planned();
    }
    let limits = machine.joint_limits();
    for span in spans(rows) {
        let [from, to] = &span.rows;
        for (cubic, limit) in Cubic::between(from, to).zip(&limits) {
            let [a0, a1] = cubic.accelerations();
            let acceleration = a0.abs().max(a1.abs()) / limit.acceleration;
            asked = asked
                .max(acceleration)
                .max(cubic.peak_speed() / limit.speed);
        }
    }
    let jumps = rows.windows(2).filter_map(|pair| match pair {
        [from, to] if to.duration_s <= 0.0 => Some((from.velocity, to.velocity)),
        _ => None,
    });
    for (from, to) in jumps {
        let axes = from.into_iter().zip(to).zip(machine.start_speeds());
        for ((from, to), start) in axes {
            asked = asked.max((to - from).abs() / start);
        }
    }
    asked
}

/// Rows that keep what is promised of them, by code that has no part in the plan.
fn verified(
    machine: &Machine,
    run: &[Leg],
    tolerance_mm: f64,
    rows: Vec<Row<[f64; 3]>>,
) -> Result<Vec<Row<[f64; 3]>>> {
    let mut verifier = Verifier::new(Promise {
        limits: machine.joint_limits(),
        start_stop: machine.start_speeds(),
        max_departure: tolerance_mm,
        // The tool's feed may be far below what the joints are capable of.
        max_slowness: f64::INFINITY,
        tool_feed: Some(1.0),
    });
    for row in &rows {
        verifier.add(row, |leg| run.get(leg), |leg, span| leg.departure(span))?;
    }
    Ok(rows)
}
