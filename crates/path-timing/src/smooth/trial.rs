//! The search for the average that takes the least time.

use super::average::Average;
use super::shape;
use crate::chain::Chain;
use crate::number::LARGEST;
use crate::planner::segments_of;
use crate::reciprocals::Reciprocals;
use crate::utilisation::{Of, Utilisation};
use crate::{Knot, Legs, PlanError, profile};

/// An average of a motion without a limit of jerk.
#[derive(Debug, Clone, Copy)]
pub(super) struct Easing {
    window_s: f64,
    /// The cap of the speeds, as a factor of those that all limits allow where the speed is even; each
    /// low speed is held half a window before its knot and after it, each top for a window. None for
    /// the fastest motion.
    cap: Option<f64>,
}

impl Easing {
    /// The same with one of its numbers changed by a factor.
    fn with(self, number: Number, factor: f64) -> Self {
        match number {
            Number::Window => Self {
                window_s: self.window_s * factor,
                ..self
            },
            Number::Cap => Self {
                cap: self.cap.map(|cap| cap * factor),
                ..self
            },
        }
    }
}

/// What of an average is searched for.
#[derive(Debug, Clone, Copy)]
enum Number {
    Window,
    Cap,
}

/// Factors by which a number is changed in a search: powers of two, and roots of it.
const COARSE: f64 = 2.0;
const FINE: [f64; 3] = [
    core::f64::consts::SQRT_2,
    1.189_207_115_002_721,
    1.090_507_732_665_257_7,
];

/// Most steps of a search in one direction.
const STEPS: u32 = 10;

/// Legs on which motions are compared, with their knots spread.
///
/// While the speeds are chosen, the `duration_s` of a knot is the highest speed that all limits allow
/// where the speed is even, and `after` the highest of the motion that the average is taken of.
pub(super) struct Trial<'a, L: Legs> {
    limits: &'a Reciprocals<L::Axes>,
    /// Those of the motion that the average is taken of.
    eased: &'a Reciprocals<L::Axes>,
    legs: &'a Chain<L>,
    knots: &'a mut [Knot],
    /// The shortest window.
    shortest_s: f64,
    /// Those at the start and at the end of the fastest motion.
    accelerations: [f64; 2],
    /// Whether the knots have the speeds of the fastest motion along them.
    are_fastest: bool,
}

/// Fewest knots of which the second and the last but one can be placed.
const MIN_KNOTS: usize = 7;

/// The shortest window, relative to the time of the fastest motion: what it costs is nothing, and the
/// path within it has still ten digits.
const SHORTEST: f64 = 1e-5;

impl<'a, L: Legs> Trial<'a, L> {
    pub(super) fn new(
        [limits, eased]: [&'a Reciprocals<L::Axes>; 2],
        legs: &'a Chain<L>,
        knots: &'a mut [Knot],
    ) -> Self {
        Self {
            limits,
            eased,
            legs,
            knots,
            shortest_s: 0.0,
            accelerations: [0.0; 2],
            are_fastest: false,
        }
    }

    /// The average of the shortest time, and that time: of windows around the one given, without a cap
    /// and with one.
    pub(super) fn best(&mut self, window_s: f64) -> Result<(f64, Easing), PlanError<L::Error>> {
        let window_s = self.begin(window_s)?;
        let fastest = self.search(Easing {
            window_s,
            cap: None,
        })?;
        let capped = self.search(Easing {
            window_s,
            cap: Some(1.0),
        })?;
        Ok(if capped.0 < fastest.0 {
            capped
        } else {
            fastest
        })
    }

    /// The same near an average that was found with fewer knots, which see little of the jerk of a short
    /// window.
    pub(super) fn best_near(
        &mut self,
        found: Easing,
        window_s: f64,
    ) -> Result<(f64, Easing), PlanError<L::Error>> {
        let window_s = self.begin(window_s)?;
        let mut best = (self.time_s(found, f64::INFINITY)?, found);
        for cap in [None, Some(1.0)] {
            let next = Easing { window_s, cap };
            let time_s = self.time_s(next, best.0)?;
            if time_s < best.0 {
                best = (time_s, next);
            }
        }
        for factor in [COARSE].into_iter().chain(FINE) {
            self.improve(&mut best, Number::Window, factor)?;
        }
        Ok(best)
    }

    /// Prepares the knots; a window that is neither longer than the fastest motion nor so short that
    /// its ends cannot be told apart.
    fn begin(&mut self, window_s: f64) -> Result<f64, PlanError<L::Error>> {
        self.find_even_speeds()?;
        self.find_fastest()?;
        let fastest_s = self.unaveraged_s();
        self.shortest_s = fastest_s * SHORTEST;
        let length = self.knots.last().map_or(0.0, |knot| knot.s);
        let ends = [(2, 0.0), (self.knots.len().saturating_sub(3), length)];
        self.accelerations = ends.map(|(number, end)| {
            let knot = self.knots.get(number).copied().unwrap_or_default();
            knot.speed * knot.speed / (2.0 * (knot.s - end).abs())
        });
        Ok(window_s.min(fastest_s).max(self.shortest_s))
    }

    /// The time of the motion that the average is taken of.
    fn unaveraged_s(&self) -> f64 {
        self.knots.windows(2).fold(0.0, |sum, pair| match pair {
            [from, to] if to.s > 0.0 => sum + profile::segment_s(from, to),
            _ => sum,
        })
    }

    /// Puts the first knot of a single leg where the average reaches its acceleration, a w²/6 from the
    /// start, if that is before the second; the last one likewise.
    fn place_ends(&mut self, window_s: f64) {
        let count = self.knots.len();
        let length = self.knots.last().map_or(0.0, |knot| knot.s);
        if self.legs.count() != 1 || count < MIN_KNOTS {
            return;
        }
        let segments = f64::from(segments_of(self.knots));
        let [first, second] =
            [1.0, 2.0].map(|k| length * profile::fraction(k / segments, [true; 2]));
        let distances = self.accelerations.map(|acceleration| {
            let distance = acceleration * window_s * window_s / 6.0;
            if distance < second { distance } else { first }
        });
        let ends = [
            (1, distances[0]),
            (count.saturating_sub(2), length - distances[1]),
        ];
        for (number, s) in ends {
            if let Some(knot) = self.knots.get_mut(number) {
                self.are_fastest &= knot.s.to_bits() == s.to_bits();
                knot.s = s;
            }
        }
    }

    fn search(&mut self, start: Easing) -> Result<(f64, Easing), PlanError<L::Error>> {
        let mut best = (self.time_s(start, f64::INFINITY)?, start);
        self.improve(&mut best, Number::Window, COARSE)?;
        for factor in FINE {
            self.improve(&mut best, Number::Window, factor)?;
            if start.cap.is_some() {
                self.improve(&mut best, Number::Cap, factor)?;
            }
        }
        Ok(best)
    }

    /// Changes a number by a factor as long as the time becomes shorter.
    fn improve(
        &mut self,
        best: &mut (f64, Easing),
        number: Number,
        factor: f64,
    ) -> Result<(), PlanError<L::Error>> {
        let before_s = best.0;
        for factor in [1.0 / factor, factor] {
            for _ in 0..STEPS {
                let next = best.1.with(number, factor);
                let time_s = self.time_s(next, best.0)?;
                // Written so that NaN is no shorter.
                let is_shorter = time_s < best.0;
                if !is_shorter {
                    break;
                }
                *best = (time_s, next);
            }
            // Else the other direction leads back.
            if best.0 < before_s {
                break;
            }
        }
        Ok(())
    }

    /// The time that an average takes when it just keeps all limits; infinite where it is at least
    /// `most_s`.
    fn time_s(&mut self, easing: Easing, most_s: f64) -> Result<f64, PlanError<L::Error>> {
        if easing.window_s < self.shortest_s {
            return Ok(f64::INFINITY);
        }
        self.find_speeds(easing)?;
        let mut motion = Utilisation::new(self.limits, self.legs.forward(self.limits));
        let mut average = Average::new(easing.window_s, self.knots);
        let least_s = self.unaveraged_s() + easing.window_s;
        let (mut duration_s, mut stretch) = (0.0, 0.0_f64);
        for knot in &*self.knots {
            let [speed, segment_s] = average.next(self.knots);
            if knot.s > 0.0 && segment_s <= 0.0 {
                // Rounded away.
                return Ok(f64::INFINITY);
            }
            let segment = motion.next(Of::AxesAndTool, [knot.s, speed], segment_s)?;
            (duration_s, stretch) = (duration_s + segment_s, stretch.max(segment));
            if least_s * stretch >= most_s {
                return Ok(f64::INFINITY);
            }
        }
        Ok(duration_s * stretch.max(motion.stop_at_rest()))
    }

    /// Gives the knots the speeds and times of an average.
    pub(super) fn lay(&mut self, easing: Easing) -> Result<(), PlanError<L::Error>> {
        self.begin(easing.window_s)?;
        self.find_speeds(easing)?;
        let mut average = Average::new(easing.window_s, self.knots);
        for number in 0..self.knots.len() {
            let [speed, segment_s] = average.next(self.knots);
            if let Some(knot) = self.knots.get_mut(number) {
                knot.after = speed;
            }
            let before = number.checked_sub(1);
            if let Some(before) = before.and_then(|before| self.knots.get_mut(before)) {
                before.duration_s = segment_s;
            }
        }
        for knot in &mut *self.knots {
            (knot.speed, knot.after) = (knot.after, 0.0);
        }
        if let Some(last) = self.knots.last_mut() {
            last.duration_s = 0.0;
        }
        Ok(())
    }

    /// The highest speed at each knot that all limits allow on the segments beside it where the speed is
    /// even.
    fn find_even_speeds(&mut self) -> Result<(), PlanError<L::Error>> {
        let mut even = Utilisation::new(self.limits, self.legs.forward(self.limits));
        let mut before: Option<&mut Knot> = None;
        for (number, knot) in self.knots.iter_mut().enumerate() {
            let segment = knot.s - before.as_ref().map_or(0.0, |before| before.s);
            let stretch = even.next(Of::AxesAndTool, [knot.s, 1.0], segment)?;
            // The first segment begins at rest; where a leg begins there is none.
            let speed = if number > 1 && stretch > 0.0 {
                1.0 / stretch
            } else {
                LARGEST
            };
            knot.duration_s = speed;
            if let Some(before) = before {
                before.duration_s = before.duration_s.min(speed);
            }
            before = Some(knot);
        }
        Ok(())
    }

    fn find_fastest(&mut self) -> Result<(), PlanError<L::Error>> {
        if !self.are_fastest {
            profile::fastest_speeds(self.eased, self.legs, self.knots, profile::uncapped)?;
            self.are_fastest = true;
        }
        Ok(())
    }

    /// The speeds of the motion that the average is taken of.
    fn find_speeds(&mut self, easing: Easing) -> Result<(), PlanError<L::Error>> {
        self.place_ends(easing.window_s);
        let Some(cap) = easing.cap else {
            return self.find_fastest();
        };
        self.are_fastest = false;
        shape::hold_low_speeds(self.knots, cap, easing.window_s * 0.5);
        profile::fastest_speeds(self.eased, self.legs, self.knots, |knot| knot.after)?;
        shape::cut_tops(self.knots, easing.window_s);
        Ok(())
    }
}
