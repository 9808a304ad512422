//! What the emitted edges ask of the motors, whether they follow, and how the tables swing.

use anyhow::Result;
use known_load::{Tool, Vibration};
use machine_sim::{DrivenAxis, Followed, MotionSampler, Motor, StepSize};
use serde::Serialize;

use crate::grid::{FULL_STEPS_PER_TURN, MICROSTEPS, STEPS_PER_MM, seconds, to_mm, to_steps};
use crate::machine::Machine;
use crate::motion::Motion;
use crate::paths::{self, PathRule};

/// 0.4 N m on each axis. At the motor: the rotor 5.4, a screw of 12 mm by 200 mm 3.2, 5 kg of table
/// on 4 mm of pitch 2.0, in 1e-6 kg m²; friction of a preloaded nut.
const MOTOR: Motor = Motor {
    holding_torque_nm: 0.4,
    corner_speed_hz: 1000.0,
    inertia_kg_m2: 10.6e-6,
    friction_nm: 0.03,
    damping_ratio: 0.02,
    full_steps_per_turn: FULL_STEPS_PER_TURN,
    microsteps: MICROSTEPS,
};
/// What a step may be off its place on the programmed motion: 1 step off the curve, half along it.
const DEVIATION_STEPS: f64 = 1.5;

/// Both motors, and the tables that they move.
#[derive(Debug, Clone)]
pub(crate) struct Motors {
    axes: [DrivenAxis; 2],
    ticks: u64,
    at: [i32; 2],
    motion: MotionSampler<2>,
    /// Of X and Y, where it is known how they swing.
    tables: Option<[Tool<1>; 2]>,
}

impl Motors {
    /// At rest, with what the machine carries.
    pub(crate) fn new(machine: &Machine) -> Self {
        let motors = machine
            .load
            .map_or([MOTOR; 2], |load| load.motors.map(|motor| motor.motor));
        Self {
            axes: motors.map(DrivenAxis::new),
            ticks: 0,
            at: [0; 2],
            motion: MotionSampler::new([0.0; 2]),
            tables: machine
                .modes
                .map(|modes| modes.map(|mode| Tool::new(&mode, [0.0]))),
        }
    }

    /// A step of the path.
    pub(crate) fn step(&mut self, ticks: u64, by: [i32; 2]) {
        self.ticks = ticks;
        for ((axis, at), by) in self.axes.iter_mut().zip(&mut self.at).zip(by) {
            *at += by;
            if by != 0 {
                axis.step(seconds(ticks), by);
            }
        }
        let at = to_mm(self.at);
        let at = [at.x, at.y];
        self.motion.add(seconds(ticks), at);
        for (table, mm) in self.tables.iter_mut().flatten().zip(at) {
            table.follow(seconds(ticks), [mm]);
        }
    }

    /// What was seen of them, when they have come to rest.
    pub(crate) fn finish(mut self) -> FollowedAxes {
        self.motion.end(seconds(self.ticks));
        let step = StepSize::Millimetres(STEPS_PER_MM.recip());
        let [x, y] = self.axes.map(|axis| axis.finish(DEVIATION_STEPS, step));
        let end_s = seconds(self.ticks);
        FollowedAxes {
            duration_s: end_s,
            x,
            y,
            motion: self.motion,
            vibration: self.tables.map(|tables| {
                tables.map(|mut table| {
                    table.rest(end_s);
                    table.finish(end_s)
                })
            }),
        }
    }
}

/// What both motors were asked for, and what they lost.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct FollowedAxes {
    pub(crate) duration_s: f64,
    pub(crate) x: Followed,
    pub(crate) y: Followed,
    /// Of the path, in mm.
    #[serde(skip)]
    pub(crate) motion: MotionSampler<2>,
    /// Of the tables of X and Y, where it is known how they swing.
    #[serde(skip)]
    pub(crate) vibration: Option<[Vibration; 2]>,
}

impl FollowedAxes {
    /// What the same motions ask for at their feeds from the first step to the last.
    pub(crate) fn at_feed(machine: &Machine, motions: &[Motion], rule: PathRule) -> Result<Self> {
        let (mut motors, mut now) = (Motors::new(machine), 0);
        for motion in motions {
            for timed in paths::at_feed(motion, to_steps(motion.from), rule)? {
                let (ticks, step) = timed?;
                now += ticks;
                motors.step(now, [step.dx(), step.dy()]);
            }
        }
        Ok(motors.finish())
    }

    pub(crate) const fn lost_steps(&self) -> u64 {
        self.x.lost_steps + self.y.lost_steps
    }

    /// Proven of either axis.
    pub(crate) fn max_acceleration_mm_s2(&self) -> f64 {
        let [x, y] = [self.x, self.y].map(|axis| axis.acceleration.proven());
        x.max(y)
    }
}
