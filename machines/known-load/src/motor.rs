//! Stepping motors with their gears or screws, as written and as their axes feel them.

use core::f64::consts::TAU;

use anyhow::{Context, Result, ensure};
use machine_sim::Motor;
use path_timing::TorqueCurve;
use serde::{Deserialize, Serialize};

/// Of a pull-out curve that is reckoned.
const SPEEDS: u32 = 15;
/// How far a curve goes beyond the largest speed, at least: what is proven of a segment is proven
/// for a speed that is a little higher, and beyond its curve a motor has nothing.
const BEYOND: f64 = 1.01;

/// `[torque]`, as written: at the shaft of a motor.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct MotorSettings {
    holding_torque_nm: f64,
    corner_speed_hz: f64,
    rotor_kg_m2: f64,
    friction_nm: f64,
    damping_ratio: f64,
    #[serde(default)]
    pull_out: Vec<[f64; 2]>,
    reserve: f64,
}

/// How a motor moves its axis, which turns in radians or slides in metres.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct Transmission {
    /// Of the motor.
    pub full_steps_per_turn: u32,
    /// In a full step.
    pub microsteps: u32,
    /// Radians of the motor for a radian or a metre of the axis.
    pub ratio: f64,
    /// Of the axis, in rad/s or m/s.
    pub max_speed: f64,
}

/// A motor at its axis.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct AxisMotor {
    /// At its shaft, with the rotor alone.
    pub motor: Motor,
    /// Radians of the motor for a radian or a metre of the axis.
    pub ratio: f64,
    /// What is planned of it: Nm over rad/s or N over m/s of the axis.
    pub curve: TorqueCurve,
    /// A straight line below that. Where an axis has a constant inertia, what several motions keep,
    /// a mean of them keeps then: a shaped one.
    pub straight: TorqueCurve,
}

impl MotorSettings {
    /// The part of the torque that is not planned.
    #[must_use]
    pub const fn reserve(&self) -> f64 {
        self.reserve
    }

    /// What the rotor weighs at its axis, in kg m² or kg.
    ///
    /// # Errors
    /// A number that no motor has, by its name.
    pub fn rotor_at_axis(&self, ratio: f64) -> Result<f64> {
        self.check()?;
        Ok(self.rotor_kg_m2 * ratio * ratio)
    }

    fn check(&self) -> Result<()> {
        for (name, value) in [
            ("holding_torque_nm", self.holding_torque_nm),
            ("corner_speed_hz", self.corner_speed_hz),
            ("rotor_kg_m2", self.rotor_kg_m2),
        ] {
            ensure!(
                value.is_finite() && value > 0.0,
                "[torque] {name} = {value} is not above zero"
            );
        }
        for (name, value) in [
            ("friction_nm", self.friction_nm),
            ("damping_ratio", self.damping_ratio),
        ] {
            ensure!(
                value.is_finite() && value >= 0.0,
                "[torque] {name} = {value} is not zero or above"
            );
        }
        let reserve = self.reserve;
        ensure!(
            (0.0..1.0).contains(&reserve),
            "[torque] reserve = {reserve} is not 0 to below 1"
        );
        Ok(())
    }

    /// The motor at an axis; a pull-out curve that is not written is reckoned for an inertia at the
    /// axis, that of the rotor included, in kg m² or kg.
    ///
    /// # Errors
    /// A number that no motor has, by its name, or a speed at which it has no torque left.
    pub fn at_axis(&self, transmission: Transmission, inertia: f64) -> Result<AxisMotor> {
        self.check()?;
        let Transmission {
            full_steps_per_turn,
            microsteps,
            ratio,
            max_speed,
        } = transmission;
        let motor = Motor {
            holding_torque_nm: self.holding_torque_nm,
            corner_speed_hz: self.corner_speed_hz,
            inertia_kg_m2: self.rotor_kg_m2,
            friction_nm: self.friction_nm,
            damping_ratio: self.damping_ratio,
            full_steps_per_turn,
            microsteps,
        };
        // Full steps a second at a speed of 1.
        let hz = ratio * f64::from(full_steps_per_turn) / TAU;
        let points = if self.pull_out.is_empty() {
            reckoned(&motor, inertia / ratio / ratio, max_speed * hz * BEYOND)?
        } else {
            self.pull_out.clone()
        };
        let points: Vec<_> = points
            .into_iter()
            .map(|[speed_hz, nm]| [speed_hz / hz, nm * ratio * (1.0 - self.reserve)])
            .collect();
        let curve = TorqueCurve::from_points(&points).context("[torque] pull_out")?;
        let straight = TorqueCurve::from_points(&line_below(&points))?;
        let [last, top] = [curve_end(&points), max_speed * BEYOND];
        ensure!(
            last >= top * (1.0 - f64::EPSILON * 8.0),
            "[torque] pull_out ends at {:.0} Hz, not above the {:.0} Hz of the largest speed by 1 %",
            last * hz,
            max_speed * hz
        );
        Ok(AxisMotor {
            motor,
            ratio,
            curve,
            straight,
        })
    }
}

/// The ends of the straight line below a curve along which the largest speed is reached the
/// soonest. With the torque c - m v and an inertia of 1:
///
/// ```text
/// ∫ dv / (c - m v) = ln(c / (c - m v)) / m
/// ```
fn line_below(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let top = curve_end(points);
    let falls = points.iter().zip(points.iter().skip(1));
    let falls = falls.map(|([v0, t0], [v1, t1])| (t0 - t1) / (v1 - v0));
    let lines = falls.filter(|fall| *fall > 0.0).chain([0.0]).map(|fall| {
        let heights = points.iter().map(|[v, t]| t + fall * v);
        let start = heights.fold(f64::INFINITY, f64::min);
        let end = start - fall * top;
        let time = if fall > 0.0 {
            (start / end).ln() / fall
        } else {
            top / start
        };
        // Not a number where the line ends below zero.
        (
            if end > 0.0 { time } else { f64::INFINITY },
            [[0.0, start], [top, end]],
        )
    });
    let soonest = lines.min_by(|a, b| a.0.total_cmp(&b.0));
    soonest.map_or([[0.0; 2]; 2], |(_, line)| line)
}

/// The largest speed of a curve.
fn curve_end(points: &[[f64; 2]]) -> f64 {
    points.last().map_or(0.0, |[speed, _]| *speed)
}

/// The pull-out curve of the simulated motor with an inertia, up to a speed.
fn reckoned(motor: &Motor, inertia_kg_m2: f64, top_hz: f64) -> Result<Vec<[f64; 2]>> {
    (0..=SPEEDS)
        .map(|n| {
            let hz = top_hz * f64::from(n) / f64::from(SPEEDS);
            let nm = motor.pull_out_nm(hz, inertia_kg_m2);
            ensure!(
                nm > 0.0,
                "[torque] the motor has nothing left at {hz:.0} Hz"
            );
            Ok([hz, nm])
        })
        .collect()
}
