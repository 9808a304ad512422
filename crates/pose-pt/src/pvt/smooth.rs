//! Speeds along one leg whose jerk is limited.

use super::check::Shares;
use super::scurve::{SCurve, share};
use super::track::Track;
use super::{Knot, MIN_PARTS, leg, window};
use crate::Locator;
use crate::number::{cube_root, largest, sqrt};

/// Fills the knots of a leg, one more than parts, with the faster of an S-curve along the path
/// and the fastest motion without a limit of jerk, averaged over a window of time.
///
/// The S-curve is the shortest motion on a straight way; where the body turns far, its one
/// speed is that of the hardest place. The average over a time w lasts w longer than what it
/// is taken of, and a step of the acceleration by a becomes a jerk of a / w. Whatever either
/// asks of the axes besides is made up for by stretching its time.
pub(super) fn smooth<const N: usize>(
    locators: &[Locator; N],
    track: &Track<'_, N>,
    knots: &mut [Knot],
    parts: u32,
) {
    let curve = Easing::Curve(s_curve(locators, track));
    let mut trial = Trial {
        locators,
        eased: locators.map(eased),
        track,
        parts: parts.min(TRIAL_PARTS),
        knots,
    };
    let average = trial.best_average();
    trial.parts = parts;
    let least_s = trial.time(&curve) * (1.0 - LEAST_GAIN);
    // What is not a number is not faster.
    let is_faster = trial.time(&average) < least_s;
    if !is_faster {
        trial.lay(&curve);
    }
}

/// A locator whose axes accelerate no more than they need to where only speed and jerk are
/// limited: √(v j).
fn eased(mut locator: Locator) -> Locator {
    for limits in &mut locator.limits {
        if let Some(jerk) = limits.jerk {
            limits.acceleration = limits.acceleration.min(sqrt(limits.speed * jerk));
        }
    }
    locator
}

/// Parts that tell a faster motion from a slower one.
const TRIAL_PARTS: u32 = 128;

/// What an average must gain: the knots of an S-curve stand where its jerk changes, while few
/// knots see little of the jerk of an average.
const LEAST_GAIN: f64 = 0.01;

/// Windows that are tried: the whole time of the fastest motion, and halves of it.
const WINDOWS: u32 = 11;

/// Rounds in which the best window is refined, by a factor of √2 and roots of it.
const REFINEMENTS: u32 = 3;

/// A motion of limited jerk.
#[derive(Debug, Clone, Copy)]
enum Easing {
    Curve(SCurve),
    /// The fastest motion, of `fastest_s`, averaged over `window_s`.
    Average {
        fastest_s: f64,
        window_s: f64,
    },
}

fn lay_curve(curve: &SCurve, knots: &mut [Knot], parts: u32) {
    let mut rest = knots.iter_mut();
    curve.knots(parts, |motion, segment_s| {
        if let Some(knot) = rest.next() {
            *knot = Knot {
                s: motion.way,
                speed: motion.speed,
                segment_s,
                parts,
            };
        }
    });
}

/// A leg on which motions are compared.
struct Trial<'a, const N: usize> {
    locators: &'a [Locator; N],
    eased: [Locator; N],
    track: &'a Track<'a, N>,
    parts: u32,
    knots: &'a mut [Knot],
}

impl<const N: usize> Trial<'_, N> {
    fn lay(&mut self, easing: &Easing) {
        let (parts, knots) = (self.parts, &mut *self.knots);
        match easing {
            Easing::Curve(curve) => lay_curve(curve, knots, parts),
            Easing::Average {
                fastest_s,
                window_s,
            } => {
                let late = share(parts, *window_s / (*fastest_s + *window_s));
                let late = late.min(parts.saturating_sub(MIN_PARTS)).max(1);
                leg::fastest(&self.eased, self.track, knots, parts.saturating_sub(late));
                window::average(knots, parts, late, *window_s);
            }
        }
    }

    /// The time that a motion takes when it just keeps all limits.
    fn time(&mut self, easing: &Easing) -> f64 {
        self.lay(easing);
        let shares = Shares::of(self.locators, self.track, self.knots);
        self.duration_s() * shares.stretch()
    }

    fn duration_s(&self) -> f64 {
        let parts = usize::try_from(self.parts).unwrap_or(usize::MAX);
        let segments = self.knots.iter().take(parts);
        segments.fold(0.0, |sum, knot| sum + knot.segment_s)
    }

    /// The average with the window of the shortest time.
    fn best_average(&mut self) -> Easing {
        leg::fastest(&self.eased, self.track, self.knots, self.parts);
        let fastest_s = self.duration_s();
        let average = |window_s| Easing::Average {
            fastest_s,
            window_s,
        };
        let (mut window_s, mut best_s) = (fastest_s, self.time(&average(fastest_s)));
        let mut attempt = |trial: &mut Self, candidate: f64| {
            let time_s = trial.time(&average(candidate));
            if time_s < best_s {
                (window_s, best_s) = (candidate, time_s);
            }
            window_s
        };
        let mut candidate = fastest_s;
        let mut best = fastest_s;
        for _ in 1..WINDOWS {
            candidate *= 0.5;
            best = attempt(self, candidate);
        }
        let mut factor = core::f64::consts::SQRT_2;
        for _ in 0..REFINEMENTS {
            let middle = best;
            attempt(self, middle * factor);
            best = attempt(self, middle / factor);
            factor = sqrt(factor);
        }
        average(window_s)
    }
}

/// Places at which the slopes of a leg are looked at for its S-curve.
const SAMPLES: u32 = 64;

/// An S-curve whose limits keep those of the axes all along the leg.
///
/// ```text
/// q̇ = q' ṡ   q̈ = q″ ṡ² + q' s̈   q⃛ = q‴ ṡ³ + 3 q″ ṡ s̈ + q' s⃛
/// ```
///
/// The speed is taken so that q″ ṡ² uses at most half of the acceleration and q‴ ṡ³ a third
/// of the jerk, the acceleration so that its product uses at most another third; what is
/// left over is used. On a straight way q″ = q‴ = 0, and this is the shortest motion.
fn s_curve<const N: usize>(locators: &[Locator; N], track: &Track<'_, N>) -> SCurve {
    let derivatives = derivatives(track);
    let all = || {
        let limits = locators.iter().flat_map(|locator| &locator.limits);
        limits.zip(derivatives.iter().flatten())
    };
    let most = largest::<f64>();
    let speed = all().fold(most, |speed, (limits, [p1, p2, p3])| {
        let jerk = limits.jerk.unwrap_or(most);
        speed
            .min(limits.speed / *p1)
            .min(sqrt(limits.acceleration / (2.0 * *p2)))
            .min(cube_root(jerk / (3.0 * *p3)))
    });
    let acceleration = all().fold(most, |acceleration, (limits, [p1, p2, _])| {
        let jerk = limits.jerk.unwrap_or(most);
        acceleration
            .min((limits.acceleration - *p2 * speed * speed) / *p1)
            .min(jerk / (9.0 * *p2 * speed))
    });
    // Without an axis that limits it: a thousandth of the time that the way takes.
    let jerk = acceleration * sqrt(acceleration) * 1e3;
    let jerk = all().fold(jerk, |least, (limits, [p1, p2, p3])| match limits.jerk {
        Some(jerk) => {
            let used = *p3 * speed * speed * speed + 3.0 * *p2 * speed * acceleration;
            least.min((jerk - used) / *p1)
        }
        None => least,
    });
    SCurve::new(speed, acceleration, jerk)
}

/// The largest |q'|, |q″| and |q‴| of each axis, the latter two by differences; at least a
/// number that can be divided by.
fn derivatives<const N: usize>(track: &Track<'_, N>) -> [[[f64; 3]; 3]; N] {
    let samples = f64::from(SAMPLES);
    let mut most = [[[1.0 / largest::<f64>(); 3]; 3]; N];
    for index in 0..SAMPLES - 1 {
        let slope = |next: u32| track.place(f64::from(index + next) / samples).slope;
        let (first, second, third) = (slope(0), slope(1), slope(2));
        let values = first.iter().zip(second.iter().zip(&third));
        for (most, (first, (second, third))) in most.iter_mut().zip(values) {
            let values = first.iter().zip(second.iter().zip(third.iter()));
            for ([p1, p2, p3], (first, (second, third))) in most.iter_mut().zip(values) {
                let changes = [*second - *first, *third - *second].map(|change| change * samples);
                for slope in [*first, *second, *third] {
                    *p1 = p1.max(slope.abs());
                }
                for change in changes {
                    *p2 = p2.max(change.abs());
                }
                let [before, after] = changes;
                *p3 = p3.max(((after - before) * samples).abs());
            }
        }
    }
    most
}
