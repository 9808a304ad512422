//! Whether the axes stay within their strokes between two points.

use path_timing::{Cubic, Span};

use crate::{Axis, LimitError, Platform};

/// The axis that leaves its stroke between two points, if one does.
pub(super) fn check<const N: usize>(
    platform: &Platform<N>,
    span: &Span<[[f64; 3]; N]>,
) -> Result<(), LimitError> {
    let [from, to] = &span.rows;
    for row in [from, to] {
        platform.check_axes(&row.position.map(Into::into))?;
    }
    let locators = platform.locators().iter().enumerate();
    let limits = locators.flat_map(|(locator, it)| {
        let axes = Axis::ALL.into_iter().zip(it.limits);
        axes.map(move |(axis, limits)| (locator, axis, limits))
    });
    for ((locator, axis, limits), cubic) in limits.zip(Cubic::between(from, to)) {
        let (min, max) = (limits.min, limits.max);
        let points = cubic.control_points();
        if points.iter().all(|point| *point >= min && *point <= max) {
            continue;
        }
        let [low, high] = cubic.extent();
        let by = (min - low).max(high - max);
        // Ends are checked with the tolerance of the platform.
        let ends = (min - cubic.q0.min(cubic.q1)).max(cubic.q0.max(cubic.q1) - max);
        if by > 0.0 && by > ends {
            return Err(LimitError::Stroke {
                locator,
                axis,
                value: if high > max { high } else { low },
                min,
                max,
                by,
            });
        }
    }
    Ok(())
}
