//! The drawing by `path-timing`: the tool at its feed wherever joints and disc allow, from the
//! drawing's own curves to edges, without a pattern between.

mod course;
mod curves;
mod leg;
mod player;
mod run;

use anyhow::{Context, Result, bail};
use nalgebra::Point2;
use path_timing::{AxisLimits, Curve, Path as _, Row};
use pattern_codec::engraving::Axis;
use scara_kin::{Elbow, Joints};

use self::curves::{curves_of, kink_rad};
use self::leg::Leg;
pub use self::player::simulate_timed;
use crate::drawing::Drawing;
use crate::layout::Layout;
use crate::machine::Machine;
use crate::order::Stroke;
use crate::plan::Reference;
use crate::plan_settings::PlanSettings;

/// Largest kink between two curves that is passed without a stop, in radians: what drawing programs
/// round off. The disc takes it in along the next curve.
const KINK_RAD: f64 = 0.035;

/// A drawing as rapid moves and timed strokes, from home and back.
#[derive(Debug, Clone)]
pub struct TimedPlan {
    moves: Vec<Move>,
    reference: Reference,
}

/// A move of the machine.
#[derive(Debug, Clone)]
enum Move {
    /// One axis to a position in pulses from home, by its own ramp.
    Rapid { axis: Axis, to: i32 },
    /// Shoulder, elbow and disc along these rows, in radians and seconds, from rest to rest; the
    /// number of the drawing's stroke.
    Stroke(usize, Vec<Row<[f64; 3]>>),
}

/// The end of a row of a timed stroke: from one to the next of a stroke each joint runs the cubic
/// between them.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct TimedRow {
    /// Seconds from the start.
    pub time_s: f64,
    /// Of shoulder, elbow and disc, in radians.
    pub position_rad: [f64; 3],
    /// Of shoulder, elbow and disc, in rad/s.
    pub velocity_rad_s: [f64; 3],
    /// The drawing's stroke, from 1.
    pub stroke: usize,
    /// It is where joints and disc begin at rest.
    pub is_first: bool,
}

impl TimedPlan {
    /// Plans the moves that engrave a drawing; `progress` is told how many strokes are done, of how
    /// many.
    ///
    /// A quarter of the tolerance each is for blends of corners between lines, and for the
    /// departure of the joints' cubics.
    ///
    /// # Errors
    /// A stroke leaves the workspace, and where.
    pub fn new(
        machine: &Machine,
        drawing: &Drawing,
        settings: &PlanSettings,
        mut progress: impl FnMut(u64, u64),
    ) -> Result<Self> {
        let tolerance_mm = settings.tolerance.mm();
        let home = machine.joints_at_home();
        let start = machine.arm.forward(home);
        let Layout {
            outlines, strokes, ..
        } = Layout::new(machine, drawing, settings, start);
        let mut planner = Planner {
            machine,
            tolerance_mm: tolerance_mm / 4.0,
            joints: home,
            disc_rad: machine.disc.to_rad(0),
            moves: Vec::new(),
            bound_mm: 0.0,
        };
        let total = strokes.len();
        for (done, stroke) in strokes.iter().enumerate() {
            let index = stroke.number - 1;
            let outline = outlines.get(index).context("strokes are numbered from 1")?;
            let curves = curves_of(
                outline,
                stroke.is_reversed,
                tolerance_mm / 4.0,
                machine.corner_rad(),
            );
            let planned = curves.and_then(|curves| planner.stroke(&curves, stroke));
            planned.with_context(|| format!("stroke {} of {total}", stroke.number))?;
            progress(done as u64 + 1, total as u64);
        }
        for axis in [Axis::Vertical, Axis::Disc, Axis::Elbow, Axis::Shoulder] {
            planner.moves.push(Move::Rapid { axis, to: 0 });
        }
        Ok(Self {
            moves: planner.moves,
            reference: Reference {
                outlines,
                tolerance_mm,
                bound_mm: planner.bound_mm + tolerance_mm,
            },
        })
    }
}

struct Planner<'a> {
    machine: &'a Machine,
    tolerance_mm: f64,
    /// Where the strokes so far have brought joints and disc.
    joints: Joints,
    disc_rad: f64,
    moves: Vec<Move>,
    /// Half a step of each joint where that moves the tool most.
    bound_mm: f64,
}

/// Curves that are run without a stop.
type Run = Vec<Leg>;

impl Planner<'_> {
    fn stroke(&mut self, curves: &[Curve<2>], stroke: &Stroke) -> Result<()> {
        let elbow = Elbow::of(&self.joints).context("the joints are not finite")?;
        let first = stroke.points.first();
        let Some(first) = first.copied() else {
            return Ok(());
        };
        self.note_bound(first);
        if curves.is_empty() {
            return self.dot(first);
        }
        let runs = self.runs(curves, elbow);
        let runs = runs.or_else(|error| self.runs(curves, elbow.other()).map_err(|_| error))?;
        for (number, run) in runs.iter().enumerate() {
            let rows = run::rows(self.machine, run, self.tolerance_mm)?;
            let (Some(start), Some(end)) = (rows.first(), rows.last()) else {
                bail!("a run has no rows");
            };
            let [shoulder, elbow, disc] = start.position;
            let disc = self.machine.disc.to_pulses(disc)?;
            if number == 0 {
                self.rapid(Axis::Disc, disc);
                self.travel(Joints::new(shoulder, elbow))?;
                self.rapid(Axis::Vertical, -self.machine.lift_pulses);
            } else if run.first().is_some_and(Leg::is_corner) {
                self.rapid(Axis::Vertical, 0);
                self.rapid(Axis::Disc, disc);
                self.rapid(Axis::Vertical, -self.machine.lift_pulses);
            } else {
                self.rapid(Axis::Disc, disc);
            }
            let [shoulder, elbow, disc] = end.position;
            (self.joints, self.disc_rad) = (Joints::new(shoulder, elbow), disc);
            self.moves.push(Move::Stroke(stroke.number, rows));
        }
        for curve in curves {
            for fraction in [0.25, 0.5, 0.75, 1.0] {
                self.note_bound(curve.at(curve.length() * fraction).point.into());
            }
        }
        self.rapid(Axis::Vertical, 0);
        Ok(())
    }

    /// A stroke without length.
    fn dot(&mut self, at: Point2<f64>) -> Result<()> {
        let (_, joints) = self.machine.arm.inverse_nearest(at, self.joints)?;
        self.joints = joints;
        self.travel(joints)?;
        self.rapid(Axis::Vertical, -self.machine.lift_pulses);
        self.rapid(Axis::Vertical, 0);
        Ok(())
    }

    /// The curves with one elbow, cut where the tool has to stop: at kinks that the disc cannot
    /// take in on the way.
    fn runs(&self, curves: &[Curve<2>], elbow: Elbow) -> Result<Vec<Run>> {
        let (machine, mut joints, mut disc_rad) = (self.machine, self.joints, self.disc_rad);
        let mut runs: Vec<Run> = Vec::new();
        let mut before: Option<&Curve<2>> = None;
        for curve in curves {
            let fed = curve.with_tool(machine.tool_limits());
            let path = machine.arm.path_from(fed, elbow, joints)?;
            let path = path.with_disc(disc_rad)?;
            let kink = before.map(|before| kink_rad(before, curve).abs());
            let goes_on = kink.filter(|kink| *kink <= KINK_RAD);
            let is_corner = kink.is_some_and(|kink| kink > machine.corner_rad());
            let leg = if goes_on.is_some() {
                Leg::going_on(path, disc_rad, machine.start_speeds())?
            } else {
                Leg::from_rest(path, is_corner, machine.start_speeds())
            };
            let [shoulder, elbow_rad, disc] = leg.point(leg.length())?.position;
            (joints, disc_rad) = (Joints::new(shoulder, elbow_rad), disc);
            match runs.last_mut().filter(|_| goes_on.is_some()) {
                Some(run) => run.push(leg),
                None => runs.push(vec![leg]),
            }
            before = Some(curve);
        }
        Ok(runs)
    }

    fn travel(&mut self, to: Joints) -> Result<()> {
        let machine = self.machine;
        self.rapid(Axis::Shoulder, machine.shoulder.to_pulses(to.shoulder)?);
        self.rapid(Axis::Elbow, machine.elbow.to_pulses(to.elbow)?);
        Ok(())
    }

    fn rapid(&mut self, axis: Axis, to: i32) {
        self.moves.push(Move::Rapid { axis, to });
    }

    fn note_bound(&mut self, tool: Point2<f64>) {
        self.bound_mm = self.bound_mm.max(self.machine.half_step_mm(tool));
    }
}

/// What timed strokes keep.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct TimedLimits {
    /// Of shoulder, elbow and disc the speed in rad/s and the acceleration in rad/s².
    pub axes: [(f64, f64); 3],
    /// Of the tool along its path, in mm/s.
    pub feed_mm_s: f64,
    /// Of the tool along its path, in mm/s², if there is such a limit.
    pub acceleration_mm_s2: Option<f64>,
}

impl Machine {
    /// What timed strokes keep.
    #[must_use]
    pub fn timed_limits(&self) -> TimedLimits {
        let tool = self.tool_limits();
        TimedLimits {
            axes: self
                .joint_limits()
                .map(|axis| (axis.speed, axis.acceleration)),
            feed_mm_s: tool.feed,
            acceleration_mm_s2: tool.acceleration,
        }
    }

    fn joints_at_home(&self) -> Joints {
        Joints::new(self.shoulder.to_rad(0), self.elbow.to_rad(0))
    }

    /// A rate in pulses a second for shoulder, elbow and disc, in radians a second.
    fn rates(&self, hz: f64) -> [f64; 3] {
        [self.shoulder, self.elbow, self.disc].map(|joint| hz * joint.rad_per_pulse)
    }

    /// What the motors of shoulder, elbow and disc start and stop with, in rad/s.
    pub(crate) fn start_speeds(&self) -> [f64; 3] {
        self.rates(f64::from(self.rapid.start_millihertz) / 1000.0)
    }

    /// Of shoulder, elbow and disc, in rad/s.
    pub(crate) fn joint_speeds(&self) -> [f64; 3] {
        self.rates(f64::from(self.rapid.max_millihertz) / 1000.0)
    }

    /// Those of the rapid moves, or with an acceleration of their own.
    pub(crate) fn joint_limits(&self) -> [AxisLimits; 3] {
        let speeds = self.joint_speeds();
        let accelerations = self.rates(self.joint_accel_hz_per_s);
        let [shoulder, elbow, disc] = speeds;
        let [a0, a1, a2] = accelerations;
        [(shoulder, a0), (elbow, a1), (disc, a2)].map(|(speed, acceleration)| AxisLimits {
            speed,
            acceleration,
            jerk: None,
        })
    }
}
