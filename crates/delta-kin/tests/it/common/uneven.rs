//! Machines whose arms differ widely, and anything that they may be set to.

use delta_kin::{Arm, ArmGeometry, AssemblyMode, Dimensions, ElbowSide};
use proptest::prelude::*;

/// 10 to the power of what is between two ends.
fn logarithmic(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from..to).prop_map(|exponent| 10f64.powf(exponent))
}

/// Lower arms of 1/20 to 20 upper arms, radii from nothing to more than the arms, and each arm
/// like the others or not at all.
pub(crate) fn uneven_arms() -> impl Strategy<Value = [ArmGeometry; 3]> {
    let lengths = || {
        (
            logarithmic(-2.0, 0.3),
            logarithmic(-2.0, 0.0),
            logarithmic(-1.3, 0.3),
            logarithmic(-1.3, 0.5),
        )
    };
    let off = || {
        (
            -0.5..0.5f64,
            -3.2..3.2f64,
            [0.9..1.1f64, 0.9..1.1, 0.9..1.1, 0.9..1.1],
        )
    };
    let (alike, apart) = (lengths(), [lengths(), lengths(), lengths()]);
    (alike, apart, any::<bool>(), [off(), off(), off()]).prop_map(
        |(alike, apart, is_alike, off)| {
            let mut arms = Arm::ALL.map(|arm| {
                ArmGeometry::nominal(
                    arm,
                    Dimensions {
                        base: 1.0,
                        platform: 1.0,
                        upper: 1.0,
                        lower: 1.0,
                    },
                )
            });
            for ((arm, apart), (azimuth, zero, part)) in arms.iter_mut().zip(apart).zip(off) {
                let (base, platform, upper, lower) = if is_alike { alike } else { apart };
                arm.azimuth += azimuth;
                arm.zero = zero;
                arm.base = base * part[0];
                arm.platform = platform * part[1];
                arm.upper = upper * part[2];
                arm.lower = lower * part[3];
            }
            arms
        },
    )
}

/// An assembly and a working mode.
pub(crate) fn modes() -> impl Strategy<Value = (AssemblyMode, [ElbowSide; 3])> {
    let assembly_mode = prop_oneof![Just(AssemblyMode::Lower), Just(AssemblyMode::Upper)];
    let elbow = || prop_oneof![Just(ElbowSide::Out), Just(ElbowSide::In)];
    (assembly_mode, [elbow(), elbow(), elbow()])
}
