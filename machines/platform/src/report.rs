//! The numbers of a run, for programs and for people.

use core::fmt;

use nalgebra::Isometry3;
use pose_pt::angle_between;
use serde::Serialize;

use crate::examination::{Examination, Passing};
use crate::mode::Mode;
use crate::planner::Plan;
use crate::table::Table;
use crate::workstation::Telegrams;
use crate::world::Outcome;

/// `report.json`; displayed, a summary in lines.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    #[serde(skip)]
    mode: Mode,
    points: usize,
    duration_s: f64,
    /// Worst change of a distance between two locators, simulated.
    max_distance_error_mm: f64,
    /// What the plan promises of it, with the rounding of coordinates.
    distance_error_bound_mm: f64,
    /// Largest fraction of its rated speed that an axis has.
    max_speed_ratio: f64,
    /// Largest jump of an axis' speed between two segments, from rest or to it.
    max_speed_jump_mm_s: f64,
    /// The limits of the platform file that the plan keeps.
    keeps: &'static [&'static str],
    /// Of the body on the simulated locators in the end, from the pose asked for.
    pose_error_mm: f64,
    pose_error_rad: f64,
    /// Poses between, in order: how near the body comes to each, and how fast it is there.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    via: Vec<Passing>,
    telegrams: Telegrams,
    line_bytes: usize,
}

/// What a speed computed from the table may be above 1 by rounding: places of 30 m are rounded
/// to 4e-12 mm, and the pendant's least move is 0.001 mm.
const ROUNDING: f64 = 1e-7;

impl Report {
    pub(crate) fn new<const N: usize>(
        outcome: &Outcome,
        plan: &Plan,
        table: &Table<N>,
        examination: &Examination<N>,
        target: &Isometry3<f64>,
        mode: Mode,
    ) -> Self {
        let end = &examination.end.pose;
        let offset = end.translation.vector - target.translation.vector;
        Self {
            mode,
            points: table.points(),
            duration_s: table.duration_s(),
            max_distance_error_mm: examination.max_distance_error,
            distance_error_bound_mm: plan.distance_error_bound_mm,
            max_speed_ratio: examination.max_speed_ratio,
            max_speed_jump_mm_s: examination.max_speed_jump,
            keeps: mode.keeps(),
            pose_error_mm: offset.norm(),
            pose_error_rad: angle_between(&end.rotation, &target.rotation),
            via: Vec::new(),
            telegrams: outcome.telegrams,
            line_bytes: outcome.line_bytes,
        }
    }

    /// The report with the poses between.
    pub(crate) fn with_passed(mut self, via: Vec<Passing>) -> Self {
        self.via = via;
        self
    }

    /// Whether the distance error is within its bound, and no axis faster than it is rated.
    #[must_use]
    pub fn is_within_bounds(&self) -> bool {
        self.max_distance_error_mm <= self.distance_error_bound_mm
            && self.max_speed_ratio <= 1.0 + ROUNDING
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let table = self.mode.file();
        writeln!(
            f,
            "line: {} telegrams, {} bytes",
            self.telegrams.total(),
            self.line_bytes
        )?;
        writeln!(
            f,
            "{table}: {} points, {:.1} s, fastest axis at {:.1} % of its rated speed",
            self.points,
            self.duration_s,
            100.0 * self.max_speed_ratio
        )?;
        if self.mode == Mode::Pt {
            writeln!(
                f,
                "{table} keeps speeds, not accelerations and jerks: an axis jumps by {:.1} mm/s at \
                 once; a PVT table keeps them",
                self.max_speed_jump_mm_s
            )?;
        }
        for (number, passing) in (1..).zip(&self.via) {
            writeln!(
                f,
                "via {number}: passed at {:.1} s, {:.3} mm and {:.4}° off, fastest axis at {:.1} % of \
                 its rated speed",
                passing.time_s,
                passing.distance_mm,
                passing.rotation_deg,
                100.0 * passing.speed_ratio
            )?;
        }
        writeln!(
            f,
            "distance error, axis by axis: {:.3e} mm at most; bound {:.3e} mm: {}",
            self.max_distance_error_mm,
            self.distance_error_bound_mm,
            if self.is_within_bounds() {
                "kept"
            } else {
                "NOT KEPT"
            }
        )?;
        writeln!(
            f,
            "the body is {:.1e} mm and {:.1e} rad from its pose",
            self.pose_error_mm, self.pose_error_rad
        )
    }
}
