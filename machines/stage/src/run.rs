//! What comes of a whole program on the simulated stage.

use known_load::{TorqueUsed, Vibration};

use crate::machine::Machine;
use crate::motors::FollowedAxes;
use crate::record::{Record, Seen, TimedRow, over_time};
use crate::settings::Settings;

/// What the stage did, in a closed loop and without corrections.
#[derive(Debug, Clone)]
pub struct Run {
    pub(crate) machine: Machine,
    pub(crate) settings: Settings,
    pub(crate) commanded: [i32; 2],
    pub(crate) duration_s: f64,
    /// From the programmed end: in a closed loop, and without.
    pub(crate) closing_mm: [f64; 2],
    pub(crate) lost: [u64; 2],
    pub(crate) followed: FollowedAxes,
    /// The same motions at their feeds from the first step to the last.
    pub(crate) at_feed: FollowedAxes,
    /// How both tables swing with the same program, not shaped.
    pub(crate) unshaped: Option<[Vibration; 2]>,
    pub(crate) record: Record,
}

impl Run {
    /// The stage whose lost steps are corrected.
    #[must_use]
    pub const fn closed_loop(&self) -> &Seen {
        &self.record.closed
    }

    /// The stage beside it, without corrections.
    #[must_use]
    pub const fn open_loop(&self) -> &Seen {
        &self.record.open
    }

    /// Points of each programmed motion, X and Y in mm, near enough for a picture.
    pub fn programmed(&self) -> impl Iterator<Item = Vec<[f64; 2]>> {
        let motions = self.record.programmed.iter();
        motions.map(|motion| motion.points().iter().map(|at| [at.x, at.y]).collect())
    }

    /// The rows of timed steps; none where the steps are at the feed.
    #[must_use]
    pub fn rows(&self) -> &[TimedRow] {
        &self.record.rows
    }

    /// What the speed of X and Y may be in timed steps, and its acceleration, in mm/s and mm/s².
    #[must_use]
    pub fn axes_may(&self) -> [[f64; 2]; 2] {
        self.record.axes.map(|axis| [axis.speed, axis.acceleration])
    }

    /// How long shaped rows still have of the motion before, in s.
    #[must_use]
    pub const fn shaping_s(&self) -> f64 {
        self.record.delay_s
    }

    /// Time in s and the mean speed along the path around it in mm/s, by the steps.
    pub fn speeds(&self) -> impl Iterator<Item = [f64; 2]> {
        self.followed.motion.speeds()
    }

    /// Time in s, and by the steps the acceleration in mm/s² of the axis that has the larger one.
    pub fn axis_accelerations(&self) -> impl Iterator<Item = [f64; 2]> {
        self.followed.motion.axis_accelerations()
    }

    /// What timed steps ask of the motors, where the machine's load is known.
    #[must_use]
    pub const fn torque(&self) -> Option<&TorqueUsed<2>> {
        self.record.torque.as_ref()
    }

    /// How the tables of X and Y swing, where that is known, and how they do without shaping.
    #[must_use]
    pub const fn vibration(&self) -> Option<[(&Vibration, Option<&Vibration>); 2]> {
        let Some([x, y]) = &self.followed.vibration else {
            return None;
        };
        match &self.unshaped {
            Some([plain_x, plain_y]) => Some([(x, Some(plain_x)), (y, Some(plain_y))]),
            None => Some([(x, None), (y, None)]),
        }
    }

    /// Time in s, and the steps corrected until then; where some were.
    pub fn corrections(&self) -> impl Iterator<Item = [f64; 2]> {
        over_time(&self.record.corrections).filter(|[_, steps]| steps.is_finite())
    }
}
