//! Why there is no path or no table, in the words of who sent it: degrees, mm of the line, and by
//! how much.

use core::fmt::{self, Display, Formatter};

use path_timing::PlanError;

use super::Unit;

/// The reason of a path, in those words.
pub trait Reasoned: Display {
    /// Writes it.
    ///
    /// # Errors
    /// Those of `f`.
    fn fmt_reason(&self, f: &mut Formatter<'_>) -> fmt::Result;
}

/// The reason of a path, or of its table.
#[derive(Debug)]
pub(crate) struct Reason<E>(pub(crate) E);

impl<E: Reasoned> Display for Reason<PlanError<E>> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.0 {
            PlanError::Path { reason, .. } => reason.fmt_reason(f),
            reason => reason.fmt(f),
        }
    }
}

/// An axis beyond its range after `s` mm, from radians or mm.
pub(super) fn out_of_range(
    f: &mut Formatter<'_>,
    s: f64,
    axis: impl Display,
    at: f64,
    range: [f64; 2],
    unit: Unit,
) -> fmt::Result {
    let [min, max] = range;
    let beyond = unit.shown((min - at).max(at - max));
    let [min, max] = range.map(|end| unit.shown(end));
    write!(
        f,
        "after {s:.3} mm {axis} is beyond {min:.3} to {max:.3} {} by ",
        unit.name()
    )?;
    if beyond < 0.001 {
        write!(f, "{beyond:.1e}")
    } else {
        write!(f, "{beyond:.3}")
    }
}
