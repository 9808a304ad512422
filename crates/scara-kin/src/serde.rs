//! Serialised forms: plain fields, checked by the constructors when they are read.

use nalgebra::{Isometry2, RealField, Vector2};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use trig_kernels::{Trig, atan2};

use crate::{Arm, DriveSense, Drives, GeometryError, JointRange, Joints, Limits};

/// Serialises `$checked` as `$plain`.
macro_rules! serialise_as {
    ($checked:ident, $plain:ident) => {
        impl<T: RealField + Trig + Serialize> Serialize for $checked<T> {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                $plain::from(*self).serialize(serializer)
            }
        }

        impl<'de, T: RealField + Trig + Deserialize<'de>> Deserialize<'de> for $checked<T> {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $plain::deserialize(deserializer)?
                    .try_into()
                    .map_err(D::Error::custom)
            }
        }
    };
}

serialise_as!(JointRange, PlainRange);
serialise_as!(Limits, PlainLimits);
serialise_as!(Arm, PlainArm);
serialise_as!(Drives, PlainDrives);

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlainRange<T> {
    min: T,
    max: T,
}

impl<T: RealField + Trig> From<JointRange<T>> for PlainRange<T> {
    fn from(range: JointRange<T>) -> Self {
        Self {
            min: range.min(),
            max: range.max(),
        }
    }
}

impl<T: RealField + Trig> TryFrom<PlainRange<T>> for JointRange<T> {
    type Error = GeometryError<T>;

    fn try_from(plain: PlainRange<T>) -> Result<Self, Self::Error> {
        Self::new(plain.min, plain.max)
    }
}

/// An unlimited range is left out.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlainLimits<T> {
    shoulder: Option<PlainRange<T>>,
    elbow: Option<PlainRange<T>>,
}

fn limited<T: RealField + Trig>(range: JointRange<T>) -> Option<PlainRange<T>> {
    (range != JointRange::unlimited()).then(|| range.into())
}

fn range<T: RealField + Trig>(
    plain: Option<PlainRange<T>>,
) -> Result<JointRange<T>, GeometryError<T>> {
    plain.map_or_else(|| Ok(JointRange::unlimited()), TryInto::try_into)
}

impl<T: RealField + Trig> From<Limits<T>> for PlainLimits<T> {
    fn from(limits: Limits<T>) -> Self {
        Self {
            shoulder: limited(limits.shoulder),
            elbow: limited(limits.elbow),
        }
    }
}

impl<T: RealField + Trig> TryFrom<PlainLimits<T>> for Limits<T> {
    type Error = GeometryError<T>;

    fn try_from(plain: PlainLimits<T>) -> Result<Self, Self::Error> {
        Ok(Self {
            shoulder: range(plain.shoulder)?,
            elbow: range(plain.elbow)?,
        })
    }
}

#[derive(Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    bound(deserialize = "T: RealField + Deserialize<'de>")
)]
struct PlainArm<T> {
    upper: T,
    fore: T,
    #[serde(default = "T::zero")]
    base_x: T,
    #[serde(default = "T::zero")]
    base_y: T,
    #[serde(default = "T::zero")]
    base_rad: T,
    #[serde(default = "T::zero")]
    keep_out: T,
    #[serde(default = "no_limits")]
    limits: PlainLimits<T>,
}

fn no_limits<T>() -> PlainLimits<T> {
    PlainLimits {
        shoulder: None,
        elbow: None,
    }
}

impl<T: RealField + Trig> From<Arm<T>> for PlainArm<T> {
    fn from(arm: Arm<T>) -> Self {
        Self {
            upper: arm.upper(),
            fore: arm.fore(),
            base_x: arm.base().translation.x,
            base_y: arm.base().translation.y,
            base_rad: atan2(arm.base().rotation.im, arm.base().rotation.re),
            keep_out: arm.keep_out(),
            limits: (*arm.limits()).into(),
        }
    }
}

impl<T: RealField + Trig> TryFrom<PlainArm<T>> for Arm<T> {
    type Error = GeometryError<T>;

    fn try_from(plain: PlainArm<T>) -> Result<Self, Self::Error> {
        let base = Isometry2::new(Vector2::new(plain.base_x, plain.base_y), plain.base_rad);
        let limits = plain.limits.try_into()?;
        Self::new(plain.upper, plain.fore)?
            .with_base(base)?
            .with_limits(limits)
            .with_keep_out(plain.keep_out)
    }
}

#[derive(Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    bound(deserialize = "T: RealField + Deserialize<'de>")
)]
struct PlainDrives<T> {
    #[serde(default = "no_offset")]
    zero: Joints<T>,
    #[serde(default)]
    shoulder: DriveSense,
    #[serde(default)]
    elbow: DriveSense,
    #[serde(default = "T::one")]
    shoulder_ratio: T,
    #[serde(default = "T::one")]
    elbow_ratio: T,
    #[serde(default = "T::zero")]
    coupling: T,
}

fn no_offset<T: RealField>() -> Joints<T> {
    Joints::new(T::zero(), T::zero())
}

impl<T: RealField + Trig> From<Drives<T>> for PlainDrives<T> {
    fn from(drives: Drives<T>) -> Self {
        let (shoulder, elbow) = drives.senses();
        let [shoulder_ratio, elbow_ratio] = drives.ratios();
        Self {
            zero: drives.zero(),
            shoulder,
            elbow,
            shoulder_ratio,
            elbow_ratio,
            coupling: drives.coupling(),
        }
    }
}

impl<T: RealField + Trig> TryFrom<PlainDrives<T>> for Drives<T> {
    type Error = GeometryError<T>;

    fn try_from(plain: PlainDrives<T>) -> Result<Self, Self::Error> {
        Self::default()
            .with_zero(plain.zero)?
            .with_senses(plain.shoulder, plain.elbow)
            .with_ratios([plain.shoulder_ratio, plain.elbow_ratio])?
            .with_coupling(plain.coupling)
    }
}
