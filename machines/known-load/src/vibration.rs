//! A tool that swings on what the steps move.

use machine_sim::{ElasticMode, Profile};

use crate::mode::Elastic;

/// How long the tool is looked at after the last step, and how often, in s.
const RING_S: f64 = 0.25;
const LOOK_S: f64 = 1e-3;
/// Of the time over which it is noted.
const TICKS_PER_S: f64 = 1e6;

/// A tool that swings as it was found to.
#[derive(Debug, Clone)]
pub struct Tool<const N: usize> {
    mode: ElasticMode<N>,
    /// Whether it is looked at.
    is_at_work: bool,
    seen: Vibration,
}

/// How a tool has swung.
#[derive(Debug, Clone)]
pub struct Vibration {
    pub(crate) hz: f64,
    /// The farthest that it was off its place.
    pub(crate) most_mm: f64,
    /// How far it swings where a motion ends.
    pub(crate) left_mm: f64,
    /// How far it was off at most in each part of the time.
    profile: Profile,
}

impl<const N: usize> Tool<N> {
    /// A tool at rest at a place in mm, at its work.
    #[must_use]
    pub fn new(elastic: &Elastic, at_mm: [f64; N]) -> Self {
        let mode = elastic.mode;
        Self {
            mode: ElasticMode::new(mode.hz, mode.damping, at_mm),
            is_at_work: true,
            seen: Vibration {
                hz: mode.hz,
                most_mm: 0.0,
                left_mm: 0.0,
                profile: Profile::new(),
            },
        }
    }

    /// Whether it is at its work from now on: else it swings and is not looked at.
    pub const fn work(&mut self, is_at_work: bool) {
        self.is_at_work = is_at_work;
    }

    /// What moves it stands up to a time and then goes to a place.
    pub fn follow(&mut self, t_s: f64, at_mm: [f64; N]) {
        self.look(t_s);
        self.mode.follow(t_s, at_mm);
        self.look(t_s);
    }

    fn look(&mut self, t_s: f64) {
        self.mode.swing_until(t_s);
        if self.is_at_work {
            let off = self.mode.deflection();
            self.seen.most_mm = self.seen.most_mm.max(off);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "saturates"
            )]
            let ticks = (t_s * TICKS_PER_S) as u64;
            self.seen.profile.add(ticks, off);
        }
    }

    /// A motion has ended: how far the tool still swings counts.
    pub fn rest(&mut self, t_s: f64) {
        self.look(t_s);
        self.seen.left_mm = self.seen.left_mm.max(self.mode.swing());
    }

    /// How it has swung, and how it swings after the last step.
    #[must_use]
    pub fn finish(mut self, end_s: f64) -> Vibration {
        let mut t_s = end_s;
        while t_s < end_s + RING_S {
            t_s += LOOK_S;
            self.look(t_s);
        }
        self.seen
    }
}

impl Vibration {
    /// How far the tool was off its place at most in each part of the time in which it was at its
    /// work: s and mm.
    pub fn over_time(&self) -> impl Iterator<Item = [f64; 2]> {
        #[expect(clippy::cast_precision_loss, reason = "2^53 ticks are centuries")]
        let seconds = |ticks: u64| ticks as f64 / TICKS_PER_S;
        let parts = self.profile.parts();
        parts.filter_map(move |(ticks, off)| Some([seconds(ticks), off?]))
    }
}
