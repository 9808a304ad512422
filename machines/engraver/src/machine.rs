//! The machine: from its settings to checked geometry, steps and timing.

mod settings;

use anyhow::{Context, Result, bail, ensure};
use known_load::{Elastic, Transmission};
use nalgebra::{Isometry2, Point2};
use path_timing::ToolLimits;
use pattern_codec::engraving::{Format, PerAxis};
use pvt_steps::{Ramp, RampLimits};
use scara_kin::{Arm, JointRange, Joints, Limits, TangentTool};
use stepper_sync::{Rate, StepScale, Timer};

pub(crate) use self::settings::Settings;
use self::settings::{
    DiscSettings, JointSettings, RapidSettings, TimedSettings, TimerSettings, VerticalSettings,
};
use crate::load::Load;
use crate::numbers::{finite, positive};
use crate::placement::Bed;

/// The source prints pulses of 0.75 degrees; taken for half steps.
const FULL_STEP_DEG: f64 = 1.5;

/// The two joints of the arm as the steppers see them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointScale {
    pub(crate) rad_per_pulse: f64,
    pub(crate) home_rad: f64,
    pub(crate) gear_ratio: f64,
    /// Pulses of a full step of the motor.
    pub(crate) microsteps: u32,
    pub(crate) full_steps_per_turn: u32,
    scale: StepScale,
}

impl JointScale {
    fn new(step_deg: f64, gear_ratio: f64, home_deg: f64) -> Result<Self> {
        positive("step_deg", step_deg)?;
        positive("gear_ratio", gear_ratio)?;
        finite("home_deg", home_deg)?;
        let microsteps = (FULL_STEP_DEG / step_deg).max(1.0);
        let rad_per_pulse = step_deg.to_radians() / gear_ratio;
        let microsteps =
            whole(microsteps).with_context(|| format!("step_deg = {step_deg} is too fine"))?;
        let full_steps = 360.0 / (step_deg * f64::from(microsteps));
        Ok(Self {
            rad_per_pulse,
            home_rad: home_deg.to_radians(),
            gear_ratio,
            microsteps,
            full_steps_per_turn: whole(full_steps)
                .with_context(|| format!("step_deg = {step_deg} is no step of a motor"))?,
            scale: StepScale::new(rad_per_pulse.recip())?,
        })
    }

    /// The whole step nearest to an angle, counted from home.
    pub(crate) fn to_pulses(self, angle_rad: f64) -> Result<i32> {
        Ok(self.scale.to_steps(angle_rad - self.home_rad)?)
    }

    /// Pulses of a radian.
    pub(crate) const fn scale(self) -> StepScale {
        self.scale
    }

    /// The angle at a step.
    pub(crate) fn to_rad(self, pulses: i32) -> f64 {
        self.home_rad + f64::from(pulses) * self.rad_per_pulse
    }
}

/// The machine, checked: arm, steppers, timer, format of the pattern.
#[derive(Debug, Clone)]
pub struct Machine {
    pub(crate) settings: Settings,
    pub(crate) arm: Arm,
    pub(crate) elbow: JointScale,
    pub(crate) shoulder: JointScale,
    pub(crate) disc: JointScale,
    pub(crate) tangent: TangentTool,
    /// Pulses from home down into the glass.
    pub(crate) lift_pulses: i32,
    pub(crate) format: Format,
    pub(crate) timer: Timer,
    pub(crate) half_period_ticks: u64,
    pub(crate) rapid: RampLimits,
    pub(crate) bed: Bed,
    tool: ToolLimits,
    /// Of joints and disc in timed strokes.
    pub(crate) joint_accel_hz_per_s: f64,
    pub(crate) load: Option<Load>,
    pub(crate) elastic: Option<Elastic>,
}

impl Machine {
    /// Reads a machine file, as `machine.toml` of this package.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn parse(text: &str) -> Result<Self> {
        Self::check(machine_sim::input::parse_settings(text)?)
    }

    /// Where a drawing is fitted in.
    #[must_use]
    pub const fn bed(&self) -> Bed {
        self.bed
    }

    /// The controller's timer.
    #[must_use]
    pub const fn timer(&self) -> Timer {
        self.timer
    }

    fn check(settings: Settings) -> Result<Self> {
        let Settings {
            arm,
            elbow,
            shoulder,
            disc,
            vertical,
            timer,
            rapid,
            pattern,
            bed,
            timed,
            mode,
            ..
        } = &settings;
        let limits = Limits {
            shoulder: range(shoulder).context("[shoulder]")?,
            elbow: range(elbow).context("[elbow]")?,
        };
        let timing = timing(timer).context("[timer]")?;
        let rapid = ramp(rapid, timing.0).context("[rapid]")?;
        let joint_accel_hz_per_s = match timed.joint_accel_hz_per_s {
            Some(accel) => positive("joint_accel_hz_per_s", accel).map(|()| accel),
            None => Ok(f64::from(rapid.accel_steps_per_s2)),
        };
        let mut machine = Self {
            arm: Arm::new(arm.upper_mm, arm.fore_mm)
                .and_then(|checked| {
                    checked.with_base(Isometry2::translation(arm.base_x_mm, arm.base_y_mm))
                })
                .and_then(|checked| checked.with_limits(limits).with_keep_out(arm.keep_out_mm))
                .context("[arm]")?,
            elbow: joint(elbow).context("[elbow]")?,
            shoulder: joint(shoulder).context("[shoulder]")?,
            disc: JointScale::new(disc.step_deg, disc.gear_ratio, disc.home_deg)
                .context("[disc]")?,
            tangent: tangent_tool(disc).context("[disc]")?,
            lift_pulses: lift(vertical).context("[vertical]")?,
            format: Format::new()
                .with_axis_codes(pattern.axis_codes)
                .with_byte_order(pattern.byte_order),
            timer: timing.0,
            half_period_ticks: timing.1,
            rapid,
            bed: bed.check().context("[bed]")?,
            tool: tool(timed).context("[timed]")?,
            joint_accel_hz_per_s: joint_accel_hz_per_s.context("[timed]")?,
            load: None,
            elastic: match mode {
                Some(mode) => Some(mode.check("mode")?),
                None => None,
            },
            settings,
        };
        machine.load = machine.check_load()?;
        Ok(machine)
    }

    fn check_load(&self) -> Result<Option<Load>> {
        let Settings { load, torque, .. } = &self.settings;
        match (load, torque) {
            (Some(load), Some(torque)) => {
                let transmission = |joint: JointScale, max_speed| Transmission {
                    full_steps_per_turn: joint.full_steps_per_turn,
                    microsteps: joint.microsteps,
                    ratio: joint.gear_ratio,
                    max_speed,
                };
                let [shoulder, elbow, disc] = self.joint_speeds();
                let joints = [
                    transmission(self.shoulder, shoulder),
                    transmission(self.elbow, elbow),
                    transmission(self.disc, disc),
                ];
                Ok(Some(load.check(torque, &self.arm, joints)?))
            }
            (None, None) => Ok(None),
            (Some(_), None) => bail!("[load] without [torque]: neither or both are needed"),
            (None, Some(_)) => bail!("[torque] without [load]: neither or both are needed"),
        }
    }

    /// The same machine and tool, not shaped; none where nothing is shaped.
    pub(crate) fn unshaped(&self) -> Option<Self> {
        let elastic = self.elastic?;
        Some(Self {
            elastic: Some(elastic.unshaped()),
            ..self.clone()
        })
    }

    /// Sharper corners are passed with the disc lifted, in radians.
    pub(crate) const fn corner_rad(&self) -> f64 {
        self.settings.corner_rad()
    }

    /// Feed and acceleration of the tool in timed strokes.
    pub(crate) const fn tool_limits(&self) -> ToolLimits {
        self.tool
    }

    /// A tick of the timer, in seconds.
    pub(crate) fn tick_s(&self) -> f64 {
        let rate = self.timer.tick_rate();
        f64::from(rate.denominator()) / f64::from(rate.numerator())
    }

    /// The arm's joints at a position of the steppers.
    pub(crate) fn joints(&self, position: PerAxis<i32>) -> Joints {
        Joints::new(
            self.shoulder.to_rad(position.shoulder),
            self.elbow.to_rad(position.elbow),
        )
    }

    /// Shoulder, elbow and disc at a position of the steppers, in radians.
    pub(crate) fn angles_at(&self, position: PerAxis<i32>) -> [f64; 3] {
        [
            self.shoulder.to_rad(position.shoulder),
            self.elbow.to_rad(position.elbow),
            self.disc.to_rad(position.disc),
        ]
    }

    /// How far the tool can be from where rounding to whole steps has it, in mm: half a
    /// step of each joint through the Jacobian at the tool's position, and the second order.
    pub(crate) fn half_step_mm(&self, tool: Point2<f64>) -> f64 {
        let (upper, fore) = (self.arm.upper(), self.arm.fore());
        let shoulder = self.shoulder.rad_per_pulse / 2.0;
        let elbow = self.elbow.rad_per_pulse / 2.0;
        let curved = upper * shoulder.powi(2) + fore * (shoulder + elbow).powi(2);
        let from_base = (tool.coords - self.arm.base().translation.vector).norm();
        shoulder * from_base + elbow * fore + curved / 2.0
    }
}

fn joint(settings: &JointSettings) -> Result<JointScale> {
    let range = settings.min_deg..=settings.max_deg;
    ensure!(
        range.contains(&settings.home_deg),
        "home_deg = {} is not within min_deg..=max_deg, {range:?}",
        settings.home_deg
    );
    JointScale::new(settings.step_deg, settings.gear_ratio, settings.home_deg)
}

fn tangent_tool(settings: &DiscSettings) -> Result<TangentTool> {
    ensure!(
        settings.corner_deg.is_finite(),
        "corner_deg = {} is not finite; 180 lifts at no corner",
        settings.corner_deg
    );
    let corner = TangentTool::new(settings.corner_deg.to_radians());
    let disc = corner.with_context(|| format!("corner_deg = {}", settings.corner_deg))?;
    let home = disc.starting_at(settings.home_deg.to_radians());
    home.with_context(|| format!("home_deg = {}", settings.home_deg))
}

fn range(settings: &JointSettings) -> Result<JointRange> {
    let (min, max) = (settings.min_deg, settings.max_deg);
    JointRange::new(min.to_radians(), max.to_radians())
        .with_context(|| format!("min_deg = {min}, max_deg = {max}"))
}

fn lift(settings: &VerticalSettings) -> Result<i32> {
    positive("mm_per_pulse", settings.mm_per_pulse)?;
    positive("lift_mm", settings.lift_mm)?;
    let pulses = StepScale::new(settings.mm_per_pulse.recip())?.to_steps(settings.lift_mm)?;
    ensure!(
        pulses > 0,
        "lift_mm = {} is less than half a pulse",
        settings.lift_mm
    );
    Ok(pulses)
}

fn tool(settings: &TimedSettings) -> Result<ToolLimits> {
    positive("feed_mm_s", settings.feed_mm_s)?;
    positive("accel_mm_s2", settings.accel_mm_s2)?;
    Ok(ToolLimits {
        feed: settings.feed_mm_s,
        acceleration: Some(settings.accel_mm_s2),
    })
}

fn timing(settings: &TimerSettings) -> Result<(Timer, u64)> {
    let timer = Timer::mcs51_mode1(settings.crystal_hz).context("crystal_hz")?;
    let rate = Rate::from_millihertz(millihertz("process_hz", settings.process_hz)?)?;
    let ticks = timer.half_period(rate).context("process_hz")?.nearest();
    Ok((timer, ticks))
}

fn ramp(settings: &RapidSettings, timer: Timer) -> Result<RampLimits> {
    let accel = settings.accel_hz_per_s;
    let limits = RampLimits {
        start_millihertz: millihertz("start_hz", settings.start_hz)?,
        max_millihertz: millihertz("max_hz", settings.max_hz)?,
        accel_steps_per_s2: whole(accel)
            .with_context(|| format!("accel_hz_per_s = {accel} is not within 1..=2147483647"))?,
    };
    // Whether the rates fit each other and the timer, before anything is planned.
    Ramp::new([1], &limits, timer.tick_rate())?;
    Ok(limits)
}

fn millihertz(name: &str, hz: f64) -> Result<u32> {
    whole(hz * 1000.0).with_context(|| format!("{name} = {hz} is not within 0.001..=2147483 Hz"))
}

/// A number above zero that 31 bits hold, rounded.
fn whole(value: f64) -> Option<u32> {
    let whole = StepScale::new(1.0).ok()?.to_steps(value).ok()?;
    u32::try_from(whole).ok().filter(|whole| *whole > 0)
}
