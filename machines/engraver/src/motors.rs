//! What the emitted edges ask of the motors, and whether they follow.

use anyhow::Result;
use known_load::PoseLoad;
use machine_sim::{DrivenAxis, Followed, Motor, Rotor, StepSize};
use pattern_codec::engraving::{Axis, PerAxis};
use serde::Serialize;

use crate::load::ArmAndDisc;
use crate::machine::{JointScale, Machine};

/// What a step may be off its place on a train, a ramp or a cubic: some ticks.
const DEVIATION_STEPS: f64 = 0.01;

/// The source prints no motors; these are assumed: 0.4 N m on each axis, with the inertia of rotor
/// and gear.
const MOTOR: Motor = Motor {
    holding_torque_nm: 0.4,
    corner_speed_hz: 1000.0,
    inertia_kg_m2: 7.4e-6,
    friction_nm: 0.03,
    damping_ratio: 0.02,
    full_steps_per_turn: 240,
    microsteps: 2,
};
/// Each link of the arm, its mass evenly along it, and grinder with lift at the end of the forearm.
const LINK_KG: f64 = 0.4;
const TOOL_KG: f64 = 0.3;
/// The fork of the disc.
const FORK_KG_M2: f64 = 2e-6;
/// A carriage of 1 kg on 6 mm of pitch, and the screw.
const LIFT_KG_M2: f64 = 1.6e-6;

/// Motors of all axes, which get edges and nothing else.
#[derive(Debug, Clone)]
pub(crate) struct Motors {
    axes: PerAxis<DrivenAxis>,
    tick_s: f64,
    /// What shoulder, elbow and disc turn, which changes with the pose; where it is known.
    load: Option<PoseLoad<ArmAndDisc, 3>>,
}

impl Motors {
    /// Motors at home.
    pub(crate) fn new(machine: &Machine) -> Result<Self> {
        let [upper_m, fore_m] = [machine.arm.upper(), machine.arm.fore()].map(|mm| mm / 1000.0);
        // About each joint, the arm stretched: no pose has more.
        let stretched = upper_m + fore_m;
        let centre = upper_m + fore_m / 2.0;
        let fore_kg_m2 = fore_m * fore_m * (LINK_KG / 3.0 + TOOL_KG);
        let arm_kg_m2 = LINK_KG * (upper_m * upper_m / 3.0 + fore_m * fore_m / 12.0)
            + LINK_KG * centre * centre
            + TOOL_KG * stretched * stretched;
        let lift = Motor {
            inertia_kg_m2: MOTOR.inertia_kg_m2 + LIFT_KG_M2,
            ..MOTOR
        };
        let mut axes = PerAxis {
            elbow: DrivenAxis::new(motor(machine.elbow, fore_kg_m2)),
            shoulder: DrivenAxis::new(motor(machine.shoulder, arm_kg_m2)),
            disc: DrivenAxis::new(motor(machine.disc, FORK_KG_M2)),
            vertical: DrivenAxis::new(lift),
        };
        let mut load = None;
        if let Some(known) = machine.load {
            let [shoulder, elbow, disc] = known.motors.map(|motor| DrivenAxis::new(motor.motor));
            axes = PerAxis {
                elbow,
                shoulder,
                disc,
                vertical: axes.vertical,
            };
            let home = machine.angles_at(PerAxis::default());
            load = Some(PoseLoad::new(known, &home, rotors(&mut axes))?);
        }
        Ok(Self {
            axes,
            tick_s: machine.tick_s(),
            load,
        })
    }

    /// A step of an axis from a position: up for a number above 0, down for one below.
    pub(crate) fn step(
        &mut self,
        ticks: u64,
        (axis, direction): (Axis, i32),
        (machine, position): (&Machine, PerAxis<i32>),
    ) -> Result<()> {
        #[expect(clippy::cast_precision_loss, reason = "2^53 ticks are centuries")]
        let time_s = ticks as f64 * self.tick_s;
        if let Some(load) = &mut self.load {
            load.turn_until(time_s, &machine.angles_at(position), rotors(&mut self.axes))?;
        }
        self.axes.get_mut(axis).step(time_s, direction);
        Ok(())
    }

    /// What was seen of each when it has come to rest.
    pub(crate) fn finish(self, machine: &Machine) -> FollowedAxes {
        let joint = |axis: DrivenAxis, scale: JointScale| {
            let deg = scale.rad_per_pulse.to_degrees();
            axis.finish(DEVIATION_STEPS, StepSize::Degrees(deg))
        };
        let PerAxis {
            elbow,
            shoulder,
            disc,
            vertical,
        } = self.axes;
        let lift = StepSize::Millimetres(machine.settings.mm_per_vertical_pulse());
        FollowedAxes {
            elbow: joint(elbow, machine.elbow),
            shoulder: joint(shoulder, machine.shoulder),
            disc: joint(disc, machine.disc),
            vertical: vertical.finish(DEVIATION_STEPS, lift),
        }
    }
}

/// Of shoulder, elbow and disc.
fn rotors(axes: &mut PerAxis<DrivenAxis>) -> [&mut Rotor; 3] {
    [
        axes.shoulder.rotor_mut(),
        axes.elbow.rotor_mut(),
        axes.disc.rotor_mut(),
    ]
}

/// The motor of a joint with an inertia behind its gear.
fn motor(joint: JointScale, load_kg_m2: f64) -> Motor {
    let ratio = joint.gear_ratio;
    Motor {
        inertia_kg_m2: MOTOR.inertia_kg_m2 + load_kg_m2 / (ratio * ratio),
        microsteps: joint.microsteps,
        ..MOTOR
    }
}

/// What all motors were asked for, and what they lost.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct FollowedAxes {
    /// The joints behind their gears.
    elbow: Followed,
    shoulder: Followed,
    disc: Followed,
    vertical: Followed,
}

impl FollowedAxes {
    /// Of all motors.
    pub(crate) const fn lost_steps(&self) -> u64 {
        let joints = self.elbow.lost_steps + self.shoulder.lost_steps + self.disc.lost_steps;
        joints + self.vertical.lost_steps
    }

    /// Proven of either joint of the arm, in degrees a second.
    pub(crate) fn max_speed_jump_deg_s(&self) -> f64 {
        let [a, b] = [self.elbow, self.shoulder].map(|joint| joint.speed_jump.proven());
        a.max(b)
    }

    /// Proven of either joint of the arm, in deg/s².
    pub(crate) fn max_acceleration_deg_s2(&self) -> f64 {
        let joints = [self.elbow, self.shoulder];
        let [a, b] = joints.map(|joint| joint.acceleration.proven());
        a.max(b)
    }
}
