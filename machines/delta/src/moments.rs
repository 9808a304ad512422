//! The arms over time, as the steps drive them: angles, rates, accelerations and torques.

use anyhow::Result;
use nalgebra::Vector3;

use crate::simulation::Drive;

const GRAVITY_M_S2: f64 = 9.81;
const MM_PER_M: f64 = 1000.0;

/// The arms and the platform at a time.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct ArmsAt {
    /// Seconds from the start.
    pub t_s: f64,
    /// From straight down, outward positive.
    pub angles_deg: [f64; 3],
    /// Mean around this time.
    pub rates_deg_s: [f64; 3],
    /// Mean around this time.
    pub accelerations_deg_s2: [f64; 3],
    /// What the arms need to hold and accelerate the load; their own mass is not counted.
    pub torques_nm: [f64; 3],
    /// Its centre.
    pub platform_mm: [f64; 3],
    /// The end of each upper arm.
    pub elbows_mm: [[f64; 3]; 3],
}

impl Drive<'_> {
    /// What the arms do over time, with a load on the platform in kg.
    ///
    /// ```text
    /// rate = (q(t + w) - q(t - w)) / 2 w
    /// acceleration = (q(t + w) - 2 q(t) + q(t - w)) / w²
    /// torque = -Jᵀ F,  F = -m (g + acceleration of the platform)
    /// ```
    /// of angles and platform at the ends of windows of length w.
    ///
    /// # Errors
    /// The rods of a pose lie in a plane, where no torque holds the platform.
    pub fn arms(&self, load_kg: f64) -> Result<Vec<ArmsAt>> {
        let machine = self.machine;
        let window_s = self.positions.window_s();
        let mut points = Vec::new();
        for (t_s, steps) in self.positions.points() {
            let angles = Vector3::from(steps) * machine.rad_per_step;
            points.push((t_s, angles, machine.delta.forward(angles)?.coords));
        }
        let second = |[a, b, c]: [&Vector3<f64>; 3]| (a - b * 2.0 + c) / (window_s * window_s);

        // At rest before the first and after the last.
        let before = points.first().into_iter().chain(&points);
        let after = points.iter().skip(1).chain(points.last());
        let mut arms = Vec::with_capacity(points.len());
        for (((_, q0, p0), (t_s, q1, p1)), (_, q2, p2)) in before.zip(&points).zip(after) {
            let pose = machine.delta.pose_of(*q1)?;
            let acceleration_m_s2 = second([p0, p1, p2]) / MM_PER_M + Vector3::z() * GRAVITY_M_S2;
            let torques_nmm = pose.holding_torques(acceleration_m_s2 * -load_kg)?;
            let deg = |rad: Vector3<f64>| rad.map(f64::to_degrees).into();
            arms.push(ArmsAt {
                t_s: *t_s,
                angles_deg: deg(q1 + Vector3::from(machine.home_rad())),
                rates_deg_s: deg((q2 - q0) / (2.0 * window_s)),
                accelerations_deg_s2: deg(second([q0, q1, q2])),
                torques_nm: (torques_nmm / MM_PER_M).into(),
                platform_mm: pose.point().into(),
                elbows_mm: pose.elbows().map(|at| at.into()),
            });
        }
        Ok(arms)
    }
}
