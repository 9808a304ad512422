//! The tool, which swings on the platform that the steps move.

use machine_sim::{ElasticMode, Profile};
use nalgebra::Point3;

use crate::load::Elastic;
use crate::plan::{seconds, ticks};

/// How long the tool is looked at after the last step, and how often, in s.
const RING_S: f64 = 0.25;
const LOOK_S: f64 = 1e-3;

/// A tool that swings as it was found to.
#[derive(Debug, Clone)]
pub(crate) struct Tool {
    mode: ElasticMode<3>,
    most_mm: f64,
    profile: Profile,
}

/// How the tool has swung.
#[derive(Debug, Clone)]
pub(crate) struct Vibration {
    /// The farthest that it was off its place on the platform.
    pub(crate) most_mm: f64,
    /// How far it swings after the last step.
    pub(crate) left_mm: f64,
    /// How far it was off at most in each part of the time: s and mm.
    pub(crate) over_time: Vec<[f64; 2]>,
}

impl Tool {
    pub(crate) fn new(elastic: &Elastic, at: Point3<f64>) -> Self {
        let mode = elastic.mode;
        Self {
            mode: ElasticMode::new(mode.hz, mode.damping, at.into()),
            most_mm: 0.0,
            profile: Profile::new(),
        }
    }

    /// The platform stands up to a time and then goes to a place.
    pub(crate) fn follow(&mut self, t_s: f64, point: Point3<f64>) {
        self.look(t_s);
        self.mode.follow(t_s, point.into());
        self.look(t_s);
    }

    fn look(&mut self, t_s: f64) {
        self.mode.swing_until(t_s);
        let off = self.mode.deflection();
        self.most_mm = self.most_mm.max(off);
        self.profile.add(ticks(t_s), off);
    }

    /// The last step was at this time.
    pub(crate) fn finish(mut self, end_s: f64) -> Vibration {
        self.look(end_s);
        let left_mm = self.mode.swing();
        let mut t_s = end_s;
        while t_s < end_s + RING_S {
            t_s += LOOK_S;
            self.look(t_s);
        }
        let parts = self.profile.parts();
        let over_time = parts.filter_map(|(at, off)| Some([seconds(at), off?]));
        Vibration {
            most_mm: self.most_mm,
            left_mm,
            over_time: over_time.collect(),
        }
    }
}
