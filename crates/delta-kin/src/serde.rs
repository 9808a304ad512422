//! Serialised forms: plain fields, checked by the constructors when they are read.

use nalgebra::RealField;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use trig_kernels::Trig;

use crate::{
    ArmGeometry, ArmRange, AssemblyMode, Delta, ElbowSide, GeometryError, Positive, ZAxis,
};

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

serialise_as!(ArmRange, PlainRange);
serialise_as!(Delta, PlainDelta);

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlainRange<T> {
    min: T,
    max: T,
}

impl<T: RealField + Trig> From<ArmRange<T>> for PlainRange<T> {
    fn from(range: ArmRange<T>) -> Self {
        Self {
            min: range.min(),
            max: range.max(),
        }
    }
}

impl<T: RealField + Trig> TryFrom<PlainRange<T>> for ArmRange<T> {
    type Error = GeometryError<T>;

    fn try_from(plain: PlainRange<T>) -> Result<Self, Self::Error> {
        Self::new(plain.min, plain.max)
    }
}

#[derive(Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    bound(
        serialize = "T: RealField + Trig + Serialize",
        deserialize = "T: RealField + Trig + Deserialize<'de>"
    )
)]
struct PlainDelta<T> {
    arms: [ArmGeometry<T>; 3],
    #[serde(default)]
    z: ZAxis,
    #[serde(default)]
    positive: Positive,
    #[serde(default)]
    ranges: [Option<ArmRange<T>>; 3],
    #[serde(default)]
    max_swivel: Option<T>,
    #[serde(default = "elbows_out")]
    working_mode: [ElbowSide; 3],
    #[serde(default)]
    assembly_mode: AssemblyMode,
}

const fn elbows_out() -> [ElbowSide; 3] {
    [ElbowSide::Out; 3]
}

impl<T: RealField + Trig> From<Delta<T>> for PlainDelta<T> {
    fn from(delta: Delta<T>) -> Self {
        Self {
            arms: *delta.arms(),
            z: delta.z(),
            positive: delta.positive(),
            ranges: delta
                .ranges()
                .map(|range| (range != ArmRange::unlimited()).then_some(range)),
            max_swivel: delta.max_swivel(),
            working_mode: delta.working_mode(),
            assembly_mode: delta.assembly_mode(),
        }
    }
}

impl<T: RealField + Trig> TryFrom<PlainDelta<T>> for Delta<T> {
    type Error = GeometryError<T>;

    fn try_from(plain: PlainDelta<T>) -> Result<Self, Self::Error> {
        let delta = Self::from_arms(plain.arms)?
            .with_z(plain.z)
            .with_positive(plain.positive)
            .with_ranges(
                plain
                    .ranges
                    .map(|range| range.unwrap_or_else(ArmRange::unlimited)),
            )
            .with_working_mode(plain.working_mode)
            .with_assembly_mode(plain.assembly_mode);
        plain
            .max_swivel
            .map_or(Ok(delta), |swivel| delta.with_ball_joints(swivel))
    }
}
