//! From a drawing to pattern bytes.

use anyhow::{Context, Result};
use kurbo::BezPath;
use nalgebra::{Point2, Vector2};
use pattern_codec::engraving::{Axis, Builder, JointPulses, Record, Statistics};
use scara_kin::{Elbow, Joints, TangentTool, Waypoint};
use stepper_sync::{Level, Trains};

use crate::drawing::Drawing;
use crate::gauge::distance_to_segment;
use crate::layout::Layout;
use crate::machine::Machine;
use crate::order::travel_mm;
use crate::placement::Placement;
use crate::plan_settings::PlanSettings;

/// Deepest halving of a straight move; by then every record is a single step.
const DEEPEST: u32 = 20;

/// A drawing as pattern bytes, from home and back.
#[derive(Debug, Clone)]
pub struct Plan {
    pattern: Vec<u8>,
    pub(crate) statistics: Statistics,
    pub(crate) placement: Placement,
    reference: Reference,
    /// Length of the strokes, in mm.
    pub(crate) length_mm: f64,
    /// Length of the straight lines between the strokes, in mm, from home and back.
    pub(crate) travel_mm: f64,
}

/// What the engraved path is measured against; it says nothing of how it is made.
#[derive(Debug, Clone)]
pub struct Reference {
    /// The placed drawing, in mm, in the order of its file.
    pub(crate) outlines: Vec<BezPath>,
    pub(crate) tolerance_mm: f64,
    pub(crate) bound_mm: f64,
}

impl Plan {
    /// Plans the records that engrave a drawing; `progress` is told how many strokes are done, of
    /// how many.
    ///
    /// The tolerance is divided: a quarter each for the lines that stand for curves and for the
    /// joint moves that stand for lines; the rest covers what is left of second order.
    ///
    /// # Errors
    /// A stroke leaves the workspace, and where.
    pub fn new(
        machine: &Machine,
        drawing: &Drawing,
        settings: &PlanSettings,
        mut progress: impl FnMut(u64, u64),
    ) -> Result<Self> {
        let home = machine.joints(Builder::new().position());
        let start = machine.arm.forward(home);
        let Layout {
            placement,
            outlines,
            strokes,
        } = Layout::new(machine, drawing, settings, start);
        let mut planner = Planner {
            machine,
            builder: Builder::new(),
            disc: machine.tangent,
            joints: home,
            plan: Self {
                pattern: Vec::new(),
                statistics: Statistics::default(),
                placement,
                reference: Reference {
                    outlines,
                    tolerance_mm: settings.tolerance.mm(),
                    bound_mm: 0.0,
                },
                length_mm: 0.0,
                travel_mm: travel_mm(&strokes, start),
            },
        };
        let total = strokes.len();
        for (done, stroke) in strokes.iter().enumerate() {
            let planned = planner.stroke(&stroke.points);
            planned.with_context(|| format!("stroke {} of {total}", stroke.number))?;
            progress(done as u64 + 1, total as u64);
        }
        planner.finish()
    }

    /// The records, as the controller gets them.
    #[must_use]
    pub fn pattern(&self) -> &[u8] {
        &self.pattern
    }

    /// Pulses of all axes.
    #[must_use]
    pub const fn pulses(&self) -> u64 {
        let pulses = self.statistics.pulses;
        pulses.elbow + pulses.shoulder + pulses.disc + pulses.vertical
    }

    /// What the engraved path is measured against.
    #[must_use]
    pub const fn reference(&self) -> &Reference {
        &self.reference
    }
}

impl Reference {
    /// How far path and drawing may be apart, in mm: the tolerance, and half a step of each joint
    /// where that moves the tool most.
    #[must_use]
    pub const fn bound_mm(&self) -> f64 {
        self.bound_mm
    }
}

struct Planner<'a> {
    machine: &'a Machine,
    builder: Builder,
    disc: TangentTool,
    /// Where the strokes so far have brought the joints, before rounding.
    joints: Joints,
    plan: Plan,
}

/// A straight line of the drawing between two waypoints.
#[derive(Clone, Copy)]
struct Line {
    from: Waypoint,
    to: Waypoint,
}

impl Planner<'_> {
    fn stroke(&mut self, points: &[Point2<f64>]) -> Result<()> {
        let waypoints = self.waypoints(points)?;
        let lines = || waypoints.iter().zip(waypoints.iter().skip(1));
        let Some(first) = waypoints.first() else {
            return Ok(());
        };
        self.disc.lift();
        // A dot has no heading: the disc stays as it is.
        if let Some(second) = waypoints.get(1) {
            self.turn(first.joints, heading(first, second))?;
        }
        self.travel(first.joints)?;
        self.vertical(-self.machine.lift_pulses)?;
        for (from, to) in lines() {
            let direction = heading(from, to);
            if self.turn_is_corner(from.joints, direction)? {
                self.vertical(self.machine.lift_pulses)?;
                self.turn(from.joints, direction)?;
                self.vertical(-self.machine.lift_pulses)?;
            }
            let line = Line {
                from: *from,
                to: *to,
            };
            self.line(line, direction)?;
            self.note_bound(to.point);
        }
        self.note_bound(first.point);
        self.plan.length_mm += lines()
            .map(|(from, to)| (to.point - from.point).norm())
            .sum::<f64>();
        self.vertical(self.machine.lift_pulses)
    }

    /// The joint waypoints of a stroke with the elbow of the stroke before, or with the
    /// other one where that does not reach.
    fn waypoints(&mut self, points: &[Point2<f64>]) -> Result<Vec<Waypoint>> {
        let elbow = Elbow::of(&self.joints).context("the joints are not finite")?;
        let follow = |elbow| {
            let points = points.iter().copied();
            self.machine.arm.follow_from(
                points,
                elbow,
                self.plan.reference.tolerance_mm / 4.0,
                self.joints,
            )
        };
        let waypoints: Vec<_> = follow(elbow)
            .or_else(|error| follow(elbow.other()).map_err(|_| error))?
            .collect();
        if let Some(last) = waypoints.last() {
            self.joints = last.joints;
        }
        Ok(waypoints)
    }

    /// Engraves a line by one joint move, or by halves where the whole steps of one move would
    /// leave it too far.
    fn line(&mut self, line: Line, direction: Vector2<f64>) -> Result<()> {
        let mut left = vec![(line.from.joints, line.to.joints, 0)];
        while let Some((from, to, depth)) = left.pop() {
            let pulses = self.pulses_to(to, direction)?;
            if depth == DEEPEST || self.keeps_close(pulses, &line)? {
                let records = self.builder.slow(pulses)?;
                self.write(records);
                continue;
            }
            let half = (to - from) / 2.0;
            let middle = Joints::new(from.shoulder + half.x, from.elbow + half.y);
            left.push((middle, to, depth + 1));
            left.push((from, middle, depth + 1));
        }
        Ok(())
    }

    /// The whole steps from where the steppers are to a pose, the disc along `direction`.
    fn pulses_to(&mut self, joints: Joints, direction: Vector2<f64>) -> Result<JointPulses> {
        let machine = self.machine;
        let turn = self.disc.follow(&machine.arm, joints, direction)?;
        let position = self.builder.position();
        Ok(JointPulses {
            elbow: machine.elbow.to_pulses(joints.elbow)? - position.elbow,
            shoulder: machine.shoulder.to_pulses(joints.shoulder)? - position.shoulder,
            disc: machine.disc.to_pulses(turn.tool_angle)? - position.disc,
        })
    }

    /// Whether the tool, at each whole step of a move, is as close to the line as resolution and
    /// tolerance allow.
    fn keeps_close(&self, pulses: JointPulses, line: &Line) -> Result<bool> {
        let (machine, mut builder) = (self.machine, self.builder);
        let mut position = builder.position();
        for record in builder.slow(pulses)? {
            let Record::Slow(slow) = record else { continue };
            let by = slow.pulses();
            let steps = [by.elbow, by.shoulder];
            let mut edges = Trains::new(steps, machine.half_period_ticks)?
                .edges()
                .peekable();
            while let Some(edge) = edges.next() {
                if edge.level == Level::High {
                    match edge.axis {
                        0 => position.elbow += by.elbow.signum(),
                        _ => position.shoulder += by.shoulder.signum(),
                    }
                }
                // Steps on the same tick are one.
                if edges.peek().is_some_and(|next| next.ticks == edge.ticks) {
                    continue;
                }
                let tool = machine.arm.forward(machine.joints(position));
                let off = distance_to_segment(tool, line.from.point, line.to.point);
                if off > machine.half_step_mm(tool) + self.plan.reference.tolerance_mm / 2.0 {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// Whether the disc has to be lifted to turn to `direction`.
    fn turn_is_corner(&mut self, joints: Joints, direction: Vector2<f64>) -> Result<bool> {
        let turn = self.disc.follow(&self.machine.arm, joints, direction)?;
        Ok(turn.corner.is_some())
    }

    /// Turns the lifted disc.
    fn turn(&mut self, joints: Joints, direction: Vector2<f64>) -> Result<()> {
        let pulses = self.pulses_to(joints, direction)?;
        self.rapid(Axis::Disc, pulses.disc)
    }

    /// Moves the lifted tool.
    fn travel(&mut self, to: Joints) -> Result<()> {
        let (machine, position) = (self.machine, self.builder.position());
        let shoulder = machine.shoulder.to_pulses(to.shoulder)? - position.shoulder;
        let elbow = machine.elbow.to_pulses(to.elbow)? - position.elbow;
        self.rapid(Axis::Shoulder, shoulder)?;
        self.rapid(Axis::Elbow, elbow)
    }

    fn vertical(&mut self, pulses: i32) -> Result<()> {
        self.rapid(Axis::Vertical, pulses)
    }

    fn rapid(&mut self, axis: Axis, pulses: i32) -> Result<()> {
        let records = self.builder.fast(axis, pulses)?;
        self.write(records);
        Ok(())
    }

    fn write(&mut self, records: impl Iterator<Item = Record>) {
        for record in records {
            self.plan.statistics.add(record);
            let bytes = record.encode(&self.machine.format);
            self.plan.pattern.extend(bytes);
        }
    }

    fn note_bound(&mut self, tool: Point2<f64>) {
        let bound = self.machine.half_step_mm(tool) + self.plan.reference.tolerance_mm;
        self.plan.reference.bound_mm = self.plan.reference.bound_mm.max(bound);
    }

    fn finish(mut self) -> Result<Plan> {
        let records =
            self.builder
                .home([Axis::Vertical, Axis::Disc, Axis::Elbow, Axis::Shoulder])?;
        self.write(records);
        Ok(self.plan)
    }
}

fn heading(from: &Waypoint, to: &Waypoint) -> Vector2<f64> {
    to.point - from.point
}
