//! The largest value in each part of a time whose length is not known before.

/// Parts at most.
const MAX_PARTS: usize = 512;

/// The largest value in each part of the time, in at most 512 parts of a power of two of ticks;
/// the parts grow with the time.
///
/// # Examples
/// ```
/// let mut profile = machine_sim::Profile::new();
/// profile.add(0, 1.0);
/// profile.add(1, 3.0);
/// profile.add(1, 2.0);
/// profile.add(3, 4.0);
/// let parts: Vec<_> = profile.parts().collect();
/// assert_eq!(parts, [(0, Some(1.0)), (1, Some(3.0)), (2, None), (3, Some(4.0))]);
/// ```
#[derive(Debug, Clone)]
pub struct Profile {
    parts: Vec<Option<f64>>,
    /// A part has `1 << shift` ticks.
    shift: u32,
}

impl Default for Profile {
    fn default() -> Self {
        Self::new()
    }
}

impl Profile {
    /// A profile of no time.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            parts: Vec::new(),
            shift: 0,
        }
    }

    /// Takes a value at a time.
    pub fn add(&mut self, ticks: u64, value: f64) {
        let index = loop {
            match usize::try_from(ticks >> self.shift) {
                Ok(index) if index < MAX_PARTS => break index,
                _ => self.double(),
            }
        };
        if self.parts.len() <= index {
            self.parts.resize(index + 1, None);
        }
        if let Some(max) = self.parts.get_mut(index) {
            *max = larger(*max, Some(value));
        }
    }

    /// Makes one part of two.
    fn double(&mut self) {
        let pairs = self.parts.chunks(2);
        let merged = pairs.map(|pair| pair.iter().copied().fold(None, larger));
        self.parts = merged.collect();
        self.shift += 1;
    }

    /// The parts in their order: ticks in the middle, and the largest value, if there was one.
    pub fn parts(&self) -> impl Iterator<Item = (u64, Option<f64>)> {
        let half = (1_u64 << self.shift) >> 1;
        let starts = (0_u64..).map(|index| index << self.shift);
        let middles = starts.map(move |start| start + half);
        middles.zip(self.parts.iter().copied())
    }
}

fn larger(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.max(b)),
        (one, None) | (None, one) => one,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_time_keeps_its_largest_values_in_few_parts() {
        let mut profile = Profile::new();
        for ticks in 0..1_000_000_u32 {
            let value = if ticks == 654_321 {
                7.0
            } else {
                f64::from(ticks % 5)
            };
            profile.add(ticks.into(), value);
        }
        let parts: Vec<_> = profile.parts().collect();
        assert!(parts.len() <= MAX_PARTS && parts.len() > MAX_PARTS / 2);
        let (at, max) = parts
            .iter()
            .copied()
            .max_by(|a, b| a.1.unwrap().total_cmp(&b.1.unwrap()))
            .unwrap();
        assert_eq!(max, Some(7.0));
        assert!(at.abs_diff(654_321) <= 1024, "{at}");
        profile.add(u64::MAX, 0.0);
        assert!(profile.parts().count() <= MAX_PARTS);
    }
}
