//! The integers of CiA 402, the drive profile of CANopen and EtherCAT.

use trig_kernels::SixDigits;

/// A drive's scale: increments of its encoder for each unit of the axis, and its rated torque.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct Cia402Scale {
    /// Increments for each unit of the axis, gear included; negative where the drive turns the
    /// other way.
    pub counts_per_unit: f64,
    /// Rated torque at the axis' side of its gear (object 6076h times the ratio), in the unit of
    /// torques.
    pub rated_torque: f64,
}

/// What a drive takes each cycle in the mode "cyclic synchronous position".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "the objects of the profile")]
pub struct Cia402Target {
    /// Target position, object 607Ah, in increments.
    pub position: i32,
    /// Velocity offset, object 60B1h, in increments a second.
    pub velocity_offset: i32,
    /// Torque offset, object 60B2h, in thousandths of the rated torque.
    pub torque_offset: i16,
}

/// A value that an object of the profile cannot hold.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("{name} of {} is beyond its range of ±{max}", SixDigits(*.value))]
#[expect(clippy::exhaustive_structs, reason = "there is one cause")]
pub struct TargetError {
    /// Which: `position`, `velocity offset` or `torque offset`.
    pub name: &'static str,
    /// Its value, in the object's unit.
    pub value: f64,
    /// The largest one.
    pub max: i32,
}

impl Cia402Scale {
    /// Position, velocity and torque of an axis as a drive takes them, each rounded to the nearest,
    /// so that positions do not drift.
    ///
    /// # Errors
    /// [`TargetError`]: nothing is clamped.
    pub fn target(
        &self,
        position: f64,
        velocity: f64,
        torque: f64,
    ) -> Result<Cia402Target, TargetError> {
        let counts = self.counts_per_unit;
        let thousandths = torque / self.rated_torque * 1000.0;
        Ok(Cia402Target {
            position: rounded("position", position * counts, i32::MAX)?,
            velocity_offset: rounded("velocity offset", velocity * counts, i32::MAX)?,
            torque_offset: {
                let max = i32::from(i16::MAX);
                let value = rounded("torque offset", thousandths, max)?;
                i16::try_from(value).map_err(|_| TargetError {
                    name: "torque offset",
                    value: thousandths,
                    max,
                })?
            },
        })
    }
}

fn rounded(name: &'static str, value: f64, max: i32) -> Result<i32, TargetError> {
    let nearest = libm::round(value);
    // Written so that NaN is refused too.
    let fits = nearest.abs() <= f64::from(max);
    if !fits {
        return Err(TargetError { name, value, max });
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "whole, and within the range"
    )]
    Ok(nearest as i32)
}
