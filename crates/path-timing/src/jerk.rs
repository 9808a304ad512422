//! Speeds at the knots with limits of jerk.
//!
//! Goal: from the fastest speeds without a limit of jerk those that keep one too, in about the least
//! time. Method: an interior point. With x = w² at each knot, accelerations are nearly linear in x and
//! jerks concern three neighbours, so
//!
//! ```text
//! F(x) = t ΣT + Σ -log(1 - g²)      g: each utilisation of a limit, T: the time of each segment
//! ```
//!
//! has a Newton system of five diagonals, solved in one sweep. Every step stays inside all limits and
//! makes F smaller; t grows until the logarithms cost next to nothing. What is measured at the end is
//! the cubics themselves, and all speeds are scaled so that the tightest limit is just kept.

mod barrier;
mod newton;

use crate::number::{cube_root, sqrt};
use crate::passes::segment_s;
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot};
pub(crate) use barrier::Walk;
use barrier::{Barrier, Degree, Moving, Utilisation};
pub(crate) use newton::Equation;

/// Slows the fastest speeds so that all limits of jerk are kept.
pub(crate) fn smooth<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>]) {
    let mut rest = knots;
    while rest.len() > 1 {
        let stop = rest.iter().skip(1).position(|knot| knot.speed <= 0.0);
        let last = stop.map_or(rest.len(), |stop| stop.saturating_add(1));
        let (moving, _) = rest.split_at_mut(last.saturating_add(1).min(rest.len()));
        // From a rest to the next knot at rest there is no speed to choose.
        if moving.iter().any(|knot| knot.speed > 0.0) {
            smooth_moving(limits, moving);
        }
        (_, rest) = rest.split_at_mut(last.min(rest.len()));
    }
}

/// The same from rest to rest, with no rest between.
fn smooth_moving<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>]) {
    let slower = INSIDE / tightest(limits, knots);
    scale(knots, slower.min(INSIDE));
    let total_s = knots.windows(2).fold(0.0, |sum, pair| match pair {
        [from, to] => sum + segment_s(from, to),
        _ => sum,
    });
    let count = u32::try_from(knots.len()).map_or(f64::INFINITY, f64::from);
    let mut weight = count / (total_s * FIRST_GAP);
    let last_weight = count / (total_s * LAST_GAP);
    loop {
        for _ in 0..STEPS {
            let decrease = newton::step(limits, knots, weight);
            // Written so that NaN ends it.
            let goes_on = decrease > count * CENTRED;
            if !goes_on {
                break;
            }
        }
        // Written so that NaN ends it.
        let goes_on = weight < last_weight;
        if !goes_on {
            break;
        }
        weight = (weight * GROWTH).min(last_weight);
    }
    scale(knots, 1.0 / tightest(limits, knots));
}

/// Where the search begins, as a fraction of the tightest limit.
const INSIDE: f64 = 0.95;

/// Fractions of the time that a limit at each knot may cost, at the beginning and at the end.
const FIRST_GAP: f64 = 0.1;
const LAST_GAP: f64 = 2e-4;

/// By how much the weight of the time grows from one search to the next.
const GROWTH: f64 = 6.0;

/// Most Newton steps of a search.
const STEPS: u32 = 8;

/// Decrease of F by a step, for each knot, at which the search goes on with a greater weight.
const CENTRED: f64 = 0.01;

/// Relative rounding of scaled speeds.
const ROUNDING: f64 = 1.0 - 64.0 * f64::EPSILON;

fn scale<A: Axes>(knots: &mut [Knot<A>], factor: f64) {
    for knot in knots {
        knot.speed *= factor * ROUNDING;
    }
}

/// The factor of the time with which all limits are just kept.
fn tightest<A: Axes>(limits: &Reciprocals<A>, knots: &[Knot<A>]) -> f64 {
    let mut most = Most::default();
    let speed_of = |knot: &Knot<A>| knot.speed;
    visit_all(limits, knots, speed_of, |segment| segment.visit(&mut most));
    most.stretch
}

/// Calls a function with each segment at the speeds of its knots.
fn visit_all<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &[Knot<A>],
    speed_of: impl Fn(&Knot<A>) -> f64,
    mut visit: impl FnMut(&Moving<'_, A>),
) {
    let mut walk = Walk::new(0, knots.first().map_or(0.0, &speed_of));
    while let Some(next) = walk.next_knot(knots) {
        let speed = knots.get(next).map_or(0.0, &speed_of);
        if let Some(segment) = walk.advance(limits, knots, speed) {
            visit(&segment);
        }
    }
}

/// The largest factor of the time that a limit asks for.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Most {
    pub(crate) stretch: f64,
}

impl Barrier for Most {
    fn limit(&mut self, utilisation: &Utilisation) {
        let value = utilisation.value.abs();
        let stretch = match utilisation.degree {
            Degree::Speed => value,
            Degree::Acceleration => sqrt(value),
            Degree::Jerk => cube_root(value),
        };
        self.stretch = self.stretch.max(stretch);
    }

    fn time(&mut self, _: f64, _: [f64; 2]) {}
}
