//! What a machine's axes carry, for plans and for simulated motors.

use anyhow::{Context, Result};
use machine_sim::Rotor;
use nalgebra::{SMatrix, SVector};
use path_timing::{Dynamics, TorqueCurveError, TorqueLimits};

use crate::motor::AxisMotor;

/// From one look at what the axes carry to the next: a fraction of the swings of a rotor.
const LOOK_S: f64 = 250e-6;

/// What the axes of a machine carry, and the motors that move it.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Load<D: Dynamics<Axes = [f64; N]>, const N: usize> {
    /// Of what is planned of the motors, at the axes.
    pub limits: TorqueLimits<D>,
    /// The motors.
    pub motors: [AxisMotor; N],
    /// The part of the motors' torque that is not planned.
    pub reserve: f64,
}

impl<D: Dynamics<Axes = [f64; N]> + Copy, const N: usize> Load<D, N> {
    /// Of dynamics, rotors included, with a motor at each axis.
    #[must_use]
    pub fn new(dynamics: D, motors: [AxisMotor; N], reserve: f64) -> Self {
        Self {
            limits: TorqueLimits {
                dynamics,
                motors: motors.map(|motor| motor.curve),
            },
            motors,
            reserve,
        }
    }

    /// The same with a straight line below the curve of each motor: with constant inertias, what
    /// motions keep of these limits, a shaped one keeps.
    #[must_use]
    pub fn straight(mut self) -> Self {
        self.limits.motors = self.motors.map(|motor| motor.straight);
        self
    }

    /// The limits with a share of what is planned of the motors.
    ///
    /// # Errors
    /// A share that is not above 0.
    pub fn limits_at(&self, share: f64) -> Result<TorqueLimits<D>, TorqueCurveError> {
        let mut limits = self.limits;
        for motor in &mut limits.motors {
            *motor = motor.scaled(share)?;
        }
        Ok(limits)
    }
}

/// A load on simulated motors, which changes with the pose.
#[derive(Debug, Clone, Copy)]
pub struct PoseLoad<D: Dynamics<Axes = [f64; N]>, const N: usize> {
    load: Load<D, N>,
    looked_s: f64,
}

impl<D: Dynamics<Axes = [f64; N]>, const N: usize> PoseLoad<D, N> {
    /// On motors that stand at a position.
    ///
    /// # Errors
    /// The axes have no inertia there.
    pub fn new(load: Load<D, N>, position: &[f64; N], rotors: [&mut Rotor; N]) -> Result<Self> {
        let this = Self {
            load,
            looked_s: 0.0,
        };
        this.look(position, rotors)?;
        Ok(this)
    }

    /// Lets the motors turn up to a time in s while the axes are commanded to a position.
    ///
    /// # Errors
    /// The axes have no inertia there.
    pub fn turn_until(
        &mut self,
        time_s: f64,
        position: &[f64; N],
        mut rotors: [&mut Rotor; N],
    ) -> Result<()> {
        while self.looked_s + LOOK_S < time_s {
            self.looked_s += LOOK_S;
            for rotor in &mut rotors {
                rotor.turn_until(self.looked_s);
            }
            self.look(position, rotors.each_mut().map(|rotor| &mut **rotor))?;
        }
        Ok(())
    }

    /// Gives each motor what it turns in this pose and at these speeds. With M the inertia, h what
    /// velocities and gravity ask for, t what the motors have:
    ///
    /// ```text
    /// M q'' = t - h,  load of a motor = h + Σ of the others' M q''
    /// ```
    fn look(&self, position: &[f64; N], mut rotors: [&mut Rotor; N]) -> Result<()> {
        let Load { limits, motors, .. } = &self.load;
        let torques = |rates: SVector<f64, N>, accelerations: SVector<f64, N>| {
            let torques = limits
                .dynamics
                .torques(position, &rates.into(), &accelerations.into());
            SVector::<f64, N>::from(torques)
        };
        let ratios = SVector::from(motors.map(|motor| motor.ratio));
        let speeds = rotors.each_ref().map(|rotor| rotor.speed_rad_s());
        let has = rotors.each_ref().map(|rotor| rotor.torque_nm());
        let rates = SVector::from(speeds).component_div(&ratios);
        let has = SVector::from(has).component_mul(&ratios);
        let zero = SVector::zeros();
        let held = torques(zero, zero);
        let mut inertia = SMatrix::<f64, N, N>::zeros();
        for (axis, mut column) in inertia.column_iter_mut().enumerate() {
            let unit = SVector::from_fn(|row, _| f64::from(u8::from(row == axis)));
            column.copy_from(&(torques(zero, unit) - held));
        }
        let moved = torques(rates, zero);
        let factored = inertia.cholesky().context("axes without inertia")?;
        let accelerations = factored.solve(&(has - moved));
        let own = inertia.diagonal();
        let loads = moved + inertia * accelerations - own.component_mul(&accelerations);
        let numbers = own.iter().zip(&loads).zip(&ratios);
        for (rotor, ((own, load), ratio)) in rotors.iter_mut().zip(numbers) {
            rotor.set_load(own / ratio / ratio, load / ratio);
        }
        Ok(())
    }
}
