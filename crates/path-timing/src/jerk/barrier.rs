//! What the speeds at the knots ask of each limit, with derivatives by these speeds.

use crate::knot::ToolTimes;
use crate::reciprocals::Reciprocals;
use crate::segment::Segment;
use crate::{Axes, Knot};

/// How a utilisation grows with all speeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Degree {
    Speed,
    Acceleration,
    Jerk,
}

/// A part of a limit that is used, -1 to 1, and its derivatives by the speeds at consecutive knots:
/// both ends of a segment, and with three of them the one before.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Utilisation<const KNOTS: usize> {
    pub(super) value: f64,
    pub(super) by: [f64; KNOTS],
    pub(super) degree: Degree,
}

/// What takes utilisations and times into account.
pub(crate) trait Barrier {
    /// Of a segment.
    fn limit(&mut self, utilisation: &Utilisation<2>);
    /// Of what an acceleration changes by where a segment begins, or from the middle of the one
    /// before to its own.
    fn step(&mut self, utilisation: &Utilisation<3>);
    /// The length of a segment and the speeds at its ends.
    fn time(&mut self, ds: f64, speeds: [f64; 2]);
}

/// The acceleration of an axis at an end of a segment or in its middle, as a part of its limit, with
/// derivatives by the speeds at both ends.
#[derive(Debug, Clone, Copy)]
struct Acceleration {
    value: f64,
    by: [f64; 2],
}

impl Acceleration {
    const NONE: Self = Self {
        value: 0.0,
        by: [0.0; 2],
    };

    /// ```text
    /// a = c y + d z = W (c W + d D) / 4      W = w₀ + w₁, D = w₁ - w₀
    /// ```
    fn new([c, d]: [f64; 2], [w0, w1]: [f64; 2]) -> Self {
        let (sum, rise) = (w0 + w1, w1 - w0);
        let (by_sum, by_rise) = ((2.0 * c * sum + d * rise) * 0.25, d * sum * 0.25);
        Self {
            value: sum * (c * sum + d * rise) * 0.25,
            by: [by_sum - by_rise, by_sum + by_rise],
        }
    }

    /// In the middle of a segment, from those at its ends.
    fn middle(from: &Self, to: &Self) -> Self {
        Self {
            value: (from.value + to.value) * 0.5,
            by: [(from.by[0] + to.by[0]) * 0.5, (from.by[1] + to.by[1]) * 0.5],
        }
    }

    /// Beside what passing an end of the segment at its speed asks for, by what the path bends there.
    ///
    /// ```text
    /// a - c w²
    /// ```
    fn beside(mut self, bend: f64, end: usize, speeds: [f64; 2]) -> Self {
        if let (Some(by), Some(speed)) = (self.by.get_mut(end), speeds.get(end)) {
            self.value -= bend * speed * speed;
            *by -= 2.0 * bend * speed;
        }
        self
    }

    const fn utilisation(&self) -> Utilisation<2> {
        Utilisation {
            value: self.value,
            by: self.by,
            degree: Degree::Acceleration,
        }
    }
}

/// The segment before, from which the acceleration goes on: at its end, and in its middle.
#[derive(Debug, Clone, Copy)]
struct Before<A: Axes> {
    accelerations: A::Of<[Acceleration; 2]>,
    ds: f64,
    speeds: [f64; 2],
}

/// A segment with the speeds at its ends.
pub(crate) struct Moving<'a, A: Axes> {
    limits: &'a Reciprocals<A>,
    segment: Segment<A>,
    ds: f64,
    pub(super) speeds: [f64; 2],
    /// Highest speeds at both ends.
    caps: [f64; 2],
    /// Whether accelerations begin, and end, beside a rest or a jump.
    eased: [bool; 2],
    before: Option<Before<A>>,
    /// The knots of the three speeds, the first where there is a segment before.
    pub(super) knots: [usize; 3],
}

/// Least part of a limit of jerk that is left by rounding.
const LEAST_LIMIT: f64 = 0.5;

/// The segments one after the other, at speeds that the caller says.
pub(crate) struct Walk<A: Axes> {
    tool_times: ToolTimes,
    /// The knot where the next segment begins, and the speed there.
    index: usize,
    speed: f64,
    before: Option<Before<A>>,
    node_before: usize,
}

impl<A: Axes> Walk<A> {
    /// From the knot of a number, passed at a speed.
    pub(crate) const fn new(index: usize, speed: f64) -> Self {
        Self {
            tool_times: ToolTimes::ONE,
            index,
            speed,
            before: None,
            node_before: index,
        }
    }

    /// With the limits of the tool multiplied.
    pub(crate) fn with_tool_times(self, tool_times: ToolTimes) -> Self {
        Self { tool_times, ..self }
    }

    /// The number of the knot where the next segment ends.
    pub(crate) fn next_knot(&self, knots: &[Knot<A>]) -> Option<usize> {
        let next = self.index.saturating_add(1);
        let next = next.saturating_add(usize::from(is_jump(knots, next)));
        (next < knots.len()).then_some(next)
    }

    /// The segment to the next knot, passed at a speed.
    pub(crate) fn advance<'a>(
        &mut self,
        limits: &'a Reciprocals<A>,
        knots: &[Knot<A>],
        speed: f64,
    ) -> Option<Moving<'a, A>> {
        let next = self.next_knot(knots)?;
        let index = next.saturating_sub(1);
        // At a jump the speed is that of the knot before it.
        let from_jump = is_jump(knots, index);
        let node = index.saturating_sub(usize::from(from_jump));
        let (from, to) = (knots.get(index)?, knots.get(next)?);
        let segment = Segment::new(limits, from, to, self.tool_times);
        let moving = Moving {
            limits,
            segment,
            ds: to.ds,
            speeds: [self.speed, speed],
            caps: [from.cap, to.cap],
            eased: [
                self.speed <= 0.0 || from_jump,
                speed <= 0.0 || is_jump(knots, next.saturating_add(1)),
            ],
            before: self.before,
            knots: [self.node_before, node, next],
        };
        self.before = (!moving.eased[1]).then(|| moving.end());
        (self.node_before, self.index, self.speed) = (node, next, speed);
        Some(moving)
    }
}

/// Whether velocities jump at a knot.
fn is_jump<A: Axes>(knots: &[Knot<A>], index: usize) -> bool {
    index > 0 && knots.get(index).is_some_and(|knot| knot.ds <= 0.0)
}

impl<A: Axes> Moving<'_, A> {
    /// The accelerations with which the segment ends, and those in its middle.
    fn end(&self) -> Before<A> {
        let mut accelerations = A::filled([Acceleration::NONE; 2]);
        let loads = A::each(self.segment.axes());
        for (places, load) in A::each_mut(&mut accelerations).iter_mut().zip(loads) {
            let [from, to] = load
                .accelerations
                .map(|terms| Acceleration::new(terms, self.speeds));
            *places = [to, Acceleration::middle(&from, &to)];
        }
        Before {
            accelerations,
            ds: self.ds,
            speeds: self.speeds,
        }
    }

    /// Hands all limits that concern the segment, and the knot where it begins, to the barrier.
    pub(crate) fn visit(&self, barrier: &mut impl Barrier) {
        let [w0, w1] = self.speeds;
        barrier.time(self.ds, self.speeds);
        self.visit_speeds(barrier);
        let tool = Acceleration::new(self.segment.tool(), self.speeds);
        barrier.limit(&tool.utilisation());
        let axes = A::each(self.segment.axes()).iter().zip(self.limits.axes());
        let between = self.before.as_ref().filter(|_| !self.eased[0]);
        let between = between.map(|before| (before, Rate::between(before, self)));
        for (axis, (load, limits)) in axes.enumerate() {
            // What rounding may add: a part of the limit that is not there.
            let sum = w0 + w1;
            let noise = load.noise * sum * sum * 0.25;
            let inverse = 1.0 / (1.0 - noise);
            let ends = load
                .accelerations
                .map(|terms| Acceleration::new(terms.map(|term| term * inverse), self.speeds));
            for end in &ends {
                barrier.limit(&end.utilisation());
            }
            // The jerk as a part of its limit is this times that of the acceleration by the time.
            let time_s = limits.jerk / limits.acceleration;
            if time_s > 0.0 {
                let bends = load.accelerations.map(|[bend, _]| bend);
                self.visit_jerk(&ends, bends, [time_s, noise], barrier);
                if let Some((before, rate)) = &between
                    && let Some(earlier) = A::each(&before.accelerations).get(axis)
                {
                    let [start, end] = &ends;
                    let here = [*start, Acceleration::middle(start, end)];
                    for (earlier, here) in earlier.iter().zip(&here) {
                        barrier.step(&rate.step([earlier, here], [time_s, noise]));
                    }
                }
            }
        }
    }

    fn visit_speeds(&self, barrier: &mut impl Barrier) {
        let [w0, w1] = self.speeds;
        let mut speed = |[e, f]: [f64; 2]| {
            barrier.limit(&Utilisation {
                value: e * w0 + f * w1,
                by: [e, f],
                degree: Degree::Speed,
            });
        };
        let [from, to] = self.segment.ends();
        let [from_cap, to_cap] = self.caps;
        if w0 > 0.0 {
            speed([from.max(1.0 / from_cap), 0.0]);
        }
        if w1 > 0.0 {
            speed([0.0, to.max(1.0 / to_cap)]);
        }
        for load in A::each(self.segment.axes()) {
            speed(load.middle);
        }
    }

    /// The jerk inside, and where accelerations begin or end: at a rest from or to zero, at a jump
    /// from or to what the path's bend asks for there, b = c w².
    ///
    /// ```text
    /// inside (a₁ - a₀) / T     at the end (a - b) / (T / 2)     T = 2Δs / (w₀ + w₁)
    /// ```
    fn visit_jerk(
        &self,
        [start, end]: &[Acceleration; 2],
        bends: [f64; 2],
        [time_s, noise]: [f64; 2],
        barrier: &mut impl Barrier,
    ) {
        let [w0, w1] = self.speeds;
        let sum = w0 + w1;
        let mut over_time = |step: Acceleration, rate: f64| {
            let rate = with_noise(rate, 2.0 * noise * rate * sum);
            barrier.limit(&Utilisation {
                value: step.value * sum * rate,
                by: step.by.map(|by| (by * sum + step.value) * rate),
                degree: Degree::Jerk,
            });
        };
        let rate = time_s * 0.5 / self.ds;
        let inside = Acceleration {
            value: end.value - start.value,
            by: [end.by[0] - start.by[0], end.by[1] - start.by[1]],
        };
        over_time(inside, rate);
        let middle = Acceleration::middle(start, end);
        let places = [*start, *end].into_iter().zip(self.eased).zip(bends);
        for (at, ((own, is_eased), bend)) in places.enumerate() {
            if is_eased {
                for acceleration in [own, middle] {
                    over_time(acceleration.beside(bend, at, self.speeds), rate * 2.0);
                }
            }
        }
    }
}

/// A rate with what rounding may add to two accelerations, as a part of the limit: 1 / (1 - z) ≤
/// 1 + 2z up to z = 1/2.
fn with_noise(rate: f64, noise: f64) -> f64 {
    rate * (1.0 + 2.0 * noise.min(LEAST_LIMIT))
}

/// One over the time between the middles of two segments, and its derivatives by the sums of the
/// speeds at the ends of each.
///
/// ```text
/// 1 / ((T₋ + T) / 2) = W₋ W / (Δs₋ W + Δs W₋)     W = w₀ + w₁
/// ```
#[derive(Debug, Clone, Copy)]
struct Rate {
    value: f64,
    by_before: f64,
    by_here: f64,
}

impl Rate {
    fn between<A: Axes>(before: &Before<A>, here: &Moving<'_, A>) -> Self {
        let [[wb, wa], [w0, w1]] = [before.speeds, here.speeds];
        let (sum_before, sum) = (wb + wa, w0 + w1);
        let inverse = 1.0 / (before.ds * sum + here.ds * sum_before);
        Self {
            value: sum_before * sum * inverse,
            by_before: before.ds * (sum * inverse) * (sum * inverse),
            by_here: here.ds * (sum_before * inverse) * (sum_before * inverse),
        }
    }

    /// The step from an acceleration to the next, as a jerk.
    fn step(&self, [from, to]: [&Acceleration; 2], [time_s, noise]: [f64; 2]) -> Utilisation<3> {
        let factor = with_noise(time_s, 4.0 * noise * time_s * self.value);
        let (step, rate) = (to.value - from.value, self.value * factor);
        let [by_before, by_here] = [self.by_before, self.by_here].map(|by| step * by * factor);
        Utilisation {
            value: step * rate,
            by: [
                by_before - from.by[0] * rate,
                by_before + by_here + (to.by[0] - from.by[1]) * rate,
                by_here + to.by[1] * rate,
            ],
            degree: Degree::Jerk,
        }
    }
}
