//! An axis: its name with the unit, its range, its ticks.

use core::ops::RangeInclusive;

/// Room around the data, as a fraction of their range.
const ROOM: f64 = 0.04;

/// An axis of a plot. Without a range of its own it has that of the data, and a little room.
#[derive(Debug, Clone)]
pub struct Axis {
    pub(super) name: String,
    range: Option<[f64; 2]>,
    included: Vec<f64>,
}

impl Axis {
    /// An axis with a name that ends in the unit, as `time in s`.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            range: None,
            included: Vec::new(),
        }
    }

    /// The same over a range; data beyond it are not seen.
    #[must_use]
    pub const fn over(mut self, range: RangeInclusive<f64>) -> Self {
        self.range = Some([*range.start(), *range.end()]);
        self
    }

    /// The same with a value that is seen whatever the data are.
    #[must_use]
    pub fn including(mut self, value: f64) -> Self {
        self.included.push(value);
        self
    }

    /// Ends of the axis, the lower first, never the same.
    pub(super) fn ends(&self, data: impl Iterator<Item = f64>) -> [f64; 2] {
        let [low, high] = self.range.unwrap_or_else(|| {
            let all = data.chain(self.included.iter().copied());
            let (low, high) = all
                .filter(|value| value.is_finite())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                    (low.min(value), high.max(value))
                });
            let room = (high - low) * ROOM;
            // An end that was asked for is the end.
            let is_end = |end: f64| self.included.iter().any(|it| it.to_bits() == end.to_bits());
            [
                if is_end(low) { low } else { low - room },
                if is_end(high) { high } else { high + room },
            ]
        });
        if !(low.is_finite() && high.is_finite()) {
            return [0.0, 1.0];
        }
        if high > low {
            return [low, high];
        }
        let half = if low == 0.0 { 0.5 } else { low.abs() * 0.1 };
        [low - half, low + half]
    }
}

/// Round numbers between two ends, at most `max` of them if that is above 1, with their texts.
pub(super) fn ticks([low, high]: [f64; 2], max: f64) -> Vec<(f64, String)> {
    let step = round_step((high - low) / max.max(2.0));
    let digits = -step.log10().floor();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped"
    )]
    let decimals = digits.clamp(0.0, 9.0) as usize;
    let first = (low / step - 1e-9).ceil();
    (0_u32..)
        .map(|k| (first + f64::from(k)) * step)
        .take_while(|value| *value <= high + step * 1e-9)
        .map(|value| {
            // No minus before a zero.
            let value = if value.abs() < step / 2.0 { 0.0 } else { value };
            (value, format!("{value:.decimals$}"))
        })
        .collect()
}

/// The next of 1, 2, 5, 10, 20, ... that is not below a number above zero.
fn round_step(min: f64) -> f64 {
    let decade = 10_f64.powf(min.log10().floor());
    let steps = [1.0, 2.0, 5.0];
    let step = steps.into_iter().find(|step| step * decade >= min);
    step.unwrap_or(10.0) * decade
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(ends: [f64; 2], max: f64) -> Vec<String> {
        ticks(ends, max).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_numbers_within_the_ends() {
        assert_eq!(
            texts([-65.0, 65.0], 8.0),
            ["-60", "-40", "-20", "0", "20", "40", "60"]
        );
        assert_eq!(
            texts([0.0, 0.222], 6.0),
            ["0.00", "0.05", "0.10", "0.15", "0.20"]
        );
        assert_eq!(texts([0.0, 1.0], 2.0), ["0.0", "0.5", "1.0"]);
    }

    #[test]
    fn an_axis_without_extent_has_one() {
        let axis = Axis::new("x");
        let close = |[low, high]: [f64; 2], [a, b]: [f64; 2]| {
            (low - a).abs() < 1e-12 && (high - b).abs() < 1e-12
        };
        assert!(close(axis.ends([3.0, 3.0].into_iter()), [2.7, 3.3]));
        assert!(close(axis.ends([f64::NAN].into_iter()), [0.0, 1.0]));
        let axis = axis.including(0.0);
        assert!(close(axis.ends([10.0].into_iter()), [0.0, 10.4]));
    }
}
