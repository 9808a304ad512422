//! What the edges of an axis prove of its motion.

/// A quantity, and by how much it may be off.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[expect(clippy::exhaustive_structs, reason = "two numbers of one unit")]
pub struct Measured {
    /// The best estimate.
    pub value: f64,
    /// Off by that at most, either way.
    pub uncertainty: f64,
}

impl Measured {
    /// What is certain of it.
    #[must_use]
    pub fn proven(&self) -> f64 {
        (self.value - self.uncertainty).max(0.0)
    }

    /// The same in another unit.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            uncertainty: self.uncertainty * factor,
        }
    }

    fn keep_larger(&mut self, other: Self) {
        if other.proven() > self.proven() {
            *self = other;
        }
    }
}

/// The largest start speed, speed, speed jump and acceleration of an axis, from its edges alone.
///
/// An edge says that the axis passes k + 1/2 steps, within the deviation that the makers of the
/// edges state; between edges it is within half a step of k. By finite differences over 1 to 64
/// steps, with their uncertainty:
/// ```text
/// speed                    (q1 - q0) / T                 ± 2 d / T
/// start speed              the same, after no step for 20 ms or after a reversal
/// speed jump               (q2 - q1)/T2 - (q1 - q0)/T1   ± 2 d (1/T1 + 1/T2)
/// acceleration             (q2 - 2 q1 + q0) / T²         ± (4 d + 1/2) / T²
/// ```
/// Of each, that is kept of which most is proven. By the mean value theorem no motion through these
/// places has a smaller largest speed or acceleration than is proven.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct EdgeMotion {
    /// In steps a second.
    pub start_speed: Measured,
    /// In steps a second.
    pub speed: Measured,
    /// In steps a second: from a few steps to the next few.
    pub speed_jump: Measured,
    /// In steps/s².
    pub acceleration: Measured,
}

/// Steps over which differences are taken.
const SPANS: [usize; 13] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 40, 48, 64];
/// An axis that has not stepped for longer stands.
const REST_S: f64 = 0.02;

/// The edges of one axis, as they come.
///
/// # Examples
/// ```
/// use machine_sim::EdgeLog;
/// // 1000 steps/s from rest at once, then from rest by 10,000 steps/s².
/// let mut jump = EdgeLog::new();
/// let mut ramp = EdgeLog::new();
/// for k in 0..200_u32 {
///     let place = f64::from(k) + 0.5;
///     jump.step(1.0 + place / 1000.0, 1);
///     ramp.step(1.0 + (2.0 * place / 10_000.0).sqrt(), 1);
/// }
/// let [jump, ramp] = [jump, ramp].map(|log| log.motion(0.0));
/// assert!((jump.start_speed.value - 1000.0).abs() < 1e-6);
/// assert!(jump.acceleration.proven() > 200_000.0);
/// assert!(ramp.start_speed.value < 140.0);
/// ```
#[derive(Debug, Clone, Default)]
pub struct EdgeLog {
    /// Time in s, and steps after the edge.
    edges: Vec<(f64, i32)>,
}

impl EdgeLog {
    /// An axis that stands.
    #[must_use]
    pub const fn new() -> Self {
        Self { edges: Vec::new() }
    }

    /// A step at a time, not before the last one: up for a number above 0, down for one below.
    pub fn step(&mut self, time_s: f64, direction: i32) {
        let steps = self.edges.last().map_or(0, |&(_, steps)| steps);
        self.edges.push((time_s, steps + direction.signum()));
    }

    /// The edges: time in s and steps after each.
    #[must_use]
    pub fn edges(&self) -> &[(f64, i32)] {
        &self.edges
    }

    /// What they prove, if each is at most `deviation_steps` off the place that it stands for.
    #[must_use]
    pub fn motion(&self, deviation_steps: f64) -> EdgeMotion {
        let mut motion = EdgeMotion::default();
        // So many steps that half of them is certain.
        let few = SPANS
            .into_iter()
            .find(|&span| as_f64(span) >= 4.0 * deviation_steps);
        let few = few.unwrap_or(64);
        for (index, place) in self.places().enumerate() {
            for span in SPANS {
                let Some(next) = index.checked_add(span).and_then(|to| self.place(to)) else {
                    break;
                };
                let speed = place.speed_to(next, deviation_steps);
                motion.speed.keep_larger(speed.size());
                if span == few && self.is_start(index) {
                    motion.start_speed.keep_larger(speed.size());
                }
                let Some(last) = index.checked_sub(span).and_then(|from| self.place(from)) else {
                    continue;
                };
                if span == few {
                    let before = last.speed_to(place, deviation_steps);
                    motion.speed_jump.keep_larger(speed.minus(before).size());
                }
            }
            for acceleration in self.accelerations(index, place, deviation_steps) {
                motion.acceleration.keep_larger(acceleration);
            }
        }
        motion
    }

    /// By an edge `span` steps away on one side, and as far in time on the other.
    fn accelerations(
        &self,
        index: usize,
        place: Place,
        deviation: f64,
    ) -> impl Iterator<Item = Measured> {
        let beside = move |span: usize| {
            let [after, before] = [index.checked_add(span), index.checked_sub(span)];
            // At an even speed the other side is an edge too.
            [(after, before), (before, after)]
        };
        SPANS
            .into_iter()
            .flat_map(beside)
            .filter_map(move |(at, opposite)| {
                let side = self.place(at?)?;
                let span_s = side.time_s - place.time_s;
                let other = self.steps_at(place.time_s - span_s, opposite.unwrap_or(0));
                let difference = side.steps - 2.0 * place.steps + other;
                (span_s != 0.0).then(|| Measured {
                    value: difference.abs() / (span_s * span_s),
                    uncertainty: (4.0 * deviation + 0.5) / (span_s * span_s),
                })
            })
    }

    fn places(&self) -> impl Iterator<Item = Place> {
        (0..self.edges.len()).filter_map(|index| self.place(index))
    }

    /// What an edge passes.
    fn place(&self, index: usize) -> Option<Place> {
        let &(time_s, after) = self.edges.get(index)?;
        let before = match index.checked_sub(1) {
            Some(last) => self.edges.get(last)?.1,
            None => 0,
        };
        Some(Place {
            time_s,
            steps: f64::midpoint(f64::from(before), f64::from(after)),
        })
    }

    /// Whether the axis stands or turns round before an edge.
    fn is_start(&self, index: usize) -> bool {
        let (Some(place), Some(last)) = (
            self.place(index),
            index.checked_sub(1).and_then(|last| self.place(last)),
        ) else {
            return true;
        };
        place.time_s - last.time_s > REST_S || (place.steps - last.steps).abs() < 0.5
    }

    /// The whole steps at a time, which is likely near an edge.
    fn steps_at(&self, time_s: f64, likely: usize) -> f64 {
        const NEAR: usize = 4;
        let is_over = |edge: &(f64, i32)| edge.0 <= time_s;
        let first = likely.saturating_sub(NEAR).min(self.edges.len());
        let (before, from) = self.edges.split_at(first);
        let near = from.get(..2 * NEAR).unwrap_or(from);
        let over = near.partition_point(is_over);
        let is_near =
            (over > 0 || before.is_empty()) && (over < near.len() || near.len() == from.len());
        let over = if is_near {
            first + over
        } else {
            self.edges.partition_point(is_over)
        };
        let last = over.checked_sub(1).and_then(|last| self.edges.get(last));
        last.map_or(0.0, |&(_, steps)| f64::from(steps))
    }
}

#[derive(Debug, Clone, Copy)]
struct Place {
    time_s: f64,
    steps: f64,
}

impl Place {
    fn speed_to(self, next: Self, deviation_steps: f64) -> Measured {
        let span_s = next.time_s - self.time_s;
        Measured {
            value: (next.steps - self.steps) / span_s,
            uncertainty: 2.0 * deviation_steps / span_s,
        }
    }
}

impl Measured {
    fn minus(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            uncertainty: self.uncertainty + other.uncertainty,
        }
    }

    fn size(self) -> Self {
        Self {
            value: self.value.abs(),
            ..self
        }
    }
}

fn as_f64(span: usize) -> f64 {
    // At most 64.
    u8::try_from(span).map_or(f64::INFINITY, f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// The edges of q(t) = 400 (1 - cos 5 t) for two swings, some of them `late` steps too late.
    fn swing(late: f64) -> EdgeLog {
        let (mut log, mut steps, mut random) = (EdgeLog::new(), 0, Random::new(1));
        let mut half = 0.5;
        for k in 0..2_513_274_u32 {
            let time_s = f64::from(k) * 1e-6;
            let place = 400.0 * (1.0 - (5.0 * time_s).cos());
            let off = place - f64::from(steps);
            if off.abs() > half {
                let direction = if off > 0.0 { 1 } else { -1 };
                steps += direction;
                log.step(time_s, direction);
                half = if random.happens(0.5) { 0.5 + late } else { 0.5 };
            }
        }
        log
    }

    /// Never more than there is, and not much less: 400 · 5 steps/s, 400 · 5² steps/s².
    #[test]
    fn what_is_proven_of_a_swing() {
        for (late, speed, acceleration) in [(0.0, 0.995, 0.95), (0.3, 0.97, 0.85)] {
            // A microsecond at the greatest speed.
            let motion = swing(late).motion(late + 0.002);
            let of_speed = motion.speed.proven() / 2000.0;
            let of_acceleration = motion.acceleration.proven() / 10_000.0;
            assert!((speed..=1.0).contains(&of_speed), "{of_speed}");
            assert!(
                (acceleration..=1.0).contains(&of_acceleration),
                "{of_acceleration}"
            );
            // The first steps from rest: sqrt(a).
            assert!(motion.start_speed.proven() < 160.0, "{motion:?}");
            assert!(motion.speed_jump.proven() < 160.0, "{motion:?}");
        }
    }

    #[test]
    fn an_axis_that_stands_or_makes_one_step_proves_nothing() {
        let mut log = EdgeLog::new();
        assert_eq!(log.motion(0.0), EdgeMotion::default());
        log.step(1.0, -1);
        assert_eq!(log.motion(0.0), EdgeMotion::default());
        assert_eq!(log.edges(), [(1.0, -1)]);
    }

    #[test]
    fn a_corner_is_a_jump() {
        let mut log = EdgeLog::new();
        for k in 0..100_u32 {
            log.step(f64::from(k) * 1e-3, 1);
        }
        for k in 1..100_u32 {
            log.step(0.099 + f64::from(k) * 0.5e-3, -1);
        }
        let motion = log.motion(0.0);
        assert!((motion.speed.value - 2000.0).abs() < 1e-6);
        // The first step back crosses the place of the last one up.
        assert!(
            (1900.0..3001.0).contains(&motion.speed_jump.value),
            "{motion:?}"
        );
        assert!(motion.acceleration.proven() > 500_000.0);
    }
}
