//! Steps along 0..=1 by halves, without a stack.

use nalgebra::RealField;

/// Most halvings of a line. A step of a line's 2⁻³⁰ that still is too long means that
/// the angles jump.
const DEEPEST: u32 = 30;

/// A walk along 0..=1 whose steps are of length 2^-depth and start at multiples of
/// their length, as a recursive bisection's are.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bisection {
    depth: u32,
    /// Steps of the present length that lie behind.
    behind: u32,
}

impl Bisection {
    /// Where the walk stands.
    pub(super) fn position<T: RealField + Copy>(&self) -> T {
        share(self.behind, self.depth)
    }

    /// Where the next step ends.
    pub(super) fn target<T: RealField + Copy>(&self) -> T {
        share(self.behind + 1, self.depth)
    }

    /// Whether the next step ends at 1.
    pub(super) const fn is_last(&self) -> bool {
        self.behind + 1 == 1 << self.depth
    }

    /// Makes the next step half as long; false where it is as short as may be.
    pub(super) const fn halve(&mut self) -> bool {
        if self.depth == DEEPEST {
            return false;
        }
        self.depth += 1;
        self.behind *= 2;
        true
    }

    /// Takes the step, and makes the next one as long as its place allows; false at 1.
    pub(super) const fn advance(&mut self) -> bool {
        if self.is_last() {
            return false;
        }
        self.behind += 1;
        let longer = self.behind.trailing_zeros();
        let longer = if longer < self.depth {
            longer
        } else {
            self.depth
        };
        self.depth -= longer;
        self.behind >>= longer;
        true
    }
}

/// count / 2^depth, exact.
fn share<T: RealField + Copy>(count: u32, depth: u32) -> T {
    let whole = f64::from(1u32 << depth);
    nalgebra::convert(f64::from(count) / whole)
}
