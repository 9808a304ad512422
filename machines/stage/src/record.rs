//! What is seen of the stage and of the one without corrections.

use known_load::TorqueUsed;
use kurbo::Point;
use machine_sim::Profile;
use path_timing::AxisLimits;

use crate::grid::seconds;
use crate::machine::Machine;
use crate::motion::Motion;
use crate::motors::Motors;
use crate::planned::Planned;

/// From one point of a picture to the next.
const PICTURE_MM: f64 = 0.05;

/// Where a stage was during a motion, thinned for a picture.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Leg {
    /// The motion was a rapid one.
    pub is_rapid: bool,
    /// As programmed, in mm/s.
    pub feed_mm_s: f64,
    /// Time in s, X and Y in mm.
    pub points: Vec<[f64; 3]>,
}

impl Leg {
    fn push(&mut self, ticks: u64, at: Point) {
        self.points.push([seconds(ticks), at.x, at.y]);
    }

    fn follow(&mut self, ticks: u64, at: Point) {
        let is_near = |&[_, x, y]: &[f64; 3]| at.distance(Point::new(x, y)) < PICTURE_MM;
        if !self.points.last().is_some_and(is_near) {
            self.push(ticks, at);
        }
    }
}

/// The end of a row of timed steps: from one to the next each axis runs the cubic between them.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct TimedRow {
    /// Seconds from the start.
    pub time_s: f64,
    /// X and Y, in mm.
    pub position_mm: [f64; 2],
    /// Of X and Y, in mm/s.
    pub velocity_mm_s: [f64; 2],
    /// The motion that the row ends on, as the legs are numbered.
    pub motion: usize,
    /// What the stage may do along the curve that the row ends on, in mm/s.
    pub feed_mm_s: f64,
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
pub struct Seen {
    pub(crate) legs: Vec<Leg>,
    pub(crate) worst: Worst,
    /// Distance in mm from the programmed curve, over microseconds.
    pub(crate) deviations: Profile,
}

impl Seen {
    /// Where the stage was, a leg for each motion of the program.
    #[must_use]
    pub fn legs(&self) -> &[Leg] {
        &self.legs
    }

    /// Time in s, and the largest distance from the programmed curve around it in mm; no number
    /// where no step was made.
    pub fn deviations(&self) -> impl Iterator<Item = [f64; 2]> {
        over_time(&self.deviations)
    }
}

/// Time in s and the largest value; no number where there is none.
pub(crate) fn over_time(profile: &Profile) -> impl Iterator<Item = [f64; 2]> {
    let parts = profile.parts();
    parts.map(|(ticks, max)| [seconds(ticks), max.unwrap_or(f64::NAN)])
}

/// What is seen of a run.
#[derive(Debug, Clone)]
pub(crate) struct Record {
    pub(crate) programmed: Vec<Motion>,
    /// How many of them were run from rest to rest each time, where none was broken off.
    pub(crate) chains: Option<Vec<usize>>,
    /// How far the curves leave the lines at most, by the proof.
    pub(crate) departure_mm: f64,
    /// And where rows are shaped, these the curves.
    pub(crate) shaped_mm: Option<f64>,
    /// How long shaped rows still have of the motion before.
    pub(crate) delay_s: f64,
    /// What the axes might do.
    pub(crate) axes: [AxisLimits; 2],
    /// What they ask of the motors, where the machine's load is known.
    pub(crate) torque: Option<TorqueUsed<2>>,
    /// They get the steps of the path.
    pub(crate) motors: Motors,
    /// Of each axis, either way; corrections are counted apart.
    pub(crate) steps: [u64; 2],
    pub(crate) corrected: u64,
    /// Corrected steps so far, over microseconds.
    pub(crate) corrections: Profile,
    pub(crate) closed: Seen,
    pub(crate) open: Seen,
    /// Of timed steps.
    pub(crate) rows: Vec<TimedRow>,
}

impl Record {
    pub(crate) fn new(machine: &Machine) -> Self {
        Self {
            programmed: Vec::new(),
            chains: Some(Vec::new()),
            departure_mm: 0.0,
            shaped_mm: None,
            delay_s: 0.0,
            axes: machine.axis_limits(),
            torque: machine.load.map(|load| TorqueUsed::none(load.reserve)),
            motors: Motors::new(machine),
            steps: [0; 2],
            corrected: 0,
            corrections: Profile::default(),
            closed: Seen::default(),
            open: Seen::default(),
            rows: Vec::new(),
        }
    }

    /// A row of timed steps has been run, or is where they begin.
    pub(crate) fn row(
        &mut self,
        time_s: f64,
        [position_mm, velocity_mm_s]: [[f64; 2]; 2],
        feed_mm_s: f64,
    ) {
        self.rows.push(TimedRow {
            time_s,
            position_mm,
            velocity_mm_s,
            feed_mm_s,
            motion: self.closed.legs.len().saturating_sub(1),
        });
    }

    /// A chain of motions is planned, to begin at a time.
    pub(crate) fn planned(&mut self, machine: &Machine, planned: &Planned, start_s: f64) {
        self.delay_s = planned.delay_s;
        self.shaped_mm = match (self.shaped_mm, planned.shaped_mm) {
            (Some(a), Some(b)) => Some(a.max(b)),
            (a, b) => a.or(b),
        };
        if let (Some(torque), Some(load)) = (&mut self.torque, &machine.load) {
            torque.add(load, &planned.rows, start_s);
        }
    }

    /// A motion begins, with both stages at a point.
    pub(crate) fn begin(&mut self, ticks: u64, motion: &Motion, [closed, open]: [Point; 2]) {
        self.programmed.push(*motion);
        for (seen, at) in [(&mut self.closed, closed), (&mut self.open, open)] {
            // A motion's leg begins where the one before ends.
            if let Some(leg) = seen.legs.last_mut() {
                leg.push(ticks, at);
            }
            seen.legs.push(Leg {
                is_rapid: motion.is_rapid,
                feed_mm_s: motion.feed_mm_s,
                points: vec![[seconds(ticks), at.x, at.y]],
            });
        }
    }

    /// A step is made along some motions, the stages are at a point each.
    pub(crate) fn step(
        &mut self,
        ticks: u64,
        by: [i32; 2],
        [closed, open]: [Point; 2],
        motions: &[Motion],
    ) {
        self.motors.step(ticks, by);
        for (made, by) in self.steps.iter_mut().zip(by) {
            *made += u64::from(by.unsigned_abs());
        }
        for (seen, at) in [(&mut self.closed, closed), (&mut self.open, open)] {
            let each = motions.iter().map(|motion| motion.distance_mm(at));
            let deviation_mm = each.fold(f64::INFINITY, f64::min);
            seen.worst.step(at, deviation_mm);
            seen.deviations.add(ticks, deviation_mm);
            if let Some(leg) = seen.legs.last_mut() {
                leg.follow(ticks, at);
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
    pub(crate) fn end(&mut self, ticks: u64, [closed, open]: [Point; 2]) {
        for (seen, at) in [(&mut self.closed, closed), (&mut self.open, open)] {
            if let Some(leg) = seen.legs.last_mut() {
                leg.push(ticks, at);
            }
        }
    }
}
