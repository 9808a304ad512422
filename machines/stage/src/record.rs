//! What is seen of the stage and of the one without corrections.

use kurbo::Point;
use machine_sim::Profile;

use crate::motion::Motion;
use crate::motors::Motors;

/// From one point of a picture to the next.
const PICTURE_MM: f64 = 0.05;

/// Where a stage was during a motion, thinned for a picture.
#[derive(Debug, Clone)]
pub(crate) struct Leg {
    pub(crate) is_rapid: bool,
    pub(crate) points: Vec<Point>,
}

impl Leg {
    fn follow(&mut self, at: Point) {
        let last = self.points.last();
        if last.is_none_or(|last| last.distance(at) >= PICTURE_MM) {
            self.points.push(at);
        }
    }
}

/// The largest deviation, and the steps around it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Worst {
    pub(crate) deviation_mm: f64,
    pub(crate) at: Option<Point>,
    pub(crate) steps: Vec<Point>,
    /// The last, at most `AROUND`.
    recent: Vec<Point>,
    to_come: usize,
}

impl Worst {
    /// Steps that are kept before and after.
    const AROUND: usize = 60;

    fn step(&mut self, at: Point, deviation_mm: f64) {
        if deviation_mm > self.deviation_mm {
            (self.deviation_mm, self.at) = (deviation_mm, Some(at));
            self.steps.clone_from(&self.recent);
            self.to_come = Self::AROUND;
        }
        if self.to_come > 0 {
            self.to_come -= 1;
            self.steps.push(at);
        }
        if self.recent.len() == Self::AROUND {
            self.recent.remove(0);
        }
        self.recent.push(at);
    }
}

/// What is seen of one stage.
#[derive(Debug, Clone, Default)]
pub(crate) struct Seen {
    pub(crate) legs: Vec<Leg>,
    pub(crate) worst: Worst,
    /// Distance in mm from the programmed curve, over microseconds.
    pub(crate) deviations: Profile,
}

/// What is seen of a run.
#[derive(Debug, Clone, Default)]
pub(crate) struct Record {
    pub(crate) programmed: Vec<Motion>,
    /// They get the steps of the path.
    pub(crate) motors: Motors,
    /// Of each axis, either way; corrections are counted apart.
    pub(crate) steps: [u64; 2],
    pub(crate) corrected: u64,
    /// Corrected steps so far, over microseconds.
    pub(crate) corrections: Profile,
    pub(crate) closed: Seen,
    pub(crate) open: Seen,
}

impl Record {
    /// A motion begins, with both stages at a point.
    pub(crate) fn begin(&mut self, motion: &Motion, [closed, open]: [Point; 2]) {
        self.programmed.push(*motion);
        for (seen, at) in [(&mut self.closed, closed), (&mut self.open, open)] {
            // A motion's leg begins where the one before ends.
            if let Some(leg) = seen.legs.last_mut() {
                leg.points.push(at);
            }
            seen.legs.push(Leg {
                is_rapid: motion.is_rapid,
                points: vec![at],
            });
        }
    }

    /// A step is made, the stages are at a point each.
    pub(crate) fn step(&mut self, ticks: u64, by: [i32; 2], [closed, open]: [Point; 2]) {
        self.motors.step(ticks, by);
        for (made, by) in self.steps.iter_mut().zip(by) {
            *made += u64::from(by.unsigned_abs());
        }
        let Some(motion) = self.programmed.last() else {
            return;
        };
        for (seen, at) in [(&mut self.closed, closed), (&mut self.open, open)] {
            let deviation_mm = motion.distance_mm(at);
            seen.worst.step(at, deviation_mm);
            seen.deviations.add(ticks, deviation_mm);
            if let Some(leg) = seen.legs.last_mut() {
                leg.follow(at);
            }
        }
    }

    /// Lost steps are made good.
    pub(crate) fn correct(&mut self, ticks: u64, steps: u32) {
        self.corrected += u64::from(steps);
        #[expect(clippy::cast_precision_loss, reason = "far below 2^52 steps")]
        self.corrections.add(ticks, self.corrected as f64);
    }

    /// The run ends, with both stages at a point.
    pub(crate) fn end(&mut self, [closed, open]: [Point; 2]) {
        for (seen, at) in [(&mut self.closed, closed), (&mut self.open, open)] {
            if let Some(leg) = seen.legs.last_mut() {
                leg.points.push(at);
            }
        }
    }
}
