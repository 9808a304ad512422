//! The locators and the body over time.

use anyhow::Result;
use nalgebra::Point3;
use pose_pt::Platform;

use crate::examination::Examination;
use crate::settings::Settings;
use crate::table::{States, positions};

/// Moments of a table that are kept, at most.
const MOMENTS: usize = 1000;

/// The locators and the body at a time.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct PlatformAt {
    /// Seconds from the start.
    pub time_s: f64,
    /// Where each locator is in the world.
    pub locators_mm: Vec<[f64; 3]>,
    /// Along the three axes of each locator.
    pub speeds_mm_s: Vec<[f64; 3]>,
    /// Worst change of a distance between two locators.
    pub distance_error_mm: f64,
    /// The body's outline in the world, where it fits the locators best.
    pub outline_mm: Vec<[f64; 3]>,
}

impl PlatformAt {
    pub(crate) fn new<const N: usize>(
        time_s: f64,
        states: &States<N>,
        platform: &Platform<N>,
        settings: &Settings,
    ) -> Result<Self> {
        let axes = positions(states);
        let places = platform.locator_positions(&axes);
        let body = platform.pose(&axes)?;
        let outline = settings.outline().into_iter();
        Ok(Self {
            time_s,
            locators_mm: places
                .iter()
                .map(|it: &Point3<f64>| it.coords.into())
                .collect(),
            speeds_mm_s: states.map(|axes| axes.map(|axis| axis.speed)).to_vec(),
            distance_error_mm: platform.distance_error(&places).change.abs(),
            outline_mm: outline.map(|it| (body.pose * it).coords.into()).collect(),
        })
    }
}

/// Of a table, thinned.
pub(crate) fn of_table<const N: usize>(
    examination: &Examination<N>,
    platform: &Platform<N>,
    settings: &Settings,
) -> Result<Vec<PlatformAt>> {
    let moments = &examination.moments;
    let every = moments.len().div_ceil(MOMENTS).max(1);
    let kept = moments.iter().step_by(every).chain(moments.last());
    let at = kept.map(|it| PlatformAt::new(it.time_s, &it.states, platform, settings));
    at.collect()
}
