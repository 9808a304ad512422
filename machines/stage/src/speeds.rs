//! Speeds along a chain of motions: ramps that the motors follow, joined at the corners.

use core::fmt;
use core::str::FromStr;

use anyhow::{Context, Error, Result, bail};
use kurbo::Vec2;
use stepper_sync::{AxisRamp, Ramp, RampEnds, RampLimits, Rate};

use crate::controller::TICKS_PER_S;
use crate::motion::{Motion, Shape};
use crate::paths::STEPS_PER_MM;

/// The acceleration that each axis is planned for at most.
pub const ACCELERATION_MM_S2: f64 = 500.0;
/// The speed that each axis is planned for at most, in mm/s: its motor follows 70 at this acceleration,
/// and loses steps at 80.
pub(crate) const MAX_AXIS_MM_S: f64 = 60.0;
/// By what an axis may change its speed at once: what its motor starts and stops with.
pub(crate) const START_STOP_MM_S: f64 = 5.0;
/// An arc takes 0.8 of the acceleration across its path and 0.6 along it: together 1 in the worst
/// direction.
const ACROSS_ARC: f64 = 0.8;
const ALONG_ARC: f64 = 0.6;
/// Of the path that a ramp is planned for: rates are rounded to mHz, and it must not end short.
const PLANNED_FRACTION: f64 = 0.999;

/// How the speed along the path changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum SpeedProfile {
    /// Trapezoids, with corners at what the motors start and stop with.
    #[default]
    Trapezoidal,
    /// The feed from the first step to the last, as published.
    Constant,
}

impl SpeedProfile {
    /// Its name on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Trapezoidal => "trapezoidal",
            Self::Constant => "constant",
        }
    }
}

impl fmt::Display for SpeedProfile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for SpeedProfile {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Ok(match name {
            "trapezoidal" => Self::Trapezoidal,
            "constant" => Self::Constant,
            _ => bail!("the profiles are trapezoidal and constant"),
        })
    }
}

/// A motion as the planner sees it: an axis as long as its path. In steps and seconds.
#[derive(Debug, Clone, Copy)]
struct Leg {
    units: i32,
    feed: f64,
    acceleration: f64,
    entry: f64,
    exit: f64,
}

impl Leg {
    /// With the highest speeds at both ends that the leg itself allows.
    fn new(motion: &Motion, units: i32) -> Self {
        let feed = axis_feed(motion) * STEPS_PER_MM;
        let each = ACCELERATION_MM_S2 * STEPS_PER_MM;
        let (feed, acceleration) = match motion.shape {
            Shape::Line => (feed, each / largest(motion.directions()[0])),
            Shape::Arc { centre, .. } => {
                let radius = motion.from.distance(centre) * STEPS_PER_MM;
                (
                    feed.min((ACROSS_ARC * each * radius).sqrt()),
                    ALONG_ARC * each,
                )
            }
        };
        Self {
            units,
            feed,
            acceleration,
            entry: feed,
            exit: feed,
        }
    }

    /// The largest speed at one end from a speed at the other.
    fn reached_from(&self, speed: f64) -> f64 {
        let distance = f64::from(self.units) * PLANNED_FRACTION;
        (speed * speed + 2.0 * self.acceleration * distance).sqrt()
    }

    fn ramp(&self) -> Result<Ramp<1>> {
        let limits = RampLimits {
            start_millihertz: 0,
            max_millihertz: millihertz(self.feed),
            accel_steps_per_s2: whole(self.acceleration),
        };
        let ends = RampEnds {
            entry_millihertz: millihertz(self.entry),
            exit_millihertz: millihertz(self.exit),
        };
        let rate = Rate::from_hz(whole(TICKS_PER_S))?;
        Ok(Ramp::between([self.units], &limits, ends, rate)?)
    }
}

/// The feed of a motion in mm/s, as far as both axes can go along it.
pub(crate) fn axis_feed(motion: &Motion) -> f64 {
    let fastest = match motion.shape {
        Shape::Line => MAX_AXIS_MM_S / largest(motion.directions()[0]),
        // Somewhere along it one axis has all of the speed, or nearly so.
        Shape::Arc { .. } => MAX_AXIS_MM_S,
    };
    motion.feed_mm_s.min(fastest)
}

/// The speed at which the direction may change, within what the motors start and stop with.
fn corner(before: Vec2, after: Vec2) -> f64 {
    START_STOP_MM_S * STEPS_PER_MM / largest(after - before)
}

/// Of both axes.
const fn largest(direction: Vec2) -> f64 {
    direction.x.abs().max(direction.y.abs())
}

/// The ticks of each step length along a chain of motions, from rest to rest: an iterator.
#[derive(Debug, Clone)]
pub(crate) struct Units {
    /// The last one first.
    ramps: Vec<Ramp<1>>,
    edges: Option<AxisRamp>,
    /// End of the ramp in hand, its last edge and its last step, in ticks since the start.
    end: u64,
    edge: u64,
    step: u64,
}

impl Units {
    /// Motions with the step lengths of their paths, in 65536ths.
    pub(crate) fn plan<'m>(motions: impl Iterator<Item = (&'m Motion, u64)>) -> Result<Self> {
        let (mut sum_q16, mut sum) = (0_u64, 0);
        let mut legs: Vec<Leg> = Vec::new();
        let mut direction = Vec2::ZERO;
        for (motion, length_q16) in motions {
            sum_q16 += length_q16;
            // Rounded up at the end of each motion, so that no path is longer than its clock.
            let end = i32::try_from(sum_q16.div_ceil(1 << 16)).context("the path is too long")?;
            let units = end - core::mem::replace(&mut sum, end);
            if units == 0 {
                continue;
            }
            let mut leg = Leg::new(motion, units);
            let [first, last] = motion.directions();
            leg.entry = leg.entry.min(corner(direction, first));
            if let Some(before) = legs.last_mut() {
                leg.entry = leg.entry.min(before.exit);
                before.exit = leg.entry;
            }
            direction = last;
            legs.push(leg);
        }
        if let Some(last) = legs.last_mut() {
            last.exit = last.exit.min(corner(direction, Vec2::ZERO));
        }
        join(&mut legs);
        Ok(Self {
            ramps: legs.iter().rev().map(Leg::ramp).collect::<Result<_>>()?,
            edges: None,
            end: 0,
            edge: 0,
            step: 0,
        })
    }

    /// The end of the last ramp, in ticks since the start.
    pub(crate) fn end_ticks(&self) -> u64 {
        let rest = self.ramps.iter().map(Ramp::end_ticks);
        self.end + rest.sum::<u64>()
    }
}

impl Iterator for Units {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        loop {
            if let Some(edges) = &mut self.edges
                && let Some(low_ticks) = edges.next()
            {
                let step = self.edge + low_ticks;
                self.edge = step + edges.next()?;
                let unit = step - core::mem::replace(&mut self.step, step);
                return u32::try_from(unit).ok();
            }
            let ramp = self.ramps.pop()?;
            self.edge = self.end;
            self.end += ramp.end_ticks();
            let [edges] = ramp.axes();
            self.edges = Some(edges);
        }
    }
}

/// Lowers the speeds where legs meet: backward, so that each leg can slow down to its end, then
/// forward, so that it can reach it.
fn join(legs: &mut [Leg]) {
    let mut next = f64::INFINITY;
    for leg in legs.iter_mut().rev() {
        leg.exit = leg.exit.min(next);
        leg.entry = leg.entry.min(leg.reached_from(leg.exit));
        next = leg.entry;
    }
    let mut last = f64::INFINITY;
    for leg in legs {
        leg.entry = leg.entry.min(last);
        leg.exit = leg.exit.min(leg.reached_from(leg.entry));
        last = leg.exit;
    }
}

fn millihertz(hz: f64) -> u32 {
    whole(hz * 1000.0)
}

/// Rounded down; rates and accelerations are far below 2^32.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates"
)]
const fn whole(number: f64) -> u32 {
    number as u32
}
