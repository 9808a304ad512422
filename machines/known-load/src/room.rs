//! Room for the knots of a table.

use path_timing::{Axes, Knot, PlanError};

/// Knots for which there is memory at first, and at most.
const KNOTS: [usize; 2] = [1 << 12, 1 << 22];

/// Plans with room for more knots until it is enough.
///
/// # Errors
/// Those of `plan`; [`PlanError::Memory`] where four million knots are too few.
pub fn with_room<A: Axes, R, E>(
    mut plan: impl FnMut(&mut [Knot<A>]) -> Result<R, PlanError<E>>,
) -> Result<R, PlanError<E>> {
    let [mut room, most] = KNOTS;
    loop {
        let planned = plan(&mut vec![Knot::default(); room]);
        match planned {
            Err(PlanError::Memory { .. }) if room < most => room *= 4,
            planned => return planned,
        }
    }
}
