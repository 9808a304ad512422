//! Random numbers that are the same on every machine.

/// `SplitMix64` (Steele, Lea and Flood, 2014): any seed is as good as another.
#[derive(Debug, Clone)]
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

    /// The next number: 64 random bits.
    pub const fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Whether something happens whose probability is this: never for 0, always for 1.
    pub fn happens(&mut self, probability: f64) -> bool {
        // 53 bits, which are exact.
        #[expect(clippy::cast_precision_loss, reason = "below 2^53")]
        let fraction = (self.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0;
        fraction < probability
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The generator's published values for the seed 1234567.
    #[test]
    fn numbers_are_those_of_splitmix64() {
        let mut random = Random::new(1_234_567);
        let wanted = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        assert_eq!(
            [random.next_u64(), random.next_u64(), random.next_u64()],
            wanted
        );
    }

    #[test]
    fn probabilities_are_kept() {
        let mut random = Random::new(1);
        let happened = (0..100_000).filter(|_| random.happens(0.3)).count();
        // Four standard deviations.
        assert!(happened.abs_diff(30_000) < 600, "{happened}");
        assert!((0..1000).all(|_| !random.happens(0.0) && random.happens(1.0)));
    }
}
