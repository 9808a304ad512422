//! From a line in space to the times of single steps.

use anyhow::{Context, Result, bail};
use delta_kin::{Arm, PlatformPath};
use nalgebra::Point3;
use stepper_sync::{Level, Trains};

use crate::machine::Machine;

/// Ticks of the timer in a second.
pub(crate) const TICKS_PER_S: u32 = 10_000_000;

/// A move that has been found to be possible: the trains of its pieces, one after the other.
pub(crate) struct Plan {
    trains: Vec<Trains<3>>,
    /// Steps from home at the end.
    end: [i32; 3],
}

impl Plan {
    /// The straight line from `from`, where the motors are at `position`, to `to`.
    pub(crate) fn new(
        machine: &Machine,
        (from, mut position): (Point3<f64>, [i32; 3]),
        to: Point3<f64>,
        feed_mm_s: f64,
    ) -> Result<Self> {
        // The end first: a point that cannot be reached is the better reason.
        machine.angles_at(to)?;
        let line = PlatformPath::line(from, to)?;
        let speed_limits = machine.speed_limits(feed_mm_s)?;
        let min_step_s = machine.rad_per_step / machine.max_rate_rad_s;
        let mut trains = Vec::new();
        let mut last = machine.delta.inverse(from)?;
        let (mut end_s, mut now) = (0.0, 0);
        for waypoint in machine
            .delta
            .follow(line, machine.tolerance_mm, speed_limits)?
        {
            let feed_s = waypoint.length / feed_mm_s;
            if waypoint.duration_s > feed_s * (1.0 + f64::EPSILON) {
                let (fastest, turn) = (waypoint.angles - last).abs().argmax();
                let arm = Arm::ALL.get(fastest).context("no such arm")?;
                bail!(
                    "feed {feed_mm_s} mm/s: {arm} would turn at {:.1} deg/s, above {:.1}",
                    (turn / feed_s).to_degrees(),
                    machine.max_rate_rad_s.to_degrees()
                );
            }
            last = waypoint.angles;
            end_s += waypoint.duration_s;
            let target = machine.steps(waypoint.angles)?;
            let steps = between(position, target).context("more steps than a train has")?;
            let pulses = steps.map(i32::unsigned_abs).into_iter().fold(0, u32::max);
            if pulses == 0 {
                continue;
            }
            // From where the time has come to, so that its rounding does not add up.
            let left_s = (end_s - seconds(now)).max(f64::from(pulses) * min_step_s);
            let half_period =
                half_period(left_s, pulses).with_context(|| format!("feed {feed_mm_s} mm/s"))?;
            let piece = Trains::new(steps, half_period)?;
            now += piece.end_ticks();
            trains.push(piece);
            position = target;
        }
        Ok(Self {
            trains,
            end: position,
        })
    }

    /// Where the move ends, in steps from home.
    pub(crate) const fn end(&self) -> [i32; 3] {
        self.end
    }

    /// The steps as exact synchronised trains, from `position` and `start` ticks on: calls `step`
    /// with the time and the new position, and returns the time of the end.
    pub(crate) fn run(
        &self,
        mut position: [i32; 3],
        start: u64,
        mut step: impl FnMut(u64, [i32; 3]) -> Result<()>,
    ) -> Result<u64> {
        let mut now = start;
        for trains in &self.trains {
            let directions = trains.steps().map(i32::signum);
            for edge in trains.edges() {
                if edge.level == Level::Low {
                    continue;
                }
                if let (Some(position), Some(direction)) =
                    (position.get_mut(edge.axis), directions.get(edge.axis))
                {
                    *position += direction;
                }
                step(now + edge.ticks, position)?;
            }
            now += trains.end_ticks();
        }
        Ok(now)
    }
}

/// The steps of each motor from one position to another, if they can be counted.
fn between(from: [i32; 3], to: [i32; 3]) -> Option<[i32; 3]> {
    let ([a1, a2, a3], [b1, b2, b3]) = (from, to);
    Some([
        b1.checked_sub(a1)?,
        b2.checked_sub(a2)?,
        b3.checked_sub(a3)?,
    ])
}

/// The time between edges that spreads pulses over a time, rounded up: never faster.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "checked to be within 1 and what 32 bits hold"
)]
fn half_period(duration_s: f64, pulses: u32) -> Result<u64> {
    let ticks = (duration_s * f64::from(TICKS_PER_S) / (2.0 * f64::from(pulses))).ceil();
    if ticks > f64::from(u32::MAX) {
        bail!(
            "a step would take {:.0} s",
            2.0 * ticks / f64::from(TICKS_PER_S)
        );
    }
    Ok(ticks.max(1.0) as u64)
}

/// Seconds as ticks, up to the next.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates"
)]
pub(crate) fn ticks(seconds: f64) -> u64 {
    (seconds * f64::from(TICKS_PER_S)).ceil() as u64
}

/// Ticks as seconds.
#[expect(clippy::cast_precision_loss, reason = "2^53 ticks are 28 years")]
pub(crate) fn seconds(ticks: u64) -> f64 {
    ticks as f64 / f64::from(TICKS_PER_S)
}
