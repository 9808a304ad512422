//! What the page draws of the pins: edges of each axis, and the path of the tool over time.

use anyhow::{Context, Result};
use engraver::{Machine, Wires};
use nalgebra::Point3;
use pattern_codec::engraving::{Axis, PerAxis};
use stepper_sync::{Direction, Level};

use crate::answer::Answer;

/// Points of the drawn path are this far apart, in mm: a tenth of a pixel of a large screen.
const SPACING_MM: f64 = 0.02;

/// Wired to the controller's pins beside the simulated machine.
pub(crate) struct Recorder<'a> {
    machine: &'a Machine,
    tick_s: f64,
    edges: PerAxis<Vec<f64>>,
    steps: PerAxis<Vec<i8>>,
    direction: PerAxis<i8>,
    position: PerAxis<i32>,
    now: u64,
    has_moved: bool,
    /// Seconds, x, y, height above the depth of engraving in mm.
    path: Vec<f64>,
    last: Option<Point3<f64>>,
}

impl<'a> Recorder<'a> {
    pub(crate) fn new(machine: &'a Machine) -> Self {
        let rate = machine.timer().tick_rate();
        let mut recorder = Self {
            machine,
            tick_s: f64::from(rate.denominator()) / f64::from(rate.numerator()),
            edges: PerAxis::default(),
            steps: PerAxis::default(),
            direction: PerAxis {
                elbow: 1,
                shoulder: 1,
                disc: 1,
                vertical: 1,
            },
            position: PerAxis::default(),
            now: 0,
            has_moved: false,
            path: Vec::new(),
            last: None,
        };
        recorder.point();
        recorder
    }

    /// All edges before a tick are made.
    fn advance(&mut self, ticks: u64) {
        if ticks != self.now {
            if core::mem::take(&mut self.has_moved) {
                self.point();
            }
            self.now = ticks;
        }
    }

    /// Where the tool is, unless that is where it was.
    fn point(&mut self) {
        let tool = self.machine.tool(self.position);
        let is_near = |last: Point3<f64>| {
            (tool - last).norm() < SPACING_MM && (tool.z > 0.0) == (last.z > 0.0)
        };
        if !self.last.is_some_and(is_near) {
            let now = self.seconds(self.now);
            self.path.extend([now, tool.x, tool.y, tool.z]);
            self.last = Some(tool);
        }
    }

    fn seconds(&self, ticks: u64) -> f64 {
        ticks as f64 * self.tick_s
    }

    /// Ends the record at a tick.
    pub(crate) fn finish(mut self, ticks: u64) -> Recorded {
        self.advance(ticks);
        self.last = None;
        self.point();
        Recorded {
            edges: self.edges,
            steps: self.steps,
            path: self.path,
        }
    }
}

impl Wires for Recorder<'_> {
    fn direction(&mut self, ticks: u64, axis: Axis, direction: Direction) -> Result<()> {
        self.advance(ticks);
        *self.direction.get_mut(axis) = match direction {
            Direction::Positive => 1,
            Direction::Negative => -1,
        };
        Ok(())
    }

    fn step(&mut self, ticks: u64, axis: Axis, level: Level) -> Result<()> {
        self.advance(ticks);
        let now = self.seconds(ticks);
        self.edges.get_mut(axis).push(now);
        if level == Level::High {
            let by = *self.direction.get(axis);
            self.steps.get_mut(axis).push(by);
            let position = self.position.get_mut(axis);
            let moved = position.checked_add(by.into());
            *position = moved.with_context(|| format!("{axis} leaves 32 bits"))?;
            self.has_moved = true;
        }
        Ok(())
    }
}

/// Edges in seconds, low to high first; the step of each rising one; the path.
pub(crate) struct Recorded {
    edges: PerAxis<Vec<f64>>,
    steps: PerAxis<Vec<i8>>,
    path: Vec<f64>,
}

impl Recorded {
    pub(crate) fn add_to(self, answer: Answer) -> Answer {
        let mut answer = answer.with_numbers("path", self.path.iter().map(|it| it.to_le_bytes()));
        let names = [
            (Axis::Elbow, "elbow edges", "elbow steps"),
            (Axis::Shoulder, "shoulder edges", "shoulder steps"),
            (Axis::Disc, "disc edges", "disc steps"),
            (Axis::Vertical, "vertical edges", "vertical steps"),
        ];
        for (axis, edges, steps) in names {
            let times = self.edges.get(axis).iter().map(|it| it.to_le_bytes());
            let by = self.steps.get(axis).iter().map(|it| it.to_le_bytes());
            answer = answer.with_numbers(edges, times).with_numbers(steps, by);
        }
        answer
    }
}
