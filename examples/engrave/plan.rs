//! From placed outlines to pattern bytes.

use std::io::Write;

use anyhow::{Context, Result};
use kurbo::Affine;
use nalgebra::{Point2, Vector2};
use pose2pulse::pattern_codec::engraving::{Axis, Builder, JointPulses, Record};
use pose2pulse::scara_kin::{Elbow, Joints, TangentTool, Waypoint};
use pose2pulse::stepper_sync::{Level, Trains};

use crate::drawing::{Drawing, flatten};
use crate::gauge::distance_to_segment;
use crate::machine::Machine;
use crate::progress::Progress;

/// Deepest halving of a straight move; by then every record is a single step.
const DEEPEST: u32 = 20;

/// What was planned.
pub(crate) struct Plan {
    pub(crate) strokes: usize,
    pub(crate) fast_records: u64,
    pub(crate) slow_records: u64,
    /// Length of the strokes, in mm.
    pub(crate) length_mm: f64,
    pub(crate) tolerance_mm: f64,
    /// The tolerance, and half a step of each joint where that moves the tool most.
    pub(crate) bound_mm: f64,
}

/// Writes the records that engrave `drawing`, from home and back.
///
/// The tolerance is shared: a quarter each for the lines that stand for curves and for
/// the joint moves that stand for lines; the rest covers what is left of second order.
pub(crate) fn write_pattern(
    machine: &Machine,
    drawing: &Drawing,
    placement: Affine,
    tolerance_mm: f64,
    out: impl Write,
) -> Result<Plan> {
    let outlines = drawing.placed(placement);
    let mut planner = Planner {
        machine,
        out,
        builder: Builder::new(),
        disc: machine.disc,
        joints: machine.joints(Builder::new().position()),
        plan: Plan {
            strokes: outlines.len(),
            fast_records: 0,
            slow_records: 0,
            length_mm: 0.0,
            tolerance_mm,
            bound_mm: 0.0,
        },
    };
    let progress = Progress::new("planning", u64::try_from(outlines.len())?);
    for (number, outline) in outlines.iter().enumerate() {
        let points = flatten(outline, tolerance_mm / 4.0);
        planner
            .stroke(&points)
            .with_context(|| format!("stroke {} of {}", number + 1, outlines.len()))?;
        progress.advance(1);
    }
    planner.finish()
}

struct Planner<'a, W> {
    machine: &'a Machine,
    out: W,
    builder: Builder,
    disc: TangentTool,
    /// Where the strokes so far have brought the joints, before rounding.
    joints: Joints,
    plan: Plan,
}

/// A straight piece of the drawing between two waypoints.
#[derive(Clone, Copy)]
struct Piece {
    from: Waypoint,
    to: Waypoint,
}

impl<W: Write> Planner<'_, W> {
    fn stroke(&mut self, points: &[Point2<f64>]) -> Result<()> {
        let waypoints = self.waypoints(points)?;
        let pieces = || waypoints.iter().zip(waypoints.iter().skip(1));
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
        for (from, to) in pieces() {
            let direction = heading(from, to);
            if self.turn_is_corner(from.joints, direction)? {
                self.vertical(self.machine.lift_pulses)?;
                self.turn(from.joints, direction)?;
                self.vertical(-self.machine.lift_pulses)?;
            }
            self.cut(
                Piece {
                    from: *from,
                    to: *to,
                },
                direction,
            )?;
            self.note_bound(to.place.point);
        }
        self.note_bound(first.place.point);
        self.plan.length_mm += pieces()
            .map(|(from, to)| (to.place.point - from.place.point).norm())
            .sum::<f64>();
        self.vertical(self.machine.lift_pulses)
    }

    /// The joint waypoints of a stroke with the elbow of the stroke before, or with the
    /// other one where that does not reach.
    fn waypoints(&mut self, points: &[Point2<f64>]) -> Result<Vec<Waypoint>> {
        let elbow = Elbow::of(&self.joints).context("the joints are not finite")?;
        let follow = |elbow| {
            let points = points.iter().copied();
            self.machine
                .arm
                .follow_from(points, elbow, self.plan.tolerance_mm / 4.0, self.joints)
        };
        let waypoints: Vec<_> = follow(elbow)
            .or_else(|error| follow(elbow.other()).map_err(|_| error))?
            .collect();
        if let Some(last) = waypoints.last() {
            self.joints = last.joints;
        }
        Ok(waypoints)
    }

    /// Engraves a straight piece by one joint move, or by halves where the whole steps
    /// of one move would leave it too far.
    fn cut(&mut self, piece: Piece, direction: Vector2<f64>) -> Result<()> {
        let mut left = vec![(piece.from.joints, piece.to.joints, 0)];
        while let Some((from, to, depth)) = left.pop() {
            let pulses = self.pulses_to(to, direction)?;
            if depth == DEEPEST || self.keeps_close(pulses, &piece)? {
                let records = self.builder.slow(pulses)?;
                self.write(records)?;
                continue;
            }
            let half = from.way_to(to) / 2.0;
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
            theta1: machine.theta1.to_pulses(joints.elbow)? - position.theta1,
            theta2: machine.theta2.to_pulses(joints.shoulder)? - position.theta2,
            theta3: machine.theta3.to_pulses(turn.theta3)? - position.theta3,
        })
    }

    /// Whether the tool, at each whole step of a move, is as close to the piece as
    /// resolution and tolerance allow.
    fn keeps_close(&self, pulses: JointPulses, piece: &Piece) -> Result<bool> {
        let (machine, mut builder) = (self.machine, self.builder);
        let mut position = builder.position();
        for record in builder.slow(pulses)? {
            let Record::Slow(slow) = record else { continue };
            let part = slow.pulses();
            let steps = [part.theta1, part.theta2];
            let mut edges = Trains::new(steps, machine.half_period_ticks)?
                .edges()
                .peekable();
            while let Some(edge) = edges.next() {
                if edge.level == Level::High {
                    match edge.axis {
                        0 => position.theta1 += part.theta1.signum(),
                        _ => position.theta2 += part.theta2.signum(),
                    }
                }
                // Steps on the same tick are one.
                if edges.peek().is_some_and(|next| next.ticks == edge.ticks) {
                    continue;
                }
                let tool = machine.arm.forward(machine.joints(position));
                let off = distance_to_segment(tool, piece.from.place.point, piece.to.place.point);
                if off > machine.half_step_mm(tool) + self.plan.tolerance_mm / 2.0 {
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
        self.rapid(Axis::Theta3, pulses.theta3)
    }

    /// Moves the lifted tool.
    fn travel(&mut self, to: Joints) -> Result<()> {
        let (machine, position) = (self.machine, self.builder.position());
        let theta2 = machine.theta2.to_pulses(to.shoulder)? - position.theta2;
        let theta1 = machine.theta1.to_pulses(to.elbow)? - position.theta1;
        self.rapid(Axis::Theta2, theta2)?;
        self.rapid(Axis::Theta1, theta1)
    }

    fn vertical(&mut self, pulses: i32) -> Result<()> {
        self.rapid(Axis::Vertical, pulses)
    }

    fn rapid(&mut self, axis: Axis, pulses: i32) -> Result<()> {
        let records = self.builder.fast(axis, pulses)?;
        self.write(records)
    }

    fn write(&mut self, records: impl Iterator<Item = Record>) -> Result<()> {
        for record in records {
            match record {
                Record::Fast(_) => self.plan.fast_records += 1,
                Record::Slow(_) => self.plan.slow_records += 1,
            }
            self.out.write_all(&record.encode(&self.machine.format))?;
        }
        Ok(())
    }

    fn note_bound(&mut self, tool: Point2<f64>) {
        let bound = self.machine.half_step_mm(tool) + self.plan.tolerance_mm;
        self.plan.bound_mm = self.plan.bound_mm.max(bound);
    }

    fn finish(mut self) -> Result<Plan> {
        let records =
            self.builder
                .home([Axis::Vertical, Axis::Theta3, Axis::Theta1, Axis::Theta2])?;
        self.write(records)?;
        self.out.flush()?;
        Ok(self.plan)
    }
}

fn heading(from: &Waypoint, to: &Waypoint) -> Vector2<f64> {
    to.place.point - from.place.point
}
