//! The three arms by name, their elbows and their geometry.

use core::fmt;

use nalgebra::RealField;

/// One of the three arms, counted as [Delta thesis] does: arm i stands at (4i - 3) π/6.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a Delta has three arms")]
pub enum Arm {
    /// Arm 1, nominally at 30°.
    First,
    /// Arm 2, nominally at 150°.
    Second,
    /// Arm 3, nominally at 270°.
    Third,
}

impl Arm {
    /// All three, in order.
    pub const ALL: [Self; 3] = [Self::First, Self::Second, Self::Third];

    /// 1, 2 or 3.
    #[must_use]
    pub const fn number(self) -> u8 {
        match self {
            Self::First => 1,
            Self::Second => 2,
            Self::Third => 3,
        }
    }
}

impl fmt::Display for Arm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "arm {}", self.number())
    }
}

/// On which side of the line from shoulder to wrist an arm's elbow lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "two circles meet in two points")]
pub enum ElbowSide {
    /// Outside, as Delta robots are built.
    Out,
    /// Inside, towards the axis of the base.
    In,
}

/// The four lengths of a Delta whose arms are equal, in one unit, as in [`ArmGeometry`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "these four determine a Delta")]
pub struct Dimensions<T = f64> {
    /// R: base radius, from the base's axis to a shoulder.
    pub base: T,
    /// r: platform radius, from the platform's centre to a wrist.
    pub platform: T,
    /// Lb: upper arm, from shoulder to elbow.
    pub upper: T,
    /// La: lower arm, the rods from elbow to wrist.
    pub lower: T,
}

/// The geometry of one arm; lengths in one unit, the same throughout, angles in radians.
///
/// ```text
///   axis of the base
///    :<------ base ----->o shoulder, a motor
///    :                    \
///    :                     \  upper
///    :                  θ   \
///    :<- platform ->o---     o elbow       θ from straight down, outward positive
///                wrist  \---/
///                        lower
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "these six determine an arm")]
pub struct ArmGeometry<T = f64> {
    /// Direction of the arm round the base's axis, in radians from X, counter-clockwise
    /// seen from above.
    pub azimuth: T,
    /// R: from the base's axis to the shoulder.
    pub base: T,
    /// r: from the platform's centre to the wrist.
    pub platform: T,
    /// Lb: upper arm, from shoulder to elbow.
    pub upper: T,
    /// La: lower arm, the rods from elbow to wrist.
    pub lower: T,
    /// The θ, from straight down and outward positive, at which the arm's angle reads zero.
    pub zero: T,
}

impl<T: RealField + Copy> ArmGeometry<T> {
    /// An arm as designed: at its nominal azimuth, its angle zero straight down.
    #[must_use]
    pub fn nominal(arm: Arm, dimensions: Dimensions<T>) -> Self {
        let Dimensions {
            base,
            platform,
            upper,
            lower,
        } = dimensions;
        let sixths = nalgebra::convert::<f64, T>(f64::from(4 * arm.number() - 3));
        Self {
            azimuth: sixths * T::frac_pi_6(),
            base,
            platform,
            upper,
            lower,
            zero: T::zero(),
        }
    }
}

/// Pairs what belongs to the same arm.
#[inline(always)]
pub(crate) fn zip<A, B>([a1, a2, a3]: [A; 3], [b1, b2, b3]: [B; 3]) -> [(A, B); 3] {
    [(a1, b1), (a2, b2), (a3, b3)]
}

/// The arm with the smallest value; of equals the first.
pub(crate) fn smallest<T: RealField + Copy>(values: [T; 3]) -> (Arm, T) {
    let [first, second, third] = zip(Arm::ALL, values);
    let smaller = |a: (Arm, T), b: (Arm, T)| if b.1 < a.1 { b } else { a };
    smaller(smaller(first, second), third)
}
