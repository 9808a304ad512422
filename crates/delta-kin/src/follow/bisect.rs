//! Steps along 0..=1 by halves, without a stack.

use nalgebra::RealField;

/// Largest number of halvings. A step of 2⁻³⁰ of a path that still is too long means that the
/// angles jump.
const MAX_DEPTH: u32 = 30;

/// A walk along 0..=1 in steps of 2^-depth that start at multiples of their length.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bisection {
    depth: u32,
    /// Steps of the present length taken so far.
    taken: u32,
}

impl Bisection {
    /// Where the next step ends.
    pub(super) fn target<T: RealField + Copy>(&self) -> T {
        let whole = f64::from(1u32 << self.depth);
        nalgebra::convert(f64::from(self.taken + 1) / whole)
    }

    /// Makes the next step half as long; false where it is as short as may be.
    pub(super) const fn halve(&mut self) -> bool {
        if self.depth == MAX_DEPTH {
            return false;
        }
        self.depth += 1;
        self.taken *= 2;
        true
    }

    /// Takes the step, and makes the next one as long as its start allows; false at 1.
    pub(super) const fn advance(&mut self) -> bool {
        self.taken += 1;
        if self.taken == 1 << self.depth {
            return false;
        }
        let longer = self.taken.trailing_zeros();
        self.depth -= longer;
        self.taken >>= longer;
        true
    }
}

#[cfg(test)]
mod tests {
    extern crate alloc;
    use alloc::vec::Vec;

    use super::*;

    fn ends(accepts: impl Fn(f64, f64) -> bool) -> Vec<f64> {
        let (mut steps, mut ends) = (Bisection::default(), Vec::from([0.0]));
        loop {
            while !accepts(*ends.last().unwrap(), steps.target()) {
                assert!(steps.halve(), "no step is short enough");
            }
            ends.push(steps.target());
            if !steps.advance() {
                return ends;
            }
        }
    }

    #[test]
    fn steps_are_as_long_as_their_start_allows() {
        assert_eq!(ends(|_, _| true), [0.0, 1.0]);
        let even = ends(|from, to| to - from <= 0.3);
        assert_eq!(even, [0.0, 0.25, 0.5, 0.75, 1.0]);
        let crowded = ends(|from, to| from >= 0.125 || to <= 0.125);
        assert_eq!(crowded, [0.0, 0.125, 0.25, 0.5, 1.0]);
    }

    #[test]
    fn halving_ends() {
        let mut steps = Bisection::default();
        assert_eq!((0..100).take_while(|_| steps.halve()).count(), 30);
    }
}
