//! What of their torque the motors are asked for along the rows.

use path_timing::{Row, Span};
use serde::Serialize;

use crate::load::Load;

pub(crate) type ArmRow = Row<[f64; 3]>;

/// The parts of the motors' pull-out torque that a motion asks for.
#[derive(Debug, Clone)]
pub(crate) struct TorqueUsed {
    /// What is planned of the motors.
    pub(crate) planned: f64,
    pub(crate) most: MostTorque,
    /// Of each arm at the ends of each segment, with the time in s.
    pub(crate) arms: Vec<(f64, [f64; 3])>,
}

/// Where a motor is asked for the most.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct MostTorque {
    /// The largest part of its pull-out torque that is asked of any motor: a proven bound.
    pub(crate) part: f64,
    /// Arm, from 1.
    pub(crate) arm: usize,
    pub(crate) t_s: f64,
    #[serde(skip)]
    row: ArmRow,
}

impl TorqueUsed {
    /// Of the cubics between rows.
    pub(crate) fn of(load: &Load, rows: &[ArmRow]) -> Self {
        let planned = 1.0 - load.reserve;
        let mut most = MostTorque {
            part: 0.0,
            arm: 1,
            t_s: 0.0,
            row: ArmRow::default(),
        };
        let mut arms = Vec::new();
        for span in spans(rows) {
            let ends = parts(load, &span).map(|parts| parts.map(|part| part * planned));
            arms.extend(
                span.rows
                    .iter()
                    .zip(ends)
                    .map(|(row, parts)| (row.time_s, parts)),
            );
            let part = load.limits.utilisation(&span) * planned;
            if part > most.part {
                let all = ends.iter().flat_map(|parts| parts.iter().zip(1..));
                let arm = all.max_by(|(a, _), (b, _)| a.total_cmp(b));
                let [row, _] = span.rows;
                most = MostTorque {
                    part,
                    arm: arm.map_or(1, |(_, arm)| arm),
                    t_s: row.time_s,
                    row,
                };
            }
        }
        Self {
            planned,
            most,
            arms,
        }
    }

    /// The most, over what is planned of the motors.
    pub(crate) fn most_of_planned(&self) -> f64 {
        self.most.part / self.planned
    }

    /// The angles of the arms where a motor is asked for the most.
    pub(crate) const fn angles_at_most(&self) -> [f64; 3] {
        self.most.row.position
    }
}

/// The segments between rows.
pub(crate) fn spans(rows: &[ArmRow]) -> impl Iterator<Item = Span<[f64; 3]>> {
    rows.windows(2).filter_map(|pair| match pair {
        [from, to] if to.duration_s > 0.0 => Some(Span {
            s: [from.s, to.s],
            rows: [*from, *to],
        }),
        _ => None,
    })
}

/// The parts of what is planned of each motor, at both ends of a segment.
fn parts(load: &Load, span: &Span<[f64; 3]>) -> [[f64; 3]; 2] {
    let mut torques = load.limits.torques(span);
    for (torques, row) in torques.iter_mut().zip(&span.rows) {
        let arms = torques.iter_mut().zip(row.velocity);
        for ((torque, velocity), motor) in arms.zip(&load.limits.motors) {
            *torque = torque.abs() / motor.at(velocity);
        }
    }
    torques
}
