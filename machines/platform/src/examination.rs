//! What a table does to axes and body, looked at between its points too.

use anyhow::{Context as _, Result};
use pose_pt::{BodyFit, Platform};

use crate::table::{AxisState, States, Table, positions};

/// Places of a segment that are looked at, in a short table and in a long one; the middle, where
/// the distance error of a line is largest, is one of them.
const PLACES: u32 = 32;
const PLACES_OF_MANY: u32 = 2;
/// Points of a long table.
const MANY: usize = 2000;

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

impl<const N: usize> Examination<N> {
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
                for (locator, states) in platform.locators().iter().zip(&states) {
                    for (limits, state) in locator.limits.iter().zip(states) {
                        max_speed_ratio = max_speed_ratio.max(state.speed.abs() / limits.speed);
                    }
                }
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

/// The largest change of an axis' speed, in mm per second.
fn speed_jump<const N: usize>(before: &States<N>, after: &States<N>) -> f64 {
    let pairs = before.iter().flatten().zip(after.iter().flatten());
    pairs
        .map(|(before, after)| (after.speed - before.speed).abs())
        .fold(0.0, f64::max)
}
