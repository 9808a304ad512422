//! Steps along 0..=1 by halves, without a stack.

use nalgebra::RealField;

/// Largest number of halvings of a line. A step of a line's 2⁻³⁰ that still is too long means that
/// the angles jump.
const MAX_DEPTH: u32 = 30;

/// A walk along 0..=1 whose steps are of length 2^-depth and start at multiples of
/// their length, as a recursive bisection's are.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bisection {
    depth: u32,
    /// Steps of the present length taken so far.
    taken: u32,
}

impl Bisection {
    /// Where the next step starts.
    pub(super) fn position<T: RealField + Copy>(&self) -> T {
        fraction(self.taken, self.depth)
    }

    /// Where the next step ends.
    pub(super) fn target<T: RealField + Copy>(&self) -> T {
        fraction(self.taken + 1, self.depth)
    }

    /// Whether the next step ends at 1.
    pub(super) const fn is_last(&self) -> bool {
        self.taken + 1 == 1 << self.depth
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
        if self.is_last() {
            return false;
        }
        self.taken += 1;
        let longer = self.taken.trailing_zeros();
        let longer = if longer < self.depth {
            longer
        } else {
            self.depth
        };
        self.depth -= longer;
        self.taken >>= longer;
        true
    }
}

/// count / 2^depth, exact.
fn fraction<T: RealField + Copy>(count: u32, depth: u32) -> T {
    let whole = f64::from(1u32 << depth);
    nalgebra::convert(f64::from(count) / whole)
}

#[cfg(test)]
mod tests {
    extern crate alloc;
    use alloc::vec::Vec;

    use super::*;

    fn ends(mut accepts: impl FnMut(f64, f64) -> bool) -> Vec<f64> {
        let mut steps = Bisection::default();
        let mut ends = Vec::new();
        loop {
            while !accepts(steps.position(), steps.target()) {
                assert!(steps.halve(), "no step is short enough");
            }
            ends.push(steps.target());
            if !steps.advance() {
                return ends;
            }
        }
    }

    #[test]
    fn one_step_where_it_will_do() {
        assert_eq!(ends(|_, _| true), [1.0]);
    }

    #[test]
    fn steps_are_as_long_as_their_start_allows() {
        assert_eq!(ends(|from, to| from >= 0.5 || to <= 0.5), [0.5, 1.0]);
        assert_eq!(ends(|from, to| to - from <= 0.3), [0.25, 0.5, 0.75, 1.0]);
        // Short only in the first eighth.
        let crowded = ends(|from, to| from >= 0.125 || to - from <= 0.125);
        assert_eq!(crowded, [0.125, 0.25, 0.5, 1.0]);
    }

    #[test]
    fn halving_ends() {
        let mut steps = Bisection::default();
        let halvings = (0..100).take_while(|_| steps.halve()).count();
        assert_eq!(halvings, 30);
        // A power of two is exact.
        assert_eq!(
            (steps.target::<f64>() * 2f64.powi(30)).to_bits(),
            1f64.to_bits()
        );
    }
}
