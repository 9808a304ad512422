//! What a table does to axes and body, looked at between its points too.

use anyhow::{Context as _, Result};
use pose_pt::{Blend, BodyFit, Platform, angle_between};
use serde::Serialize;

use crate::machine::isometry;
use crate::pose::Pose;
use crate::table::{AxisState, States, Table, positions};

/// Places of a segment that are looked at, in a short table and in a long one; the middle, where
/// the distance error of a line is largest, is one of them.
const PLACES: u32 = 32;
const PLACES_OF_MANY: u32 = 2;
/// Points of a long table.
const MANY: usize = 2000;

/// In place of a tolerance of 0, where the body stops: in mm, and in radians.
const LEAST_TOLERANCE: f64 = 1e-9;

/// The platform at one moment of a table.
pub(crate) struct Moment<const N: usize> {
    pub(crate) time_s: f64,
    pub(crate) states: States<N>,
    /// Worst change of a distance between two locators, in mm.
    pub(crate) distance_error: f64,
}

/// What a table does to axes and body.
pub(crate) struct Examination<const N: usize> {
    pub(crate) moments: Vec<Moment<N>>,
    pub(crate) max_distance_error: f64,
    /// Largest fraction of its rated speed that an axis has.
    pub(crate) max_speed_ratio: f64,
    /// Largest jump of an axis' speed from one segment to the next, from rest and to it, in mm
    /// per second: no motor can make it.
    pub(crate) max_speed_jump: f64,
    /// Where the body is in the end.
    pub(crate) end: BodyFit<N>,
}

/// How the body passes a pose between the first and the last.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Passing {
    pub(crate) time_s: f64,
    pub(crate) distance_mm: f64,
    pub(crate) rotation_deg: f64,
    /// Of the axis that has the largest fraction of its rated speed there; 0 at a stop.
    pub(crate) speed_ratio: f64,
}

impl<const N: usize> Examination<N> {
    /// Where the body comes nearest to a pose, distance and rotation each in parts of its
    /// tolerance.
    pub(crate) fn passing(
        &self,
        platform: &Platform<N>,
        (pose, blend): &(Pose, Blend),
    ) -> Result<Passing> {
        let pose = isometry(*pose);
        let mut nearest: Option<(f64, Passing)> = None;
        for moment in &self.moments {
            let body = platform.pose(&positions(&moment.states))?.pose;
            let distance_mm = (body.translation.vector - pose.translation.vector).norm();
            let rotation_rad = angle_between(&body.rotation, &pose.rotation);
            let distance = distance_mm / blend.distance.max(LEAST_TOLERANCE);
            let off = distance.max(rotation_rad / blend.rotation_rad.max(LEAST_TOLERANCE));
            if nearest.is_none_or(|(least, _)| off < least) {
                let passing = Passing {
                    time_s: moment.time_s,
                    distance_mm,
                    rotation_deg: rotation_rad.to_degrees(),
                    speed_ratio: speed_ratio(platform, &moment.states),
                };
                nearest = Some((off, passing));
            }
        }
        let (_, passing) = nearest.context("a table without a segment")?;
        Ok(passing)
    }

    /// Runs all axes through all segments.
    pub(crate) fn of(table: &Table<N>, platform: &Platform<N>) -> Result<Self> {
        let mut moments = Vec::new();
        let (mut max_distance_error, mut max_speed_ratio) = (0.0_f64, 0.0_f64);
        let mut max_speed_jump = 0.0_f64;
        let rest = [[AxisState::default(); 3]; N];
        let mut before = rest;
        let places = if table.points() < MANY {
            PLACES
        } else {
            PLACES_OF_MANY
        };
        for (segment, [start, end]) in table.segments() {
            for place in 0..=places {
                let s = f64::from(place) / f64::from(places);
                let states = table.states(segment, s).context("no such segment")?;
                if place == 0 {
                    max_speed_jump = max_speed_jump.max(speed_jump(&before, &states));
                }
                before = states;
                let anchors = platform.locator_positions(&positions(&states));
                let distance_error = platform.distance_error(&anchors).change;
                max_distance_error = max_distance_error.max(distance_error.abs());
                max_speed_ratio = max_speed_ratio.max(speed_ratio(platform, &states));
                moments.push(Moment {
                    time_s: start + s * (end - start),
                    states,
                    distance_error,
                });
            }
        }
        let last = moments.last().context("a table without a segment")?;
        Ok(Self {
            max_distance_error,
            max_speed_ratio,
            max_speed_jump: max_speed_jump.max(speed_jump(&before, &rest)),
            end: platform.pose(&positions(&last.states))?,
            moments,
        })
    }
}

/// The largest fraction of its rated speed that an axis has.
fn speed_ratio<const N: usize>(platform: &Platform<N>, states: &States<N>) -> f64 {
    let limits = platform.locators().iter().flat_map(|it| &it.limits);
    let axes = limits.zip(states.iter().flatten());
    let ratios = axes.map(|(limits, state)| state.speed.abs() / limits.speed);
    ratios.fold(0.0, f64::max)
}

/// The largest change of an axis' speed, in mm per second.
fn speed_jump<const N: usize>(before: &States<N>, after: &States<N>) -> f64 {
    let pairs = before.iter().flatten().zip(after.iter().flatten());
    pairs
        .map(|(before, after)| (after.speed - before.speed).abs())
        .fold(0.0, f64::max)
}
