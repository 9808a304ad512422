//! In how many segments a path is fast, whatever its tolerance.
//!
//! Many see changes of speed, few let a window see far. So an axis has as many of them on the way
//! that it needs to change its speed, and where the path turns by as much, wherever it does:
//!
//! ```text
//! n = max over axes of 48 |way| a / v^2 and 36 |turn of q'/v| / max |q'/v|
//! ```
//!
//! from 2 to 64, from 8 on where it begins at rest under a limit of jerk.

use path_timing::{AxisLimits, Corner, Path, PathPoint};

/// Fewest segments: one up, one down.
const FEWEST: u32 = 2;

/// Fewest from rest where jerk is limited: the acceleration comes and goes on the way up and on the
/// way down, and may jump at the ends.
const FEWEST_WITH_JERK: u32 = 8;

/// Difference of slopes that is rounding, as the planner has it: with more a corner is a stop.
const SMOOTH: f64 = 1e-9;

/// Most segments where the tolerance asks for no more.
const MOST: u32 = 64;

/// Segments of the way v^2/a, twice what an axis brakes in from its full speed: a window of
/// 64 knots sees more than two such brakings, however short its paths are.
const SEGMENTS_OF_TWO_BRAKINGS: f64 = 48.0;

/// Segments of a turn in which an axis gains or loses its whole speed.
const SEGMENTS_OF_A_TURN: f64 = 36.0;

/// Places of a path that are looked at for its length and turns.
const PLACES: usize = 5;

/// Paths one after the other, and the segments that each is fast with: few where it is short and
/// straight, so that the window sees far, and more where speeds change along it; as many up as
/// down, as a way from rest to rest is fastest in its middle.
pub(super) struct FewestSegments<const N: usize> {
    limits: [AxisLimits; N],
    /// The slope that the last path goes on with.
    goes_on: Option<[f64; N]>,
}

impl<const N: usize> FewestSegments<N> {
    pub(super) const fn new(limits: [AxisLimits; N]) -> Self {
        let goes_on = None;
        Self { limits, goes_on }
    }

    /// The fewest segments of the next path.
    pub(super) fn of<P: Path<Axes = [f64; N]>>(&mut self, path: &P) -> u32 {
        let before = self.goes_on.take();
        let Some(places) = places(path) else {
            return FEWEST;
        };
        let mut axes = self.limits.map(AxisAlong::new);
        for place in places {
            let place = place.position.into_iter().zip(place.slope);
            for (axis, at) in axes.iter_mut().zip(place) {
                axis.go_to(at);
            }
        }
        let [start, .., end] = places;
        // No number, where a limit is none or nothing moves, is passed over.
        let steepest = axes.iter().map(|axis| axis.steepest).fold(0.0, f64::max);
        let is_passed = before.is_some_and(|slope| {
            let slopes = slope.into_iter().zip(start.slope);
            let mut apart = self.limits.iter().zip(slopes);
            apart.all(|(limit, (p0, p1))| (p1 - p0).abs() <= SMOOTH * steepest * limit.speed)
        });
        self.goes_on = matches!(path.corner(), Corner::Smooth).then_some(end.slope);
        let has_jerk = self.limits.iter().any(|limit| limit.jerk.is_some());
        let fewest = if has_jerk && !is_passed {
            FEWEST_WITH_JERK
        } else {
            FEWEST
        };
        let wanted = axes.iter().map(|axis| axis.segments(steepest));
        let wanted = wanted.fold(0.0, f64::max);
        (fewest..MOST)
            .step_by(2)
            .find(|&segments| f64::from(segments) >= wanted)
            .unwrap_or(MOST)
    }
}

/// Evenly along a path. What is wrong there is found and told where its knots are laid.
fn places<P: Path>(path: &P) -> Option<[PathPoint<P::Axes>; PLACES]> {
    let mut places = [path.point(0.0).ok()?; PLACES];
    for (place, u) in places.iter_mut().zip([0.0, 0.25, 0.5, 0.75, 1.0]).skip(1) {
        *place = path.point(path.length() * u).ok()?;
    }
    Some(places)
}

/// An axis along a path: its way, and its speeds relative to its limit at unit speed of the path.
struct AxisAlong {
    limit: AxisLimits,
    last: Option<(f64, f64)>,
    way: f64,
    turn: f64,
    steepest: f64,
}

impl AxisAlong {
    const fn new(limit: AxisLimits) -> Self {
        Self {
            limit,
            last: None,
            way: 0.0,
            turn: 0.0,
            steepest: 0.0,
        }
    }

    /// On to a position and slope.
    fn go_to(&mut self, (position, slope): (f64, f64)) {
        let speed = slope / self.limit.speed;
        if let Some((from, before)) = self.last.replace((position, speed)) {
            self.way += (position - from).abs();
            self.turn += (speed - before).abs();
        }
        self.steepest = self.steepest.max(speed.abs());
    }

    /// The segments for its way and its turns, where the fastest axis has this speed.
    fn segments(&self, steepest: f64) -> f64 {
        let AxisLimits {
            speed,
            acceleration,
            ..
        } = self.limit;
        let of_way = SEGMENTS_OF_TWO_BRAKINGS * self.way * acceleration / (speed * speed);
        of_way.max(SEGMENTS_OF_A_TURN * self.turn / steepest)
    }
}
