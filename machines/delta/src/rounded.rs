//! Lines with rounded corners, as fast as platform and motors may go: path-timing, then steps.

use anyhow::{Context, Error, Result};
use delta_kin::Delta;
use nalgebra::{Point3, Vector3};
use path_timing::{Corner, Cubic, Curve, Knot, Path, Place, Rounded, Span, Table, ToolLimits};
use stepper_sync::{Direction, PvtQuantiser, PvtSteps, Rate, StepDirTiming};

use crate::machine::Machine;
use crate::plan::TICKS_PER_S;
use crate::record::Move;
use crate::simulation::distance;

/// Segments of a leg at the least: a change of speed takes some of them.
const LEAST_SEGMENTS: u32 = 64;
/// Room for the knots of a leg: so many, and one more for each of so many mm.
const KNOTS: f64 = 130.0;
const KNOT_MM: f64 = 0.25;

/// What a point of a line may be off it, in roundings of the machine's lengths.
const ROUNDING: f64 = 100.0;

/// A line or the rounding of a corner, as a path of the three joints.
#[derive(Debug, Clone)]
struct Leg<'a> {
    delta: &'a Delta,
    curve: Curve<3>,
    /// Index of the move whose line it is, or with whose end it begins.
    line: usize,
}

impl Path for Leg<'_> {
    type Axes = [f64; 3];
    type Error = Error;

    fn length(&self) -> f64 {
        self.curve.length()
    }

    fn place(&self, s: f64) -> Result<Place<[f64; 3]>> {
        let at = self.curve.at(s);
        let pose = self.delta.pose_at(Point3::from(at.point))?;
        Ok(Place {
            position: pose.angles().into(),
            slope: pose.joint_rates(Vector3::from(at.tangent))?.into(),
        })
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.curve.tool()
    }

    fn corner(&self) -> Corner<[f64; 3]> {
        Corner::Smooth
    }
}

impl Leg<'_> {
    /// How far the platform is from the curve at three places of a segment, in mm.
    fn departure(&self, span: &Span<[f64; 3]>) -> f64 {
        let [from, to] = &span.rows;
        let places = [0.25, 0.5, 0.75].map(|tau| {
            let mut angles = Vector3::zeros();
            for (angle, cubic) in angles.iter_mut().zip(Cubic::between(from, to)) {
                *angle = position(&cubic, tau);
            }
            let [s0, s1] = span.s;
            let at = self.delta.forward(angles);
            at.map_or(f64::INFINITY, |at| self.distance(at, s0 + (s1 - s0) * tau))
        });
        places.into_iter().fold(0.0, f64::max)
    }

    /// From the curve, near a parameter.
    fn distance(&self, point: Point3<f64>, mut s: f64) -> f64 {
        /// Each leaves the square of the error.
        const PROJECTIONS: u32 = 3;
        let off = |s: f64| {
            let at = self.curve.at(s);
            (point - Point3::from(at.point), Vector3::from(at.tangent))
        };
        for _ in 0..PROJECTIONS {
            let (off, tangent) = off(s);
            s = (s + off.dot(&tangent)).clamp(0.0, self.length());
        }
        off(s).0.norm()
    }
}

/// A cubic at a fraction of its time.
fn position(cubic: &Cubic, tau: f64) -> f64 {
    let way = cubic.q1 - cubic.q0;
    let [v0, v1] = [cubic.v0, cubic.v1].map(|speed| speed * cubic.duration_s);
    let (c2, c3) = (3.0 * way - 2.0 * v0 - v1, v0 + v1 - 2.0 * way);
    cubic.q0 + tau * (v0 + tau * (c2 + tau * c3))
}

/// Runs the lines of moves, from rest to rest: calls `step` with the time and the position after
/// each step, and sets the times at which the moves end, or round their corners.
#[expect(clippy::float_cmp, reason = "the very numbers of the same path")]
pub(crate) fn run(
    machine: &Machine,
    moves: &mut [Move],
    mut step: impl FnMut(u64, [i32; 3]) -> Result<()>,
) -> Result<()> {
    let legs = legs(machine, moves)?;
    let knots = legs.iter().map(|leg| KNOTS + leg.length() / KNOT_MM);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates"
    )]
    let knots = knots.sum::<f64>() as usize;
    let mut knots = vec![Knot::default(); knots];
    let table = Table::plan_within(
        legs.iter(),
        machine.axis_limits(),
        LEAST_SEGMENTS,
        machine.tolerance_mm,
        |leg, span| leg.departure(span),
        &mut knots,
    )?;

    let mut rows = table.rows();
    let Some(first) = rows.next().transpose()? else {
        return Ok(());
    };
    let tick_rate = Rate::from_hz(TICKS_PER_S)?;
    let timing = StepDirTiming::DRV8825.min_intervals(tick_rate);
    let mut quantiser = PvtQuantiser::new(tick_rate, [machine.scale; 3], first.position)?;
    let mut steps = PvtSteps::new(quantiser.knots(), timing);
    let mut position = machine.steps(first.position.into())?;
    let mut legs = legs.iter();
    let mut leg = legs.next();
    for row in rows {
        let row = row?;
        steps.push(&quantiser.row(row.time_s, row.position, row.velocity)?)?;
        for edge in &mut steps {
            if let Some(position) = position.get_mut(edge.axis) {
                *position += match edge.direction {
                    Direction::Positive => 1,
                    Direction::Negative => -1,
                };
            }
            step(edge.ticks, position)?;
        }
        // The row at the end of a leg has its very positions.
        while let Some(done) = leg
            && done.place(done.length())?.position == row.position
        {
            if let Some(ended) = moves.get_mut(done.line) {
                ended.end_ticks = steps.end_ticks();
            }
            leg = legs.next();
        }
    }
    // A move that goes nowhere ends with the one before.
    let mut last = 0;
    for it in moves {
        it.end_ticks = it.end_ticks.max(last);
        last = it.end_ticks;
    }
    Ok(())
}

/// The lines and the rounded corners between them, each at the feed of its move; a corner at the
/// lower one of both.
fn legs<'m>(machine: &'m Machine, moves: &[Move]) -> Result<Vec<Leg<'m>>> {
    let start = moves.iter().take(1).map(|first| first.from);
    let points = start.chain(moves.iter().map(|it| it.to));
    let mut lines = moves.iter().enumerate().filter(|(_, it)| it.from != it.to);
    let mut line = lines.next();
    let mut legs = Vec::new();
    for curve in Rounded::new(points.map(Into::into), machine.corner_mm)? {
        let curve: Curve<3> = curve?;
        let (index, now) = line.context("a curve behind the last line")?;
        let end = Point3::from(curve.end());
        let mut feed_mm_s = now.feed_mm_s;
        if distance(end, now.from, now.to) > ROUNDING * machine.delta.tolerance() {
            line = lines.next();
            let (_, next) = line.context("a corner behind the last line")?;
            feed_mm_s = feed_mm_s.min(next.feed_mm_s);
        } else if end == now.to {
            line = lines.next();
        }
        let tool = ToolLimits {
            feed: feed_mm_s,
            acceleration: Some(machine.acceleration_mm_s2),
        };
        legs.push(Leg {
            delta: &machine.delta,
            curve: curve.with_tool(tool),
            line: index,
        });
    }
    Ok(legs)
}
