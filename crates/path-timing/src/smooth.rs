//! Speeds along one leg whose jerk is limited.

mod average;
mod scurve;

use crate::demand::Demand;
use crate::leg::Leg;
use crate::number::{LARGEST, cube_root, sqrt};
use crate::planner::{MIN_SEGMENTS, knots_of};
use crate::profile;
use crate::reciprocals::Reciprocals;
use crate::{Axes, AxisLimits, Knot, Path, PlanError, ToolLimits};
pub(crate) use scurve::PHASES;
use scurve::{SCurve, part};

/// Something of each axis of a path.
type EachAxis<P, T> = <<P as Path>::Axes as Axes>::Of<T>;

/// The limits of all axes of a path.
type LimitsOf<P> = EachAxis<P, AxisLimits>;

/// Fills the knots of a leg, one more than segments, with the faster of an S-curve along the path
/// and the fastest motion without a limit of jerk, averaged over a window of time.
///
/// The S-curve is the shortest motion on a straight path; where the axes turn far, its one
/// speed is that of the hardest point. The average over a time w lasts w longer than what it
/// is taken of, and a step of the acceleration by a becomes a jerk of a / w. Whatever either
/// asks of the axes besides is made up for by stretching its time.
pub(crate) fn smooth<P: Path>(
    limits: &LimitsOf<P>,
    reciprocals: &Reciprocals<P::Axes>,
    leg: &Leg<P>,
    knots: &mut [Knot],
) -> Result<(), PlanError<P::Error>> {
    let curve = Easing::Curve(s_curve(limits, leg)?);
    let segments = segments_of(knots);
    let mut trial = Trial {
        limits: reciprocals,
        eased: Reciprocals::new(&eased::<P>(limits)),
        leg,
        segments: segments.min(TRIAL_SEGMENTS),
        knots,
    };
    let average = trial.best_average()?;
    trial.segments = segments;
    let least_s = trial.time(&curve)? * (1.0 - LEAST_GAIN);
    // What is not a number is not faster.
    let is_faster = trial.time(&average)? < least_s;
    if !is_faster {
        trial.lay(&curve)?;
    }
    Ok(())
}

/// One fewer than knots.
fn segments_of(knots: &[Knot]) -> u32 {
    u32::try_from(knots.len().saturating_sub(1)).unwrap_or(u32::MAX)
}

/// Limits by which axes accelerate no more than they need to where only speed and jerk are
/// limited: √(v j).
fn eased<P: Path>(limits: &LimitsOf<P>) -> LimitsOf<P> {
    let mut eased = *limits;
    for limits in P::Axes::each_mut(&mut eased) {
        if let Some(jerk) = limits.jerk {
            limits.acceleration = limits.acceleration.min(sqrt(limits.speed * jerk));
        }
    }
    eased
}

/// Segments that tell a faster motion from a slower one.
const TRIAL_SEGMENTS: u32 = 128;

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

fn lay_curve(curve: &SCurve, knots: &mut [Knot], length: f64) {
    let segments = segments_of(knots);
    let mut rest = knots.iter_mut();
    curve.knots(segments, |motion, duration_s| {
        if let Some(knot) = rest.next() {
            *knot = Knot {
                s: length * motion.fraction,
                speed: length * motion.speed,
                duration_s,
                after: 0.0,
            };
        }
    });
}

/// A leg on which motions are compared.
struct Trial<'a, P: Path> {
    limits: &'a Reciprocals<P::Axes>,
    eased: Reciprocals<P::Axes>,
    leg: &'a Leg<P>,
    /// As many of the knots, and one, are laid.
    segments: u32,
    knots: &'a mut [Knot],
}

impl<P: Path> Trial<'_, P> {
    fn lay(&mut self, easing: &Easing) -> Result<(), PlanError<P::Error>> {
        let segments = self.segments;
        match easing {
            Easing::Curve(curve) => {
                lay_curve(curve, first(self.knots, segments), self.leg.length());
                Ok(())
            }
            Easing::Average {
                fastest_s,
                window_s,
            } => {
                let late = part(segments, *window_s / (*fastest_s + *window_s));
                let late = late.min(segments.saturating_sub(MIN_SEGMENTS)).max(1);
                let moving = first(self.knots, segments.saturating_sub(late));
                profile::fastest(&self.eased, self.leg, moving)?;
                average::average(
                    first(self.knots, segments),
                    late,
                    *window_s,
                    self.leg.length(),
                );
                Ok(())
            }
        }
    }

    /// The time that a motion takes when it just keeps all limits.
    fn time(&mut self, easing: &Easing) -> Result<f64, PlanError<P::Error>> {
        self.lay(easing)?;
        let knots = first(self.knots, self.segments);
        let demand = Demand::of(self.limits, self.leg, knots)?;
        Ok(duration_s(knots) * demand.stretch())
    }

    /// The average with the window of the shortest time.
    fn best_average(&mut self) -> Result<Easing, PlanError<P::Error>> {
        let knots = first(self.knots, self.segments);
        profile::fastest(&self.eased, self.leg, knots)?;
        let fastest_s = duration_s(knots);
        let average = |window_s| Easing::Average {
            fastest_s,
            window_s,
        };
        let (mut window_s, mut best_s) = (fastest_s, self.time(&average(fastest_s))?);
        let mut attempt = |trial: &mut Self, candidate: f64| {
            let time_s = trial.time(&average(candidate))?;
            if time_s < best_s {
                (window_s, best_s) = (candidate, time_s);
            }
            Ok(window_s)
        };
        let mut candidate = fastest_s;
        let mut best = fastest_s;
        for _ in 1..WINDOWS {
            candidate *= 0.5;
            best = attempt(self, candidate)?;
        }
        let mut factor = core::f64::consts::SQRT_2;
        for _ in 0..REFINEMENTS {
            let middle = best;
            attempt(self, middle * factor)?;
            best = attempt(self, middle / factor)?;
            factor = sqrt(factor);
        }
        Ok(average(window_s))
    }
}

/// The first knots, one more than segments.
fn first(knots: &mut [Knot], segments: u32) -> &mut [Knot] {
    profile::split(knots, knots_of(segments)).0
}

/// Seconds of a leg's segments; the last knot has none.
fn duration_s(knots: &[Knot]) -> f64 {
    knots.iter().fold(0.0, |sum, knot| sum + knot.duration_s)
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
fn s_curve<P: Path>(limits: &LimitsOf<P>, leg: &Leg<P>) -> Result<SCurve, PlanError<P::Error>> {
    let derivatives = derivatives(leg)?;
    let tool = leg.tool().map(as_axis);
    let all = || {
        let axes = P::Axes::each(limits)
            .iter()
            .zip(P::Axes::each(&derivatives));
        axes.chain(tool.iter().zip([&STRAIGHT]))
    };
    let speed = all().fold(LARGEST, |speed, (limits, [p1, p2, p3])| {
        let jerk = limits.jerk.unwrap_or(LARGEST);
        speed
            .min(limits.speed / *p1)
            .min(sqrt(limits.acceleration / (2.0 * *p2)))
            .min(cube_root(jerk / (3.0 * *p3)))
    });
    let acceleration = all().fold(LARGEST, |acceleration, (limits, [p1, p2, _])| {
        let jerk = limits.jerk.unwrap_or(LARGEST);
        acceleration
            .min((limits.acceleration - *p2 * speed * speed) / *p1)
            .min(jerk / (9.0 * *p2 * speed))
    });
    // Without an axis that limits it: a thousandth of the time that the path takes.
    let jerk = acceleration * sqrt(acceleration / leg.length()) * 1e3;
    let jerk = all().fold(jerk, |least, (limits, [p1, p2, p3])| match limits.jerk {
        Some(jerk) => {
            let used = *p3 * speed * speed * speed + 3.0 * *p2 * speed * acceleration;
            least.min((jerk - used) / *p1)
        }
        None => least,
    });
    let [speed, acceleration, jerk] = [speed, acceleration, jerk].map(|limit| limit / leg.length());
    Ok(SCurve::new(speed, acceleration, jerk))
}

/// Derivatives of the tool's arc length by itself.
const STRAIGHT: [f64; 3] = [1.0, 1.0 / LARGEST, 1.0 / LARGEST];

/// The tool as an axis that moves by the parameter.
fn as_axis(tool: &ToolLimits) -> AxisLimits {
    AxisLimits {
        speed: tool.feed,
        acceleration: tool.acceleration.unwrap_or(LARGEST),
        jerk: None,
    }
}

/// The largest |q'|, |q″| and |q‴| of each axis, the latter two by differences; at least a
/// number that can be divided by.
fn derivatives<P: Path>(leg: &Leg<P>) -> Result<EachAxis<P, [f64; 3]>, PlanError<P::Error>> {
    let step = leg.length() / f64::from(SAMPLES);
    let mut largest = P::Axes::filled([1.0 / LARGEST; 3]);
    let slope = |index: u32| Ok(leg.checked_place(f64::from(index) * step)?.slope);
    let (mut first, mut second) = (slope(0)?, slope(1)?);
    for index in 2..=SAMPLES {
        let third = slope(index)?;
        let slopes = (first.as_slice().iter()).zip(second.as_slice().iter().zip(third.as_slice()));
        for ([p1, p2, p3], (a, (b, c))) in P::Axes::each_mut(&mut largest).iter_mut().zip(slopes) {
            let [before, after] = [*b - *a, *c - *b].map(|change| change / step);
            *p1 = p1.max(a.abs()).max(b.abs()).max(c.abs());
            *p2 = p2.max(before.abs()).max(after.abs());
            *p3 = p3.max(((after - before) / step).abs());
        }
        (first, second) = (second, third);
    }
    Ok(largest)
}
