//! Why a line cannot be drawn, in the words of who sent it: degrees, mm of the line, and by how much.

use core::fmt::{self, Display, Formatter};

use path_timing::PlanError;
use scara_kin::{ArmPathError, InverseError, Joint};

/// The reason of a path, or of its table.
pub(crate) struct Reason<E>(pub(crate) E);

impl Display for Reason<ArmPathError> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            ArmPathError::Unreachable { s, reason, .. } => match reason {
                InverseError::JointLimit {
                    joint,
                    angle,
                    min,
                    max,
                    ..
                } => out_of_range(f, s, joint, angle, [min, max]),
                reason => write!(f, "after {s:.3} mm {reason}"),
            },
            ArmPathError::Limit {
                s: [s, _],
                joint,
                angle,
                min,
                max,
            } => out_of_range(f, s, joint, angle, [min, max]),
            reason => reason.fmt(f),
        }
    }
}

impl Display for Reason<PlanError<ArmPathError>> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            PlanError::Path { reason, .. } => Reason(reason).fmt(f),
            reason => reason.fmt(f),
        }
    }
}

fn out_of_range(
    f: &mut Formatter<'_>,
    s: f64,
    joint: Joint,
    angle: f64,
    range: [f64; 2],
) -> fmt::Result {
    let [min, max] = range;
    let beyond = (min - angle).max(angle - max).to_degrees();
    let [min, max] = range.map(f64::to_degrees);
    write!(
        f,
        "after {s:.3} mm {joint} is beyond {min:.3} to {max:.3} degrees by "
    )?;
    if beyond < 0.001 {
        write!(f, "{beyond:.1e}")
    } else {
        write!(f, "{beyond:.3}")
    }
}
