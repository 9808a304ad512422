//! Where a function is zero: by Newton's and secant steps, by halves where these lead nowhere.

/// Steps at most: halves find a number to its last digit.
const ROUNDS: u32 = 60;

/// A step by less than this part of a place is rounding.
const ROUNDING: f64 = f64::EPSILON;

/// The place in a range where what rises there is zero, from its value and its slope.
pub(super) fn of_rising(
    [mut low, mut high]: [f64; 2],
    guess: f64,
    value_and_slope: impl Fn(f64) -> [f64; 2],
) -> f64 {
    let mut place = guess;
    for _ in 0..ROUNDS {
        let [value, slope] = value_and_slope(place);
        let step = value / slope;
        if step.abs() <= place * ROUNDING {
            break;
        }
        if value < 0.0 {
            low = place;
        } else {
            high = place;
        }
        let next = place - step;
        place = if next > low && next < high {
            next
        } else {
            (low + high) * 0.5
        };
    }
    place
}

/// The place between two where a value is zero to within `close`: above zero at the first, below or
/// no number at the second.
pub(super) fn between(
    [mut low, mut high]: [f64; 2],
    close: f64,
    value: impl Fn(f64) -> f64,
) -> f64 {
    let (mut at_low, mut at_high) = (value(low), value(high));
    let mut was_above = None;
    for _ in 0..ROUNDS {
        let width = high - low;
        if width <= high * ROUNDING {
            break;
        }
        let secant = low + width * at_low / (at_low - at_high);
        let place = if secant > low && secant < high {
            secant
        } else {
            (low + high) * 0.5
        };
        let here = value(place);
        if here.abs() <= close {
            return place;
        }
        let is_above = here > 0.0;
        // An end that stays twice counts half (Illinois).
        let stays_twice = was_above == Some(is_above);
        let half = if stays_twice { 0.5 } else { 1.0 };
        if is_above {
            (low, at_low, at_high) = (place, here, at_high * half);
        } else {
            (high, at_high, at_low) = (place, here, at_low * half);
        }
        was_above = Some(is_above);
    }
    high
}

#[cfg(test)]
mod tests {
    use super::{ROUNDING, between, of_rising};

    /// Of a place, by the rounding of the values beside it.
    const NEAR: f64 = 16.0 * ROUNDING;

    #[test]
    fn what_rises_is_zero_there() {
        for root in [0.0, 1e-9, 0.3, 0.999, 1.0] {
            // Rising, with a slope that is 0 at 0 or at 1.
            let square = |x: f64| [x * x - root * root, 2.0 * x];
            let turned = |x: f64| {
                let [x, root] = [1.0 - x, 1.0 - root];
                [root * root - x * x, 2.0 * x]
            };
            for guess in [0.0, 0.5, 1.0] {
                let [one, other] = [
                    of_rising([0.0, 1.0], guess, square),
                    of_rising([0.0, 1.0], guess, turned),
                ];
                let [at_one, at_other] = [square(one)[0], turned(other)[0]];
                assert!(at_one.abs() <= NEAR, "{root} from {guess}: {one}");
                assert!(at_other.abs() <= NEAR, "{root} from {guess}: {other}");
            }
        }
    }

    #[test]
    fn what_falls_is_zero_between() {
        for root in [1.0, 1.5, 3.9, 4.0] {
            let found = between([1.0, 4.0], 0.0, |x| 1.0 / (x * x) - 1.0 / (root * root));
            assert!((found - root).abs() <= root * NEAR, "{root}: {found}");
        }
        // No number beyond: what is found is the end of the numbers.
        let value = |x: f64| if x > 2.0 { f64::NAN } else { 1.0 };
        let found = between([1.0, 4.0], 0.0, value);
        assert!((found - 2.0).abs() <= NEAR, "{found}");
    }
}
