//! What a person sets for an arm of their own.

use path_timing::AxisLimits;
use pulse_interp::HomingSettings;
use pvt_steps::{KnotError, MinIntervals, Rate, RateError, ScaleError, StepDirTiming, StepScale};
use scara_kin::{Arm, Elbow, GeometryError, JointRange, Limits};
use thiserror::Error;

/// An arm, its motors and their drivers. Arrays have the shoulder's value first, then the elbow's.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Lengths of upper arm and forearm, in mm.
    pub links_mm: [f64; 2],
    /// The side that the elbow is on.
    pub elbow: Elbow,
    /// Angles that each joint may take, in degrees.
    pub ranges_deg: [[f64; 2]; 2],
    /// Steps of a turn of each joint; negative for a motor that turns the other way.
    pub steps_per_turn: [f64; 2],
    /// What the driver chips ask of their pins.
    pub driver: StepDirTiming,
    /// Largest speed of each joint, in degrees/s.
    pub speed_deg_s: [f64; 2],
    /// Largest acceleration of each joint, in degrees/s².
    pub acceleration_deg_s2: [f64; 2],
    /// The most by which the tool may leave a line at a constant feed, in mm.
    pub tolerance_mm: f64,
    /// Where each joint is when its home switch has just closed, in degrees.
    pub home_deg: [f64; 2],
    /// How each joint finds its switch. Directions are those of positive steps.
    pub homing: [HomingSettings; 2],
    /// Steps a second on the way to the switch and back.
    pub homing_fast_hz: u32,
    /// Steps a second on the last way to the switch.
    pub homing_slow_hz: u32,
}

/// Why settings are refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum SettingsError {
    /// Links or ranges.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// A range that does not have the home position in it.
    #[error("joint {joint}: home at {home_deg} degrees is out of its range")]
    Home {
        /// 0 for the shoulder, 1 for the elbow.
        joint: usize,
        /// The angle given.
        home_deg: f64,
    },
    /// A joint that would step faster than its driver takes steps, at the largest speed.
    #[error(
        "joint {joint}: {steps_s:.0} steps a second at the largest speed, {max_s:.0} are possible"
    )]
    TooFast {
        /// 0 for the shoulder, 1 for the elbow.
        joint: usize,
        /// Steps a second.
        steps_s: f64,
        /// The most that driver and ticks allow.
        max_s: f64,
    },
    /// A tolerance that nothing can be within.
    #[error("a tolerance of {tolerance_mm} mm")]
    Tolerance {
        /// The tolerance given.
        tolerance_mm: f64,
    },
    /// Homing that steps not at all or faster than the driver takes steps.
    #[error("homing at {hz} steps a second")]
    Homing {
        /// Steps a second.
        hz: u32,
    },
    /// Steps of a turn.
    #[error(transparent)]
    Scale(#[from] ScaleError),
    /// Ticks a second.
    #[error(transparent)]
    Rate(#[from] RateError),
    /// Home.
    #[error(transparent)]
    Knot(#[from] KnotError),
}

/// A machine with [`Settings`] that are checked, in the units of the crates.
#[derive(Clone, Debug)]
pub struct Machine {
    pub(crate) arm: Arm,
    pub(crate) elbow: Elbow,
    pub(crate) scales: [StepScale; 2],
    pub(crate) rate: Rate,
    pub(crate) tick_hz: u32,
    pub(crate) pins: PinTicks,
    pub(crate) limits: [AxisLimits; 2],
    pub(crate) tolerance_mm: f64,
    pub(crate) home: [f64; 2],
    pub(crate) homing: [HomingSettings; 2],
    pub(crate) homing_fast_ticks: u32,
    pub(crate) homing_slow_ticks: u32,
}

/// A driver's times in ticks, each rounded up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PinTicks {
    /// From a change of direction to the pulse.
    pub(crate) setup: u64,
    /// From the start of a pulse to its end.
    pub(crate) pulse: u64,
    /// From the start of a pulse to the next one.
    pub(crate) step: u64,
    /// The same where the direction changes in between.
    pub(crate) reversal: u64,
}

impl PinTicks {
    fn new(driver: StepDirTiming, tick_hz: u32) -> Self {
        let ticks = |ns: u32| {
            let ticks = u64::from(ns) * u64::from(tick_hz);
            ticks.div_ceil(1_000_000_000).max(1)
        };
        let [pulse, pause] = [driver.pulse_ns, driver.pause_ns].map(ticks);
        let [setup, hold] = [driver.setup_ns, driver.hold_ns].map(ticks);
        // All pins of a step have changed before the next step begins.
        let step = pulse + pause.max(setup + 1);
        Self {
            setup,
            pulse,
            step,
            reversal: step.max(hold + setup),
        }
    }

    pub(crate) const fn min_intervals(self) -> MinIntervals {
        MinIntervals {
            step_ticks: self.step,
            reversal_ticks: self.reversal,
        }
    }

    /// The most steps a second that [`pvt_steps::PvtSteps`] makes with these intervals.
    fn max_steps_s(self, tick_hz: u32) -> f64 {
        // Two ticks for the rounding of two steps, one for that of the speed's limit.
        f64::from(tick_hz) / (self.step + 3) as f64
    }
}

impl Machine {
    /// A machine whose pins change at ticks of `tick_hz`.
    ///
    /// # Errors
    /// [`SettingsError`].
    pub fn new(settings: &Settings, tick_hz: u32) -> Result<Self, SettingsError> {
        let [upper, fore] = settings.links_mm;
        let [shoulder, elbow] = settings.ranges_deg.map(|[min, max]| {
            JointRange::new(min.to_radians(), max.to_radians()).map_err(SettingsError::Geometry)
        });
        let limits = Limits {
            shoulder: shoulder?,
            elbow: elbow?,
        };
        let arm = Arm::new(upper, fore)?.with_limits(limits);
        let home = settings.home_deg.map(f64::to_radians);
        let ranges = [limits.shoulder, limits.elbow];
        if let Some(joint) = (0..2).find(|&joint| !ranges[joint].contains(home[joint])) {
            let home_deg = settings.home_deg[joint];
            return Err(SettingsError::Home { joint, home_deg });
        }
        let pins = PinTicks::new(settings.driver, tick_hz);
        let max_s = pins.max_steps_s(tick_hz);
        let steps_s = |joint: usize| {
            (settings.speed_deg_s[joint] / 360.0 * settings.steps_per_turn[joint]).abs()
        };
        let is_too_fast = |&joint: &usize| steps_s(joint) > max_s || steps_s(joint).is_nan();
        if let Some(joint) = (0..2).find(is_too_fast) {
            let steps_s = steps_s(joint);
            return Err(SettingsError::TooFast {
                joint,
                steps_s,
                max_s,
            });
        }
        let tolerance_mm = settings.tolerance_mm;
        if tolerance_mm.is_nan() || tolerance_mm < 0.0 {
            return Err(SettingsError::Tolerance { tolerance_mm });
        }
        let homing_ticks = |hz: u32| {
            let ticks = tick_hz.checked_div(hz);
            ticks
                .filter(|&ticks| u64::from(ticks) > pins.reversal + pins.setup)
                .ok_or(SettingsError::Homing { hz })
        };
        let [first, second] = settings
            .steps_per_turn
            .map(|steps| StepScale::new(steps / core::f64::consts::TAU));
        let axis = |joint: usize| AxisLimits {
            speed: settings.speed_deg_s[joint].to_radians(),
            acceleration: settings.acceleration_deg_s2[joint].to_radians(),
            jerk: None,
        };
        Ok(Self {
            arm,
            elbow: settings.elbow,
            scales: [first?, second?],
            rate: Rate::from_hz(tick_hz)?,
            tick_hz,
            pins,
            limits: [axis(0), axis(1)],
            tolerance_mm,
            home,
            homing: settings.homing,
            homing_fast_ticks: homing_ticks(settings.homing_fast_hz)?,
            homing_slow_ticks: homing_ticks(settings.homing_slow_hz)?,
        })
    }

    pub(crate) const fn ranges(&self) -> [JointRange; 2] {
        let Limits { shoulder, elbow } = *self.arm.limits();
        [shoulder, elbow]
    }
}
