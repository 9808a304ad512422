//! Speeds at the knots with limits of jerk.
//!
//! Goal: from the fastest speeds without a limit of jerk those that keep one too, in about the
//! least time. Method: an interior point. With x = w² at each knot, accelerations are nearly linear
//! in x and jerks concern three neighbours, so
//!
//! ```text
//! F(x) = t ΣT + Σ -log(1 - g²) + Σ -log x / 10      g: each utilisation of a limit, T: the time of each segment
//! ```
//!
//! has a Newton system of five diagonals, solved in one sweep. Every step stays inside all limits
//! and makes F smaller; t grows until the logarithms cost next to nothing. What is measured at the
//! end is the cubics themselves, and all speeds are scaled so that the tightest limit is just kept.

mod barrier;
mod newton;
mod stream;

use core::ops::Range;

use crate::number::{cube_root, sqrt};
use crate::passes::segment_s;
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot};
pub(crate) use barrier::Walk;
use barrier::{Barrier, Degree, Moving, Utilisation};
pub(crate) use stream::{Extension, extend};

/// Slows the fastest speeds so that all limits of jerk are kept.
pub(crate) fn smooth<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>]) {
    for_each_run(knots, |run| {
        go_inside(limits, run);
        let weight = centre(limits, run, 0);
        let all = 0..run.len();
        let weight = approach(limits, run, all.clone(), weight, TABLE_GAP);
        descend(limits, run, &all, weight, SETTLED);
        scale(run, 1.0 / tightest(limits, run));
    });
}

/// Calls a function with the knots from each rest to the next, where there is a speed to choose.
fn for_each_run<A: Axes>(knots: &mut [Knot<A>], mut act: impl FnMut(&mut [Knot<A>])) {
    let mut rest = knots;
    while rest.len() > 1 {
        let last = next_rest(rest);
        if let Some(run) = rest.get_mut(..=last).filter(|_| last > 1) {
            act(run);
        }
        (_, rest) = rest.split_at_mut(last.min(rest.len()));
    }
}

/// The number of the next knot at rest behind the first, else of the last.
fn next_rest<A: Axes>(knots: &[Knot<A>]) -> usize {
    let rest = knots.iter().skip(1).position(|knot| knot.speed <= 0.0);
    rest.map_or(knots.len().saturating_sub(1), |rest| rest.saturating_add(1))
}

/// Slows a motion so that no limit is quite used.
fn go_inside<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>]) {
    let slower = INSIDE / tightest(limits, knots);
    scale(knots, slower.min(INSIDE));
}

/// The least F with a small weight, with the first `fixed` speeds as they are. The weight.
fn centre<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>], fixed: usize) -> f64 {
    let weight = weight_of(knots, FIRST_GAP);
    let all = fixed..knots.len();
    descend(limits, knots, &all, weight, CENTRED);
    weight
}

/// From the least F with a weight to the fastest speeds, but for a part of the time, of the knots
/// in a range. The last weight.
fn approach<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &mut [Knot<A>],
    range: Range<usize>,
    mut weight: f64,
    last_gap: f64,
) -> f64 {
    let last_weight = weight_of(knots, last_gap);
    // Written so that NaN ends it.
    while weight < last_weight {
        let growth = GROWTH.min(last_weight / weight);
        weight *= growth;
        newton::step(limits, knots, &range, [weight, growth]);
        descend(limits, knots, &range, weight, CENTRED);
    }
    weight
}

/// Newton steps to the least F.
fn descend<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &mut [Knot<A>],
    range: &Range<usize>,
    weight: f64,
    centred: f64,
) {
    let enough = as_f64(range.end.saturating_sub(range.start)) * centred;
    for _ in 0..STEPS {
        let promised = newton::step(limits, knots, range, [weight, 1.0]);
        // Written so that NaN ends it.
        let goes_on = promised > enough;
        if !goes_on {
            break;
        }
    }
}

/// The weight with which a limit at each knot may cost a part of the time.
fn weight_of<A: Axes>(knots: &[Knot<A>], gap: f64) -> f64 {
    let total_s = knots.windows(2).fold(0.0, |sum, pair| match pair {
        [from, to] => sum + segment_s(from, to),
        _ => sum,
    });
    as_f64(knots.len()) / (total_s * gap)
}

fn as_f64(count: usize) -> f64 {
    u32::try_from(count).map_or(f64::INFINITY, f64::from)
}

/// The part of the time that a limit at each knot may cost at the end of a table's search.
const TABLE_GAP: f64 = 2e-4;

/// Most Newton steps with one weight.
const STEPS: u32 = 50;

/// Twice the decrease of F that a whole step promises for each knot, at which it is the last.
const CENTRED: f64 = 0.2;

/// The same at the end of a table's search, whose answer is not to hang on the rounding of the way
/// there.
const SETTLED: f64 = 0.001;

/// Where the search begins, as a fraction of the tightest limit.
const INSIDE: f64 = 0.95;

/// The fraction of the time that a limit at each knot may cost at the beginning.
const FIRST_GAP: f64 = 0.1;

/// By how much the weight of the time grows from one search to the next.
const GROWTH: f64 = 6.0;

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
    visit_all(limits, knots, speed_of, |segment| {
        segment.visit(&mut most);
        true
    });
    most.stretch
}

/// Calls a function with each segment at the speeds of its knots, as long as it says so.
fn visit_all<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &[Knot<A>],
    speed_of: impl Fn(&Knot<A>) -> f64,
    mut goes_on: impl FnMut(&Moving<'_, A>) -> bool,
) {
    let mut walk = Walk::new(0, knots.first().map_or(0.0, &speed_of));
    while let Some(next) = walk.next_knot(knots) {
        let speed = knots.get(next).map_or(0.0, &speed_of);
        let segment = walk.advance(limits, knots, speed);
        if !segment.is_some_and(|segment| goes_on(&segment)) {
            break;
        }
    }
}

/// The largest factor of the time that a limit asks for.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Most {
    pub(crate) stretch: f64,
}

impl Most {
    fn raise<const KNOTS: usize>(&mut self, utilisation: &Utilisation<KNOTS>) {
        let value = utilisation.value.abs();
        let stretch = match utilisation.degree {
            Degree::Speed => value,
            Degree::Acceleration => sqrt(value),
            Degree::Jerk => cube_root(value),
        };
        self.stretch = self.stretch.max(stretch);
    }
}

impl Barrier for Most {
    fn limit(&mut self, utilisation: &Utilisation<2>) {
        self.raise(utilisation);
    }

    fn step(&mut self, utilisation: &Utilisation<3>) {
        self.raise(utilisation);
    }

    fn time(&mut self, _: f64, _: [f64; 2]) {}
}
