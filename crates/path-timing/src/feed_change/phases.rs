//! To another speed with limited jerk, or to rest, at a given knot.

use super::root;
use crate::number::sqrt;

/// Three phases of constant jerk from a speed and an acceleration along the path to others. To
/// speeds lower than what would be gained the acceleration falls to -A, stays, and rises to what it
/// is to be; to higher ones all signs are turned.
///
/// ```text
/// A = κ √(J (v₀ - v₁) + (a₀² + a₁²)/2)        κ = 1: it does not stay
///                                             κ = -1: nor does it, and A < 0 is no braking
/// ```
///
/// and with a jerk J₀ of its own in the first phase, with which the speed that is gained is less
///
/// ```text
/// A = κ √((v₀ - v₁ + a₀²/2J₀ + a₁²/2J) / (1/2J₀ + 1/2J))
/// ```
#[derive(Debug, Clone, Copy)]
pub(super) struct Phases {
    /// Duration and jerk.
    phases: [(f64, f64); 3],
    start: State,
    /// The speed v₁.
    last: f64,
    /// The length from the start to the knot reached.
    reached: f64,
}

/// The part of its last segment by which the phases of a stop end before the knot where it rests.
/// There the acceleration is even on each segment and steps at the knots; with the half, no step is
/// more than the jerk of the last phase over the time from the middle of a segment to the next:
///
/// ```text
/// w = ∛(9/2 J (x - xₗ/2)²)    at the knots x = xₗ, 2xₗ, 3xₗ .. from rest
/// ```
pub(super) const TAIL: f64 = 0.5;

/// Those that a stop is tried with, in their order. The more there are, the nearer to its limit is
/// the jerk with which one ends at a knot; where the machine gains its highest speed, little less
/// passes the limit of speed.
pub(super) const TAILS_OF_STOPS: [f64; 4] = [TAIL, 0.75, 0.625, 0.875];

/// The same of another feed.
pub(super) const TAILS: [f64; 2] = [0.0, 0.25];

/// The part of the first segment before which they begin from rest, and where braking has come near
/// to it just now.
pub(super) const HEADS: [f64; 2] = [TAIL, 0.75];

/// Speed and acceleration of the parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct State {
    pub(super) speed: f64,
    pub(super) acceleration: f64,
}

impl State {
    pub(super) const REST: Self = Self {
        speed: 0.0,
        acceleration: 0.0,
    };

    /// The state after a time, and the length passed.
    fn after(self, time: f64, jerk: f64) -> (Self, f64) {
        let gain = self.acceleration + jerk * time * 0.5;
        let mean = self.speed + (self.acceleration + jerk * time / 3.0) * time * 0.5;
        let next = Self {
            speed: self.speed + gain * time,
            acceleration: self.acceleration + jerk * time,
        };
        (next, mean * time)
    }
}

/// Jerks that are tried to find two that the wanted one lies between.
const ROUNDS: u32 = 60;

/// Of the largest jerk that there is: with it the acceleration would not fall below zero, and be
/// 0/0.
const MOST: f64 = 1.0 - 1e-6;

/// By how much the jerk is changed for that.
const FACTOR: f64 = 4.0;

/// κ where the acceleration only falls and rises again: the machine gains speed all the time, and
/// less than it would, for a feed that is little lower.
const WITHIN_SIGN: f64 = -1.0;

/// Shapes to be tried, the quickest first.
pub(super) const KAPPAS: [f64; 6] = [0.15, 0.25, 0.4, 0.6, 0.8, 1.0];

/// What the phases lead from and to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    pub(super) start: State,
    pub(super) end: State,
    pub(super) way: Way,
}

/// On which side of what would be gained the speed lies.
#[derive(Debug, Clone, Copy)]
pub(super) enum Way {
    Slower,
    Faster,
}

impl Way {
    /// By which all signs are turned.
    const fn sign(self) -> f64 {
        match self {
            Self::Slower => 1.0,
            Self::Faster => -1.0,
        }
    }
}

impl Ends {
    /// The speed v₀ - v₁ that is lost.
    fn lost(&self) -> f64 {
        (self.start.speed - self.end.speed) * self.way.sign()
    }

    /// (a₀² + a₁²)/2
    fn squares(&self) -> f64 {
        let [start, end] = [self.start, self.end].map(|state| state.acceleration);
        (start * start + end * end) * 0.5
    }

    /// The jerk above which it would not gain the speed at which it is to end.
    fn most_jerk(&self) -> f64 {
        let lost = self.lost();
        if lost < 0.0 {
            MOST * self.squares() / -lost
        } else {
            f64::INFINITY
        }
    }

    /// κ of what takes a length within an acceleration and a jerk; none where it is not enough.
    pub(super) fn kappa(&self, length: f64, [acceleration, jerk]: [f64; 2]) -> Option<f64> {
        // At all of the acceleration.
        let mean = (self.start.speed + self.end.speed) * 0.5;
        if self.lost() * mean > acceleration * length {
            return None;
        }
        let jerk = jerk.min(self.most_jerk());
        let most = sqrt(jerk * self.lost() + self.squares());
        let kappa = (acceleration / most).min(1.0);
        if self.phases([jerk; 2], kappa).end() <= length {
            return Some(kappa);
        }
        (length <= self.length_within_sign(jerk)).then_some(WITHIN_SIGN)
    }

    /// The length that it takes where the acceleration keeps its sign; NaN where it would not fall
    /// first and rise then.
    fn length_within_sign(&self, jerk: f64) -> f64 {
        let phases = self.phases([jerk; 2], WITHIN_SIGN);
        let [(_, first), _, (_, last)] = phases.phases;
        let sign = self.way.sign();
        if first * sign < 0.0 && last * sign > 0.0 {
            phases.end()
        } else {
            f64::NAN
        }
    }

    fn phases(&self, jerks: [f64; 2], kappa: f64) -> Phases {
        let sign = self.way.sign();
        let [of_first, of_last] = jerks.map(|jerk| 0.5 / jerk);
        let both = of_first + of_last;
        let [start, end] = [self.start, self.end].map(|state| state.acceleration * sign);
        let less = self.lost() + start * start * of_first + end * end * of_last;
        let hardest = kappa * sqrt(less / both);
        let [fall, rise] = [start, end].map(|acceleration| acceleration + hardest);
        let stay = less / hardest - hardest * both;
        let [first, last] = jerks;
        Phases {
            phases: [
                (fall.abs() / first, -first.copysign(fall) * sign),
                (stay.max(0.0), 0.0),
                (rise.abs() / last, last.copysign(rise) * sign),
            ],
            start: self.start,
            last: self.end.speed,
            reached: 0.0,
        }
    }
}

impl Phases {
    /// What takes a length, with the jerk `first` in its first phase or with the same in all; none
    /// where no jerk does. Beyond, it goes on at its last speed.
    pub(super) fn new(ends: &Ends, length: f64, kappa: f64, first: Option<f64>) -> Option<Self> {
        let with = |jerk: f64| ends.phases([first.unwrap_or(jerk), jerk], kappa);
        // It would take this length if the speed changed evenly, and would do so in this time.
        let time = 2.0 * length / (ends.start.speed + ends.end.speed);
        let change = ends.lost().abs() + ends.start.acceleration.abs() * time;
        let most = ends.most_jerk();
        let mut high = (change / (time * time)).min(most);
        // With more jerk it takes less, but more where the acceleration keeps its sign.
        let is_less = |jerk: f64| (with(jerk).end() - length) * kappa > 0.0;
        for _ in 0..ROUNDS {
            if !is_less(high) {
                break;
            }
            high = (high * FACTOR).min(most);
        }
        let mut low = high;
        for _ in 0..ROUNDS {
            if is_less(low) {
                break;
            }
            low /= FACTOR;
        }
        let more = |jerk: f64| (with(jerk).end() - length) * kappa;
        let found = with(root::between([low, high], length * ROUNDING, more));
        let is_found = (found.end() - length).abs() <= length * CLOSE;
        is_found.then_some(found)
    }

    /// Where it began, and how far it has come since.
    pub(super) const fn begun(&self) -> (State, f64) {
        (self.start, self.reached)
    }

    /// The same with a length that it has come already.
    pub(super) const fn having_reached(self, reached: f64) -> Self {
        Self { reached, ..self }
    }

    /// The length that it takes.
    fn end(&self) -> f64 {
        let (_, length) = self
            .phases
            .iter()
            .fold((self.start, 0.0), |(state, sum), phase| {
                let (next, length) = state.after(phase.0, phase.1);
                (next, sum + length)
            });
        length
    }

    /// The speed at the next knot, a length further.
    pub(super) fn step(&mut self, ds: f64) -> f64 {
        self.reached += ds;
        let (mut state, mut left) = (self.start, self.reached);
        for (time, jerk) in self.phases {
            let (next, length) = state.after(time, jerk);
            if length >= left {
                let passed = |time| {
                    let (next, length) = state.after(time, jerk);
                    [length - left, next.speed]
                };
                let guess = time * (left / length);
                let time = root::of_rising([0.0, time], guess, passed);
                return state.after(time, jerk).0.speed.max(0.0);
            }
            (state, left) = (next, left - length);
        }
        self.last
    }
}

/// Relative rounding of the length that it takes.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Relative gap at which it takes the length wanted.
const CLOSE: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::{Ends, KAPPAS, Phases, State, WITHIN_SIGN, Way};

    const fn state(speed: f64, acceleration: f64) -> State {
        State {
            speed,
            acceleration,
        }
    }

    /// From 2 at an acceleration of 1 over a length of 3, in 300 steps: it comes to rest at its
    /// end, its speed goes on smoothly from the start.
    #[test]
    fn a_stop_ends_at_rest_where_it_is_to() {
        let ends = Ends {
            start: state(2.0, 1.0),
            end: State::REST,
            way: Way::Slower,
        };
        for kappa in KAPPAS {
            let mut stop = Phases::new(&ends, 2.995, kappa, None).unwrap();
            let (mut before, mut steepest) = (2.0_f64, 0.0_f64);
            for number in 1..=300 {
                let speed = stop.step(0.01);
                let acceleration = (speed * speed - before * before) / 0.02;
                if number == 1 {
                    assert!((acceleration - 1.0).abs() < 0.1, "{acceleration}");
                }
                steepest = steepest.min(acceleration);
                before = speed;
            }
            assert!(before.abs() < f64::EPSILON && steepest < -0.5);
        }
    }

    /// Of the phases' end, by the sums of three times 60 halvings.
    const ROUNDING: f64 = 1e-9;

    /// The state behind all phases, and the highest and the lowest acceleration on the way.
    fn run(phases: &Phases) -> (State, [f64; 2]) {
        let start = phases.start.acceleration;
        let begun = (phases.start, [start; 2]);
        (phases.phases.iter()).fold(begun, |(state, [high, low]), (time, jerk)| {
            let (next, _) = state.after(*time, *jerk);
            let bounds = [high.max(next.acceleration), low.min(next.acceleration)];
            (next, bounds)
        })
    }

    /// Each ends at the speed and the acceleration that it is to, and at its length.
    fn assert_ends(ends: &Ends, length: f64, kappa: f64) -> [f64; 2] {
        let phases = Phases::new(ends, length, kappa, None).unwrap();
        let (end, bounds) = run(&phases);
        let off = [
            end.speed - ends.end.speed,
            end.acceleration - ends.end.acceleration,
            phases.end() - length,
        ];
        assert!(off.iter().all(|off| off.abs() < ROUNDING), "{off:?}");
        bounds
    }

    #[test]
    fn a_feed_that_is_little_lower_is_reached_without_braking() {
        let ends = Ends {
            start: state(2.0, 1.0),
            end: state(2.2, 0.8),
            way: Way::Slower,
        };
        let length = 0.75;
        assert_eq!(ends.kappa(length, [1.0, 8.0]), Some(WITHIN_SIGN));
        let [high, low] = assert_ends(&ends, length, WITHIN_SIGN);
        assert!(high <= 1.0 && 0.0 < low && low < 0.8, "{high} {low}");
    }

    #[test]
    fn a_higher_speed_is_gained_from_rest_and_on_the_way() {
        for start in [State::REST, state(0.5, -0.2)] {
            let ends = Ends {
                start,
                end: state(2.0, 0.0),
                way: Way::Faster,
            };
            for kappa in KAPPAS {
                let [high, low] = assert_ends(&ends, 3.0, kappa);
                assert!(high > 0.5 && low >= start.acceleration, "{high} {low}");
            }
        }
    }
}
