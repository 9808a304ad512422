//! Speeds between two stops whose jerk is limited.

mod average;
mod scurve;
mod shape;
mod trial;

use core::iter;

use crate::chain::Chain;
use crate::leg::Leg;
use crate::number::{LARGEST, cube_root, sqrt};
use crate::planner::{knots_of, segments_of};
use crate::profile;
use crate::reciprocals::Reciprocals;
use crate::utilisation::{Of, stretch};
use crate::{Axes, AxisLimits, Knot, Legs, Path, PlanError, ToolLimits};
pub(crate) use scurve::PHASES;
use scurve::SCurve;
use trial::Trial;

/// Something of each axis of a path.
type EachAxis<P, T> = <<P as Path>::Axes as Axes>::Of<T>;

/// The limits of all axes of a path.
type LimitsOf<P> = EachAxis<P, AxisLimits>;

/// Gives the knots of the legs between two stops, spread already, the speeds and times of a motion that
/// just keeps all limits: the fastest without a limit of jerk, averaged over a window of time; where
/// that is faster, that of each leg alone, from rest to rest.
pub(crate) fn smooth<L: Legs>(
    limits: &LimitsOf<L::Leg>,
    reciprocals: &Reciprocals<L::Axes>,
    legs: &Chain<L>,
    knots: &mut [Knot],
) -> Result<(), PlanError<L::Error>> {
    if legs.count() == 1 {
        smooth_leg(limits, reciprocals, legs, knots)?;
        return Ok(());
    }
    let (window_s, eased) = eased::<L::Leg>(limits);
    let trial_limits = [reciprocals, &Reciprocals::new(&eased)];
    let (least_s, best) = Trial::new(trial_limits, legs, knots).best(window_s)?;
    let (mut alone_s, mut is_faster) = (0.0, false);
    for (leg, own) in legs.forward(reciprocals).zip(profile::by_leg(knots)) {
        let leg = leg?;
        let alone = Chain::new(iter::once(leg.path().clone()), leg.number);
        alone_s += smooth_leg(limits, reciprocals, &alone, own)?;
        // What is not a number is not faster; the legs that are left only take longer.
        is_faster = least_s <= alone_s;
        if is_faster {
            break;
        }
    }
    if !is_faster {
        return Ok(());
    }
    for (leg, own) in legs.forward(reciprocals).zip(profile::by_leg(knots)) {
        profile::spread(own, leg?.length(), [true; 2]);
    }
    Trial::new(trial_limits, legs, knots).lay(best)?;
    keep_limits(reciprocals, legs, knots)?;
    Ok(())
}

/// Gives the knots of a leg, one more than segments, the faster of an S-curve along it and of an
/// average, from rest to rest. Its time.
///
/// The S-curve is the shortest motion on a straight path; where the axes turn far, its one
/// speed is that of the hardest point. The average over a time w lasts w longer than what it
/// is taken of, and a step of the acceleration by a becomes a jerk of a / w. Whatever either
/// asks of the axes besides is made up for by stretching its time.
pub(crate) fn smooth_leg<L: Legs>(
    limits: &LimitsOf<L::Leg>,
    reciprocals: &Reciprocals<L::Axes>,
    leg: &Chain<L>,
    knots: &mut [Knot],
) -> Result<f64, PlanError<L::Error>> {
    let Some(only) = leg.forward(reciprocals).next().transpose()? else {
        return Ok(0.0);
    };
    let (window_s, eased) = eased::<L::Leg>(limits);
    let trial_limits = [reciprocals, &Reciprocals::new(&eased)];
    let few = segments_of(knots).min(TRIAL_SEGMENTS);
    let few = profile::split(knots, knots_of(few)).0;
    profile::spread(few, only.length(), [true; 2]);
    let (mut average_s, mut best) = Trial::new(trial_limits, leg, few).best(window_s)?;
    if segments_of(knots) > TRIAL_SEGMENTS {
        profile::spread(knots, only.length(), [true; 2]);
        let mut trial = Trial::new(trial_limits, leg, knots);
        (average_s, best) = trial.best_near(best, window_s)?;
    }
    let curve = s_curve(limits, &only)?;
    lay_curve(&curve, knots, only.length());
    let mut curve_s = keep_limits(reciprocals, leg, knots)?;
    if !are_apart(knots) {
        curve_s = f64::INFINITY;
    }
    // What is not a number is not faster.
    if average_s < curve_s * (1.0 - LEAST_GAIN) {
        profile::spread(knots, only.length(), [true; 2]);
        Trial::new(trial_limits, leg, knots).lay(best)?;
        return keep_limits(reciprocals, leg, knots);
    }
    Ok(curve_s)
}

/// Stretches a motion so that it just keeps all limits. Its time.
fn keep_limits<L: Legs>(
    limits: &Reciprocals<L::Axes>,
    legs: &Chain<L>,
    knots: &mut [Knot],
) -> Result<f64, PlanError<L::Error>> {
    let stretch = stretch(limits, legs, knots, Of::AxesAndTool)? * STRETCHED;
    Ok(knots.iter_mut().fold(0.0, |sum, knot| {
        knot.speed /= stretch;
        knot.duration_s *= stretch;
        sum + knot.duration_s
    }))
}

/// Whether the parameters and the times of all knots of a leg are distinct numbers.
fn are_apart(knots: &[Knot]) -> bool {
    let mut time_s = 0.0;
    knots.windows(2).all(|pair| {
        let before_s = time_s;
        let [from, to] = pair else { return false };
        time_s += from.duration_s;
        time_s > before_s && to.s > from.s
    })
}

/// Relative rounding of a stretched motion.
const STRETCHED: f64 = 1.0 + 64.0 * f64::EPSILON;

/// Limits by which axes accelerate no more than they need to where only speed and jerk are
/// limited, √(v j), and the longest time in which an axis reaches its acceleration.
fn eased<P: Path>(limits: &LimitsOf<P>) -> (f64, LimitsOf<P>) {
    let (mut eased, mut window_s) = (*limits, 0.0_f64);
    for limits in P::Axes::each_mut(&mut eased) {
        if let Some(jerk) = limits.jerk {
            limits.acceleration = limits.acceleration.min(sqrt(limits.speed * jerk));
            window_s = window_s.max(limits.acceleration / jerk);
        }
    }
    (window_s, eased)
}

/// Segments that tell a faster motion from a slower one on a single leg.
const TRIAL_SEGMENTS: u32 = 128;

/// What an average must gain: the knots of an S-curve stand where its jerk changes, while few
/// knots see little of the jerk of an average.
const LEAST_GAIN: f64 = 0.01;

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

/// Points of a leg at which its slopes are computed for its S-curve.
const SAMPLES: u32 = 64;

/// An S-curve whose limits keep those of the axes all along the leg.
///
/// ```text
/// q̇ = q' ṡ   q̈ = q″ ṡ² + q' s̈   q⃛ = q‴ ṡ³ + 3 q″ ṡ s̈ + q' s⃛
/// ```
///
/// The speed is taken so that q″ ṡ² uses at most half of the acceleration and q‴ ṡ³ a third
/// of the jerk, the acceleration so that its product uses at most another third; what is
/// left over is used. On a straight path q″ = q‴ = 0, and this is the shortest motion.
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
    let slope = |index: u32| Ok(leg.checked_point(f64::from(index) * step)?.slope);
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
