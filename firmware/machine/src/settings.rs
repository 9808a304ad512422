//! What a person sets for a machine of their own.

use path_timing::AxisLimits;
use pulse_interp::HomingSettings;
use pvt_steps::{MinIntervals, Rate, StepDirTiming, StepScale};

use crate::kinematics::{Axis, Kinematics, Unit};
use crate::scales::ScaleLoop;
use crate::settings_error::SettingsError;

/// A machine with N axes, its motors and their drivers.
pub struct Settings<K: Kinematics<N>, const N: usize> {
    /// Of the machine as a whole.
    pub geometry: K::Geometry,
    /// Of each axis, in the order of the pins.
    pub axes: [K::Axis; N],
    /// What the driver chips ask of their pins.
    pub driver: StepDirTiming,
    /// The most by which the tool may leave a line or an arc at a constant feed, in mm.
    pub tolerance_mm: f64,
    /// Steps a second on the way to the switches and back.
    pub homing_fast_hz: u32,
    /// Steps a second on the last way to a switch.
    pub homing_slow_hz: u32,
}

/// A machine with [`Settings`] that are checked, in the units of the crates: radians or mm.
#[derive(Clone, Debug)]
pub struct Machine<K, const N: usize> {
    pub(crate) kinematics: K,
    pub(crate) ranges: [[f64; 2]; N],
    pub(crate) scales: [StepScale; N],
    pub(crate) rate: Rate,
    pub(crate) tick_hz: u32,
    pub(crate) pins: PinTicks,
    pub(crate) limits: [AxisLimits; N],
    pub(crate) tolerance_mm: f64,
    pub(crate) home: [f64; N],
    pub(crate) loops: [Option<ScaleLoop>; N],
    pub(crate) homing: [HomingSettings; N],
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

impl<K: Kinematics<N>, const N: usize> Machine<K, N> {
    /// What its axes are shown in.
    pub(crate) const UNIT: Unit = K::Axis::UNIT;

    /// A machine whose pins change at ticks of `tick_hz`.
    ///
    /// # Errors
    /// [`SettingsError`].
    pub fn new(settings: &Settings<K, N>, tick_hz: u32) -> Result<Self, SettingsError> {
        let pins = PinTicks::new(settings.driver, tick_hz);
        for (name, axis) in K::AXES.into_iter().zip(&settings.axes) {
            check_axis(name, axis, pins.max_steps_s(tick_hz))?;
        }
        let computed = |value| Self::UNIT.computed(value);
        let axes = &settings.axes;
        let ranges = axes.map(|axis| axis.range().map(computed));
        let home = axes.map(|axis| computed(axis.home()));
        let kinematics = K::new(&settings.geometry, ranges)?;
        if kinematics.tool_mm(home).is_err() || kinematics.check(home).is_err() {
            return Err(SettingsError::NoHome);
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
        let mut scales = [StepScale::new(1.0)?; N];
        for (scale, axis) in scales.iter_mut().zip(axes) {
            *scale = StepScale::new(axis.steps_per_unit())?;
        }
        let mut loops = [None; N];
        for ((place, axis), name) in loops.iter_mut().zip(axes).zip(K::AXES) {
            let closed = axis
                .scale()
                .map(|scale| ScaleLoop::new(scale, axis.steps_s()));
            *place = closed
                .transpose()
                .map_err(|error| SettingsError::Loop { axis: name, error })?;
        }
        Ok(Self {
            kinematics,
            ranges,
            scales,
            rate: Rate::from_hz(tick_hz)?,
            tick_hz,
            pins,
            limits: axes.map(|axis| AxisLimits {
                speed: computed(axis.speed()),
                acceleration: computed(axis.acceleration()),
                jerk: None,
            }),
            tolerance_mm,
            home,
            loops,
            homing: axes.map(|axis| axis.homing()),
            homing_fast_ticks: homing_ticks(settings.homing_fast_hz)?,
            homing_slow_ticks: homing_ticks(settings.homing_slow_hz)?,
        })
    }
}

impl<K, const N: usize> Machine<K, N> {
    /// Whether the settings name the scale of an axis.
    pub(crate) fn has_scales(&self) -> bool {
        self.loops.iter().any(Option::is_some)
    }
}

/// Whether an axis has a range with home in it, and is not too fast for its driver.
fn check_axis<A: Axis>(name: &'static str, axis: &A, max_s: f64) -> Result<(), SettingsError> {
    let ([min, max], home, steps_s) = (axis.range(), axis.home(), axis.steps_s());
    // Written so that NaN is refused too.
    let is_range = min < max && min.is_finite() && max.is_finite();
    if !is_range {
        return Err(SettingsError::Range {
            axis: name,
            min,
            max,
        });
    }
    if !(min..=max).contains(&home) {
        return Err(SettingsError::Home {
            axis: name,
            home,
            unit: A::UNIT.name(),
        });
    }
    if steps_s > max_s || steps_s.is_nan() {
        return Err(SettingsError::TooFast {
            axis: name,
            steps_s,
            max_s,
        });
    }
    Ok(())
}
