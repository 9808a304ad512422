//! Parameters of a calibration, for benches and tests.

use delta_kin::{Arm, Parameter, Quantity};

/// Zeros and lower arms of each, two azimuths, and the base, upper arm and azimuth alike.
pub(crate) fn eleven() -> [Parameter; 11] {
    let [first, second, third] = Arm::ALL;
    [
        Parameter::of(Quantity::Zero, first),
        Parameter::of(Quantity::Zero, second),
        Parameter::of(Quantity::Zero, third),
        Parameter::of(Quantity::Lower, first),
        Parameter::of(Quantity::Lower, second),
        Parameter::of(Quantity::Lower, third),
        Parameter::of(Quantity::Azimuth, second),
        Parameter::of(Quantity::Azimuth, third),
        Parameter::common(Quantity::Azimuth),
        Parameter::common(Quantity::Base),
        Parameter::common(Quantity::Upper),
    ]
}
