//! The thesis' controller: at each tick every motor that has steps to go makes one.

/// The position after each tick, until the last target is reached.
pub(crate) fn positions(
    targets: impl IntoIterator<Item = [i32; 3]>,
) -> impl Iterator<Item = [i32; 3]> {
    let mut position = [0; 3];
    let mut targets = targets.into_iter();
    let mut target = targets.next();
    core::iter::from_fn(move || {
        while target == Some(position) {
            target = targets.next();
        }
        let target = target?;
        for (position, target) in position.iter_mut().zip(target) {
            *position += (target - *position).signum();
        }
        Some(position)
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn motors_with_less_to_go_wait_for_the_others() {
        let targets = [[2, 0, -1], [2, 0, -1], [1, 1, -1]];
        let positions: Vec<_> = super::positions(targets).collect();
        assert_eq!(positions, [[1, 0, -1], [2, 0, -1], [1, 1, -1]]);
    }
}
