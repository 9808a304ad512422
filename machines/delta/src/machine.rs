//! The machine: from its settings in TOML to checked numbers.

use anyhow::{Context, Result, bail, ensure};
use delta_kin::{Arm, ArmGeometry, ArmRange, Delta, Dimensions, InverseError, SpeedLimits};
use known_load::{Elastic, ModeSettings, MotorSettings};
use machine_sim::input::parse_settings;
use nalgebra::{Point3, Vector3};
use path_timing::AxisLimits;
use serde::Deserialize;
use stepper_sync::StepScale;

use crate::load::{Drive, Load, LoadSettings};

/// The settings, as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    base_mm: f64,
    platform_mm: f64,
    upper_mm: f64,
    lower_mm: f64,
    #[serde(alias = "max_lean_deg")]
    max_swivel_deg: Option<f64>,
    motor: Motor,
    path: PathSettings,
    #[serde(default)]
    arm: Vec<Deviation>,
    load: Option<LoadSettings>,
    torque: Option<MotorSettings>,
    mode: Option<ModeSettings>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Motor {
    step_deg: f64,
    microsteps: u32,
    gear_ratio: f64,
    home_deg: f64,
    min_deg: f64,
    max_deg: f64,
    max_rate_deg_s: f64,
    #[serde(default = "Motor::default_acceleration_deg_s2")]
    max_acceleration_deg_s2: f64,
}

impl Motor {
    const fn default_acceleration_deg_s2() -> f64 {
        3000.0
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PathSettings {
    feed_mm_s: f64,
    #[serde(default = "PathSettings::default_acceleration_mm_s2")]
    acceleration_mm_s2: f64,
    #[serde(default = "PathSettings::default_corner_mm")]
    corner_mm: f64,
    tolerance_mm: f64,
    tick_ms: f64,
}

impl PathSettings {
    const fn default_acceleration_mm_s2() -> f64 {
        3000.0
    }

    const fn default_corner_mm() -> f64 {
        1.0
    }
}

/// What an arm differs by from the drawing.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Deviation {
    pub(crate) azimuth_deg: f64,
    pub(crate) base_mm: f64,
    pub(crate) platform_mm: f64,
    pub(crate) upper_mm: f64,
    pub(crate) lower_mm: f64,
    pub(crate) home_deg: f64,
}

/// The checked machine. Its angles read zero at home, as the steps do.
#[derive(Debug, Clone)]
pub struct Machine {
    pub(crate) delta: Delta,
    pub(crate) deviations: [Deviation; 3],
    pub(crate) rad_per_step: f64,
    pub(crate) scale: StepScale,
    pub(crate) microsteps: u32,
    pub(crate) max_rate_rad_s: f64,
    pub(crate) max_acceleration_rad_s2: f64,
    pub(crate) feed_mm_s: f64,
    pub(crate) acceleration_mm_s2: f64,
    /// By what corners may be rounded.
    pub(crate) corner_mm: f64,
    pub(crate) tolerance_mm: f64,
    pub(crate) tick_s: f64,
    pub(crate) load: Option<Load>,
    pub(crate) elastic: Option<Elastic>,
}

impl Machine {
    /// Reads a machine, as in [`MACHINE`](crate::MACHINE).
    ///
    /// # Errors
    /// A mistake with its line and column, a number that no machine has, or a home that the
    /// machine cannot be in.
    pub fn parse(text: &str) -> Result<Self> {
        Self::check(&parse_settings(text)?)
    }

    fn check(settings: &Settings) -> Result<Self> {
        let Settings { motor, path, .. } = settings;
        for (name, value) in [
            ("step_deg", motor.step_deg),
            ("gear_ratio", motor.gear_ratio),
            ("max_rate_deg_s", motor.max_rate_deg_s),
            ("max_acceleration_deg_s2", motor.max_acceleration_deg_s2),
            ("feed_mm_s", path.feed_mm_s),
            ("acceleration_mm_s2", path.acceleration_mm_s2),
            ("corner_mm", path.corner_mm),
            ("tolerance_mm", path.tolerance_mm),
            ("tick_ms", path.tick_ms),
        ] {
            ensure!(
                value.is_finite() && value > 0.0,
                "{name} = {value} is not above zero"
            );
        }
        ensure!(motor.microsteps > 0, "microsteps = 0 is not above zero");
        let rad_per_step =
            motor.step_deg.to_radians() / f64::from(motor.microsteps) / motor.gear_ratio;
        let mut deviations = [Deviation::default(); 3];
        for (deviation, arm) in deviations.iter_mut().zip(&settings.arm) {
            *deviation = *arm;
        }
        let delta = settings.delta()?;
        let max_rate_rad_s = motor.max_rate_deg_s.to_radians();
        let load = match (&settings.load, &settings.torque) {
            (Some(load), Some(torque)) => {
                let drive = Drive {
                    step_deg: motor.step_deg,
                    microsteps: motor.microsteps,
                    gear_ratio: motor.gear_ratio,
                    max_rate_deg_s: motor.max_rate_deg_s,
                };
                Some(load.check(torque, &delta, drive)?)
            }
            (None, None) => None,
            (Some(_), None) => bail!("[load] without [torque]: neither or both are needed"),
            (None, Some(_)) => bail!("[torque] without [load]: neither or both are needed"),
        };
        let machine = Self {
            delta,
            deviations,
            rad_per_step,
            scale: StepScale::new(rad_per_step.recip())?,
            microsteps: motor.microsteps,
            max_rate_rad_s,
            max_acceleration_rad_s2: motor.max_acceleration_deg_s2.to_radians(),
            feed_mm_s: path.feed_mm_s,
            acceleration_mm_s2: path.acceleration_mm_s2,
            corner_mm: path.corner_mm,
            tolerance_mm: path.tolerance_mm,
            tick_s: path.tick_ms / 1000.0,
            load,
            elastic: match &settings.mode {
                Some(mode) => Some(mode.check("mode")?),
                None => None,
            },
        };
        // The platform must be somewhere when the arms are at home, and the arms within their
        // limits there.
        let home = machine.point([0; 3]).context("home_deg")?;
        machine.delta.inverse(home).context("home_deg")?;
        ensure!(
            path.tolerance_mm > machine.delta.tolerance(),
            "tolerance_mm = {:e} is not above the rounding {:e}",
            path.tolerance_mm,
            machine.delta.tolerance()
        );
        Ok(machine)
    }

    /// Its geometry.
    #[must_use]
    pub const fn geometry(&self) -> &Delta {
        &self.delta
    }

    /// What an arm's rate may be, and its acceleration, in deg/s and deg/s².
    #[must_use]
    pub const fn max_rate_and_acceleration(&self) -> [f64; 2] {
        [
            self.max_rate_rad_s.to_degrees(),
            self.max_acceleration_rad_s2.to_degrees(),
        ]
    }

    /// The theta of each arm at home, in radians from straight down.
    pub(crate) fn home_rad(&self) -> [f64; 3] {
        self.delta.arms().map(|arm| arm.zero)
    }

    /// The whole steps nearest to angles.
    pub(crate) fn steps(&self, angles: Vector3<f64>) -> Result<[i32; 3]> {
        let [a, b, c] = angles.into();
        Ok([
            self.scale.to_steps(a)?,
            self.scale.to_steps(b)?,
            self.scale.to_steps(c)?,
        ])
    }

    /// The angles at whole steps.
    pub(crate) fn angles(&self, steps: [i32; 3]) -> Vector3<f64> {
        Vector3::from(steps.map(|steps| f64::from(steps) * self.rad_per_step))
    }

    /// The angles that bring the platform to a point; a range that does not hold one is named as
    /// the machine file has it.
    pub(crate) fn angles_at(&self, point: Point3<f64>) -> Result<Vector3<f64>> {
        let angles = self.delta.inverse(point);
        if let Err(InverseError::JointLimit {
            arm,
            angle,
            min,
            max,
        }) = angles
        {
            let index = usize::from(arm.number()) - 1;
            let zero = self.home_rad().get(index).copied().unwrap_or_default();
            let [angle, min, max] = [angle, min, max].map(|angle| (angle + zero).to_degrees());
            bail!(
                "{arm} would have to turn to {angle:.2} deg, outside min_deg = {min:.2} to \
                 max_deg = {max:.2}"
            );
        }
        Ok(angles?)
    }

    /// Where the platform is.
    pub(crate) fn point(&self, steps: [i32; 3]) -> Result<Point3<f64>> {
        Ok(self.delta.forward(self.angles(steps))?)
    }

    /// Of each arm, in rad and s.
    pub(crate) const fn axis_limits(&self) -> [AxisLimits; 3] {
        [AxisLimits {
            speed: self.max_rate_rad_s,
            acceleration: self.max_acceleration_rad_s2,
            jerk: None,
        }; 3]
    }

    /// By what lines are smoothed: what shaping will leave of `corner_mm`.
    pub(crate) fn rounded_mm(&self) -> Result<f64> {
        let shaped = self.elastic.map_or(0.0, |elastic| {
            elastic.shaper.departure(self.acceleration_mm_s2)
        });
        ensure!(
            shaped < self.corner_mm,
            "corner_mm = {} leaves nothing for corners: the shaper of [mode] takes {shaped:.3} mm",
            self.corner_mm
        );
        Ok(self.corner_mm - shaped)
    }

    pub(crate) fn speed_limits(&self, feed_mm_s: f64) -> Result<SpeedLimits> {
        Ok(SpeedLimits::new(feed_mm_s, [self.max_rate_rad_s; 3])?)
    }
}

impl Settings {
    fn delta(&self) -> Result<Delta> {
        ensure!(
            matches!(self.arm.len(), 0 | 3),
            "{} tables [[arm]], none or three are needed",
            self.arm.len()
        );
        let (base, platform) = (self.base_mm, self.platform_mm);
        let mut arms = Arm::ALL.map(|arm| {
            ArmGeometry::nominal(
                arm,
                Dimensions {
                    base,
                    platform,
                    upper: self.upper_mm,
                    lower: self.lower_mm,
                },
            )
        });
        for arm in &mut arms {
            arm.zero = self.motor.home_deg.to_radians();
        }
        for (arm, off) in arms.iter_mut().zip(&self.arm) {
            arm.azimuth += off.azimuth_deg.to_radians();
            arm.base += off.base_mm;
            arm.platform += off.platform_mm;
            arm.upper += off.upper_mm;
            arm.lower += off.lower_mm;
            arm.zero += off.home_deg.to_radians();
        }
        // An angle that is none is named before the ranges that are counted from it.
        let delta = Delta::from_arms(arms)?;
        let (min, max) = (self.motor.min_deg, self.motor.max_deg);
        let range = |zero: f64| {
            ArmRange::new(min.to_radians() - zero, max.to_radians() - zero)
                .with_context(|| format!("min_deg = {min}, max_deg = {max}"))
        };
        let [first, second, third] = arms.map(|arm| arm.zero);
        let ranges = [range(first)?, range(second)?, range(third)?];
        let delta = delta.with_ranges(ranges);
        match self.max_swivel_deg {
            Some(swivel) => delta
                .with_ball_joints(swivel.to_radians())
                .with_context(|| format!("max_swivel_deg = {swivel}")),
            None => Ok(delta),
        }
    }
}
