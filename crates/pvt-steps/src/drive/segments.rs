//! In how many segments a path is fast, whatever its tolerance.
//!
//! Many see changes of speed, few let a window see far. So an axis has as many of them on the way
//! that it needs to change its speed, and where the path turns by as much, wherever it does:
//!
//! ```text
//! n = max over axes of 48 |way| a / v^2 and 36 |turn of q'/v| / max |q'/v|
//! ```

use path_timing::{AxisLimits, Path};

/// Fewest segments: one up, one down.
const FEWEST: u32 = 2;

/// Fewest where jerk is limited: the acceleration comes and goes on the way up and on the way down,
/// and may jump between rows.
const FEWEST_WITH_JERK: u32 = 8;

/// Most segments where the tolerance asks for no more.
const MOST: u32 = 64;

/// Segments of the way v^2/a, twice what an axis brakes in from its full speed: a window of
/// 64 knots sees more than two such brakings, however short its paths are.
const SEGMENTS_OF_TWO_BRAKINGS: f64 = 48.0;

/// Segments of a turn in which an axis gains or loses its whole speed.
const SEGMENTS_OF_A_TURN: f64 = 36.0;

/// Parts of a path that are looked at for its length and turns.
const PARTS: u32 = 4;

/// The segments that a path is fast with: few where it is short and straight, so that the window
/// sees far, and more where speeds change along it; as many up as down, as a way from rest to rest
/// is fastest in its middle.
pub(super) fn at_least<P: Path<Axes = [f64; N]>, const N: usize>(
    path: &P,
    limits: &[AxisLimits; N],
) -> u32 {
    let has_jerk = limits.iter().any(|limit| limit.jerk.is_some());
    let fewest = if has_jerk { FEWEST_WITH_JERK } else { FEWEST };
    let mut axes = limits.map(AxisAlong::new);
    for part in 0..=PARTS {
        let s = path.length() * (f64::from(part) / f64::from(PARTS));
        // What is wrong there is found where its knots are laid.
        let Ok(point) = path.point(s) else {
            return fewest;
        };
        for (axis, at) in axes
            .iter_mut()
            .zip(point.position.into_iter().zip(point.slope))
        {
            axis.go_to(at);
        }
    }
    // No number, where a limit is none or nothing moves, is passed over.
    let steepest = axes.iter().map(|axis| axis.steepest).fold(0.0, f64::max);
    let wanted = axes
        .iter()
        .map(|axis| axis.segments(steepest))
        .fold(0.0, f64::max);
    (fewest..MOST)
        .step_by(2)
        .find(|&segments| f64::from(segments) >= wanted)
        .unwrap_or(MOST)
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
