//! The simulated machine: three steppers and the platform they carry. It gets steps and nothing
//! else; its path is then compared with the lines that were asked for.

use std::io::BufRead;

use anyhow::Result;
use known_load::{Elastic, Tool, TorqueUsed, Vibration};
use machine_sim::{Followed, MotionSampler};
use nalgebra::Point3;

use crate::control_tick;
use crate::machine::Machine;
use crate::motion::Motion;
use crate::motors::Motors;
use crate::plan::{Plan, seconds};
use crate::record::{Move, Record};
use crate::rounded;
use crate::step_log;

/// What steps may be off their places: those of cubics by a tick, those of trains by the rounding
/// of joint waypoints to whole steps.
const CUBIC_STEPS: f64 = 0.01;
const TRAINS_STEPS: f64 = 1.0;
/// Between two points of a picture's path, in mm.
const SPACING_MM: f64 = 0.5;

/// What the simulated machine did, driven by the steps.
#[derive(Debug, Clone)]
pub struct Drive<'a> {
    pub(crate) machine: &'a Machine,
    pub(crate) record: &'a Record,
    pub(crate) driven: Driven,
    /// Of the platform, in mm.
    pub(crate) motion: MotionSampler<3>,
    /// Of the motors, in steps from home.
    pub(crate) positions: MotionSampler<3>,
}

/// What the simulated machine did, driven by the steps, and for comparison by trains at the feed
/// and by the thesis' control tick.
#[derive(Debug, Clone)]
pub struct Run<'a> {
    pub(crate) machine: &'a Machine,
    pub(crate) record: &'a Record,
    pub(crate) driven: Driven,
    pub(crate) trains: Driven,
    pub(crate) ticked: Driven,
    /// As `driven` without shaping, where there is any.
    pub(crate) unshaped: Option<Driven>,
    pub(crate) motion: MotionSampler<3>,
}

/// What the simulated machine did in one of these ways.
#[derive(Debug, Clone)]
pub(crate) struct Driven {
    pub(crate) max_path_error_mm: f64,
    pub(crate) duration_s: f64,
    /// Of all motors, either way.
    pub(crate) steps: u64,
    /// Steps from home at the end.
    pub(crate) end: [i32; 3],
    pub(crate) motors: [Followed; 3],
    /// Of a tool that is known to swing.
    pub(crate) vibration: Option<Vibration>,
    /// The platform's path, thinned for a picture.
    pub(crate) path: Vec<Point3<f64>>,
}

impl<'a> Drive<'a> {
    /// Time in s and speed of the platform in mm/s, the mean around it.
    pub fn speeds(&self) -> impl Iterator<Item = [f64; 2]> {
        self.motion.speeds()
    }

    /// The lines that were asked for: ends in mm, feed in mm/s, and when each ends in s.
    pub fn lines(&self) -> impl Iterator<Item = ([[f64; 3]; 2], f64, f64)> {
        let moves = self.record.moves.iter();
        moves.map(|it| {
            let ends = [it.from.into(), it.to.into()];
            (ends, it.feed_mm_s, seconds(it.end_ticks))
        })
    }

    /// How long the steps take, in s.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.driven.duration_s
    }

    /// What the lines ask of the motors, where the machine's load is known.
    #[must_use]
    pub const fn torque(&self) -> Option<&TorqueUsed<3>> {
        self.record.torque.as_ref()
    }

    /// How the tool swings, where its mode is known.
    #[must_use]
    pub const fn vibration(&self) -> Option<&Vibration> {
        self.driven.vibration.as_ref()
    }

    /// Farthest that the platform was from the lines asked for, in mm.
    #[must_use]
    pub const fn max_path_error_mm(&self) -> f64 {
        self.driven.max_path_error_mm
    }

    /// Drives the same lines in the other ways too, which takes several times as long.
    ///
    /// # Errors
    /// No platform is where their steps lead.
    pub fn compared(self) -> Result<Run<'a>> {
        let (machine, moves) = (self.machine, &self.record.moves);
        Ok(Run {
            machine,
            record: self.record,
            driven: self.driven,
            trains: by_trains(machine, moves)?,
            ticked: by_ticks(machine, moves)?,
            unshaped: unshaped(machine, self.record)?,
            motion: self.motion,
        })
    }
}

impl Run<'_> {
    /// How the tool swings without shaping, where its mode is known.
    #[must_use]
    pub fn unshaped(&self) -> Option<&Vibration> {
        self.unshaped.as_ref()?.vibration.as_ref()
    }
}

/// Moves a simulated machine by the steps of a [`StepLog`](crate::StepLog), and for comparison in
/// the other ways.
///
/// # Errors
/// The table cannot be read, or no platform is where its steps lead.
pub fn simulate<'a>(
    machine: &'a Machine,
    record: &'a Record,
    steps: impl BufRead,
) -> Result<Run<'a>> {
    drive(machine, record, steps)?.compared()
}

/// Moves a simulated machine by the steps of a [`StepLog`](crate::StepLog).
///
/// # Errors
/// The table cannot be read, or no platform is where its steps lead.
pub fn drive<'a>(
    machine: &'a Machine,
    record: &'a Record,
    steps: impl BufRead,
) -> Result<Drive<'a>> {
    let duration_s = seconds(record.duration_ticks());
    let mut motion = MotionSampler::new(machine.point([0; 3])?.into());
    let mut positions = MotionSampler::new([0.0; 3]);
    let mut follower = Follower::new(machine, &record.moves, record.motion)?;
    for position in step_log::read(steps) {
        let (t_s, position) = position?;
        motion.add(t_s, follower.follow(t_s, position)?.into());
        positions.add(t_s, position.map(f64::from));
    }
    motion.end(duration_s);
    positions.end(duration_s);
    let deviation_steps = match record.motion {
        Motion::Rounded => CUBIC_STEPS,
        Motion::Trains => TRAINS_STEPS,
    };
    Ok(Drive {
        machine,
        record,
        driven: follower.finish(duration_s, deviation_steps)?,
        motion,
        positions,
    })
}

/// The same machine and tool, not shaped.
fn unshaped(machine: &Machine, record: &Record) -> Result<Option<Driven>> {
    let (Some(elastic), Motion::Rounded) = (machine.elastic, record.motion) else {
        return Ok(None);
    };
    let mut plain = machine.clone();
    plain.elastic = Some(Elastic::unshaped(elastic));
    let mut again = Record::new(record.motion);
    again.moves.extend(record.moves.iter().map(|it| Move {
        curves_ticks: None,
        end_ticks: 0,
        ..*it
    }));
    let mut steps = Vec::new();
    rounded::run(&plain, &mut again, |ticks, position| {
        steps.push((ticks, position));
        Ok(())
    })?;
    let mut follower = Follower::new(&plain, &again.moves, record.motion)?;
    for (ticks, position) in steps {
        follower.follow(seconds(ticks), position)?;
    }
    let duration_s = seconds(again.duration_ticks());
    Ok(Some(follower.finish(duration_s, CUBIC_STEPS)?))
}

/// Each line at its feed from the first step to the last.
fn by_trains(machine: &Machine, moves: &[Move]) -> Result<Driven> {
    let mut follower = Follower::new(machine, moves, Motion::Trains)?;
    let (mut position, mut now) = ([0; 3], 0);
    for line in moves {
        let plan = Plan::new(machine, (line.from, position), line.to, line.feed_mm_s)?;
        now = plan.run(position, now, |ticks, position| {
            follower.follow(seconds(ticks), position).map(drop)
        })?;
        position = plan.end();
    }
    follower.finish(seconds(now), TRAINS_STEPS)
}

/// The thesis' controller.
fn by_ticks(machine: &Machine, moves: &[Move]) -> Result<Driven> {
    let mut follower = Follower::new(machine, moves, Motion::Trains)?;
    let mut now_s = 0.0;
    for position in control_tick::positions(moves.iter().map(|it| it.end)) {
        now_s += machine.tick_s;
        follower.follow(now_s, position)?;
    }
    follower.finish(now_s, TRAINS_STEPS)
}

/// The simulated machine on its way along the lines.
struct Follower<'a> {
    machine: &'a Machine,
    motion: Motion,
    /// That which it is on, and those after it.
    lines: &'a [Move],
    motors: Motors,
    tool: Option<Tool<3>>,
    last_s: f64,
    max_path_error_mm: f64,
    steps: u64,
    end: [i32; 3],
    path: Vec<Point3<f64>>,
}

impl<'a> Follower<'a> {
    fn new(machine: &'a Machine, lines: &'a [Move], motion: Motion) -> Result<Self> {
        Ok(Self {
            machine,
            motion,
            lines,
            motors: Motors::new(machine, motion == Motion::Rounded)?,
            tool: match &machine.elastic {
                Some(elastic) => Some(Tool::new(elastic, machine.point([0; 3])?.into())),
                None => None,
            },
            last_s: 0.0,
            max_path_error_mm: 0.0,
            steps: 0,
            end: [0; 3],
            path: vec![machine.point([0; 3])?],
        })
    }

    /// Takes it to a position at a time; returns where the platform is.
    fn follow(&mut self, t_s: f64, position: [i32; 3]) -> Result<Point3<f64>> {
        let moved = position.iter().zip(self.end);
        self.steps += moved.map(|(a, b)| u64::from(a.abs_diff(b))).sum::<u64>();
        self.end = position;
        self.motors.follow(self.machine, t_s, position)?;
        let point = self.machine.point(position)?;
        self.last_s = t_s;
        if let Some(tool) = &mut self.tool {
            tool.follow(t_s, point.into());
        }
        match self.motion {
            Motion::Rounded => self.follow_rounded(t_s, point),
            Motion::Trains => self.follow_lines(position, point),
        }
        let last = self.path.last();
        if last.is_none_or(|last| (point - last).norm() > SPACING_MM) {
            self.path.push(point);
        }
        Ok(point)
    }

    /// The nearest of the lines on which the curve that is run begins, passes or ends.
    fn follow_rounded(&mut self, t_s: f64, point: Point3<f64>) {
        let is_over = |line: &Move| line.curves_ticks.is_none_or(|[_, end]| seconds(end) < t_s);
        while self.lines.first().is_some_and(is_over) {
            self.lines = self.lines.get(1..).unwrap_or_default();
        }
        let has_begun = |line: &&Move| {
            line.curves_ticks
                .is_none_or(|[begin, _]| seconds(begin) <= t_s)
        };
        let near = self.lines.iter().take_while(has_begun);
        let near = near.filter(|line| !is_over(line));
        let off = near.map(|line| distance(point, line.from, line.to));
        let off = off.fold(f64::INFINITY, f64::min);
        if off.is_finite() {
            self.max_path_error_mm = self.max_path_error_mm.max(off);
        }
    }

    /// Each line to its very end.
    fn follow_lines(&mut self, position: [i32; 3], point: Point3<f64>) {
        while let [now, rest @ ..] = self.lines {
            let off = distance(point, now.from, now.to);
            self.max_path_error_mm = self.max_path_error_mm.max(off);
            if position != now.end {
                break;
            }
            self.lines = rest;
            // A line that asks for no step ends where the one before did.
            if rest.first().is_none_or(|next| next.end != position) {
                break;
            }
        }
    }

    fn finish(mut self, duration_s: f64, deviation_steps: f64) -> Result<Driven> {
        self.path.push(self.machine.point(self.end)?);
        Ok(Driven {
            max_path_error_mm: self.max_path_error_mm,
            duration_s,
            steps: self.steps,
            end: self.end,
            motors: self.motors.finish(self.machine, deviation_steps),
            vibration: self.tool.map(|mut tool| {
                tool.rest(self.last_s);
                tool.finish(self.last_s)
            }),
            path: self.path,
        })
    }
}

/// Distance of a point from the straight line between two others.
pub(crate) fn distance(point: Point3<f64>, from: Point3<f64>, to: Point3<f64>) -> f64 {
    let line = to - from;
    let square = line.norm_squared();
    let fraction = if square > 0.0 {
        ((point - from).dot(&line) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point - (from + line * fraction)).norm()
}
