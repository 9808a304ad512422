//! Random numbers, the same on every machine, and how long to draw them.

/// The generator `SplitMix64`.
#[derive(Debug)]
#[expect(
    missing_copy_implementations,
    reason = "a copy would give the same numbers once more"
)]
pub struct Random(u64);

impl Random {
    /// The same numbers for the same seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub const fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// 0 to `count` - 1.
    pub const fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }

    /// 0 to 1.
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
    pub const fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// `low` to `high`, evenly.
    pub const fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// 10^`low` to 10^`high`, each magnitude as often.
    pub fn size(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.within(low, high))
    }
}

/// A whole number from the environment, or the one that is usual.
#[must_use]
pub fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().unwrap())
}
