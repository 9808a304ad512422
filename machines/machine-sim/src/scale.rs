//! What a controller sees of an axis: a linear scale and limit switches.

/// A linear scale that counts from where it was set to 0.
///
/// # Examples
/// ```
/// let mut scale = machine_sim::Scale::new(5);
/// scale.set_zero(100);
/// assert_eq!(scale.counts(98), -10);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scale {
    counts_per_step: u16,
    zero: i32,
}

impl Scale {
    /// a scale with a number of counts per step, 0 at position 0.
    #[must_use]
    pub const fn new(counts_per_step: u16) -> Self {
        Self {
            counts_per_step,
            zero: 0,
        }
    }

    /// Reads 0 at a position, in steps.
    pub const fn set_zero(&mut self, position: i32) {
        self.zero = position;
    }

    /// The counts at a position, in steps; it stops at the ends of 32 bits.
    #[must_use]
    pub fn counts(&self, position: i32) -> i32 {
        let steps = position.saturating_sub(self.zero);
        steps.saturating_mul(i32::from(self.counts_per_step))
    }
}

/// The limit switches of an axis, each closed at its position and beyond.
///
/// # Examples
/// ```
/// let switches = machine_sim::LimitSwitches::new(-100, 12_100);
/// assert_eq!(switches.closed(-100), [true, false]);
/// assert_eq!(switches.closed(0), [false, false]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LimitSwitches {
    lower: i32,
    upper: i32,
}

impl LimitSwitches {
    /// Switches at two positions, in steps.
    #[must_use]
    pub const fn new(lower: i32, upper: i32) -> Self {
        Self { lower, upper }
    }

    /// Whether the lower and the upper switch are closed at a position.
    #[must_use]
    pub const fn closed(&self, position: i32) -> [bool; 2] {
        [position <= self.lower, position >= self.upper]
    }
}
