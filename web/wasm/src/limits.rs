//! What limits a timed run at any time: of each axis the speed and the acceleration, where its load
//! is known the torque, and of the tool along its path speed and acceleration, as parts of what
//! they may be.
//!
//! Axes that are shaped keep all of their own limits, but the tool on them does not: its feed is
//! that of the fastest curve that is still felt, and there is no limit of its acceleration.
//!
//! ```text
//! Between two rows, at a time t after the first, of a duration T:
//! q = p₀ + v₀ t + a t² + b t³     a = (3c - 2v₀ - v₁) / T    b = (v₀ + v₁ - 2c) / T²    c = (p₁ - p₀) / T
//! ```

use known_load::TorqueUsed;

use crate::answer::Answer;

/// Looks between two rows: fewer where there are many rows.
const LOOKS: u32 = 3;
const MANY_ROWS: usize = 50_000;
/// In shorter rows the rounding of times, of a minute 7e-15 s, shows as an acceleration.
const SHORT_S: f64 = 1e-5;
/// The part of a row over which the tool's speed is taken.
const NEAR_PART: f64 = 0.01;

/// The end of a row of D axes.
pub(crate) struct RowEnd<const D: usize> {
    pub(crate) time_s: f64,
    pub(crate) position: [f64; D],
    pub(crate) velocity: [f64; D],
    /// The line, motion or stroke of the input.
    pub(crate) source: usize,
    /// What the tool may do along the curve that it ends on.
    pub(crate) tool: ToolMay,
    /// No row comes before it, or another one that it does not go on from.
    pub(crate) is_first: bool,
}

/// What an axis may do, per second and second².
#[derive(Clone, Copy)]
pub(crate) struct AxisMay {
    pub(crate) speed: f64,
    pub(crate) acceleration: f64,
}

/// What the tool may do along its path, in mm/s and mm/s².
#[derive(Clone, Copy)]
pub(crate) struct ToolMay {
    pub(crate) feed: f64,
    pub(crate) acceleration: Option<f64>,
}

struct Cubic<const D: usize> {
    duration_s: f64,
    /// Of each axis the coefficients of t⁰ to t³.
    coefficients: [[f64; 4]; D],
}

impl<const D: usize> Cubic<D> {
    fn between(from: &RowEnd<D>, to: &RowEnd<D>) -> Option<Self> {
        let duration_s = to.time_s - from.time_s;
        if to.is_first || duration_s < SHORT_S {
            return None;
        }
        let mut coefficients = [[0.0; 4]; D];
        let ends = from.position.iter().zip(to.position);
        let speeds = from.velocity.iter().zip(to.velocity);
        for ((it, (p0, p1)), (v0, v1)) in coefficients.iter_mut().zip(ends).zip(speeds) {
            let mean = (p1 - p0) / duration_s;
            let square = (3.0 * mean - 2.0 * v0 - v1) / duration_s;
            let cube = (v0 + v1 - 2.0 * mean) / (duration_s * duration_s);
            *it = [*p0, *v0, square, cube];
        }
        Some(Self {
            duration_s,
            coefficients,
        })
    }

    fn position(&self, t: f64) -> [f64; D] {
        self.coefficients
            .map(|[p, v, a, b]| p + t * (v + t * (a + t * b)))
    }
}

/// What a run has beside its rows.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a, const D: usize> {
    /// How long shaped rows still have of the motion before, in s.
    pub(crate) shaping_s: f64,
    pub(crate) torque: Option<&'a TorqueUsed<D>>,
}

/// Adds the looks to an answer: `looks` has their times in s, `shares` for each the number of the
/// row, the source, feed and acceleration that the tool may have, and the parts: of the speeds of
/// all axes, their accelerations, where they are known their torques, feed and acceleration of the
/// tool; no number where there is no such limit.
///
/// `place` is where the tool is, in mm.
pub(crate) fn add_to<const D: usize>(
    answer: Answer,
    rows: &[RowEnd<D>],
    axes: [AxisMay; D],
    known: Known<'_, D>,
    place: impl Fn([f64; D]) -> Option<[f64; 3]>,
) -> Answer {
    let looks = if rows.len() > MANY_ROWS { 1 } else { LOOKS };
    let (mut times, mut shares) = (Vec::new(), Vec::new());
    let mut torque = known.torque.map(Torque::new);
    for (number, (from, to)) in (1_u32..).zip(rows.iter().zip(rows.iter().skip(1))) {
        let Some(cubic) = Cubic::between(from, to) else {
            continue;
        };
        for look in 0..looks {
            let t = cubic.duration_s * (f64::from(look) + 0.5) / f64::from(looks);
            times.push(from.time_s + t);
            let (feed, most) = if known.shaping_s > 0.0 {
                (felt(rows, number, known.shaping_s), f64::NAN)
            } else {
                (to.tool.feed, to.tool.acceleration.unwrap_or(f64::NAN))
            };
            shares.extend([f64::from(number), to.source as f64, feed, most]);
            shares.extend(
                cubic
                    .coefficients
                    .iter()
                    .zip(axes)
                    .map(|([_, v, a, b], axis)| {
                        (v + t * (2.0 * a + t * 3.0 * b)).abs() / axis.speed
                    }),
            );
            shares.extend(
                cubic
                    .coefficients
                    .iter()
                    .zip(axes)
                    .map(|([_, _, a, b], axis)| (2.0 * a + t * 6.0 * b).abs() / axis.acceleration),
            );
            if let Some(torque) = &mut torque {
                shares.extend(torque.at(from.time_s + t));
            }
            let [speed, acceleration] = along(&cubic, t, &place);
            shares.extend([speed / feed, acceleration / most]);
        }
    }
    #[expect(clippy::cast_possible_truncation, reason = "shown with three digits")]
    let shares = shares.into_iter().map(|it: f64| (it as f32).to_le_bytes());
    answer
        .with_numbers("looks", times.into_iter().map(f64::to_le_bytes))
        .with_numbers("shares", shares)
}

/// The highest feed of the curves that are felt in the row of a number: that of the first row has
/// none.
fn felt<const D: usize>(rows: &[RowEnd<D>], number: u32, shaping_s: f64) -> f64 {
    let until = rows.get(..=number as usize).unwrap_or_default();
    let begin_s = until.iter().rev().nth(1).map_or(0.0, |row| row.time_s);
    let felt = until.iter().rev();
    let felt = felt.take_while(|row| row.time_s >= begin_s - shaping_s);
    felt.filter(|row| row.tool.feed.is_finite())
        .fold(0.0, |most, row| most.max(row.tool.feed))
}

/// The parts of what is planned of the motors, at times that rise.
struct Torque<const D: usize> {
    /// At both ends of segments.
    parts: Vec<(f64, [f64; D])>,
    /// The first that is not before the last time.
    next: usize,
}

impl<const D: usize> Torque<D> {
    fn new(used: &TorqueUsed<D>) -> Self {
        let planned = used.planned();
        let parts = used.over_time();
        Self {
            parts: parts
                .map(|(t_s, parts)| (t_s, parts.map(|part| part / planned)))
                .collect(),
            next: 0,
        }
    }

    /// Evenly between the ends of a segment.
    fn at(&mut self, t_s: f64) -> [f64; D] {
        let later = self.parts.get(self.next..).unwrap_or_default();
        self.next += later.iter().take_while(|(end_s, _)| *end_s < t_s).count();
        let from = self.next.checked_sub(1).and_then(|at| self.parts.get(at));
        let (Some((a_s, a)), Some((b_s, b))) = (from, self.parts.get(self.next)) else {
            return [f64::NAN; D];
        };
        let part = (t_s - a_s) / (b_s - a_s);
        let mut parts = *a;
        for (here, end) in parts.iter_mut().zip(b) {
            *here += (end - *here) * part;
        }
        parts
    }
}

/// Speed, and the size of the mean acceleration along the path from row to row, which is what
/// planners limit, in mm/s and mm/s².
fn along<const D: usize>(
    cubic: &Cubic<D>,
    t: f64,
    place: &impl Fn([f64; D]) -> Option<[f64; 3]>,
) -> [f64; 2] {
    let by = cubic.duration_s * NEAR_PART;
    let end = cubic.duration_s - by;
    let speed = |t: f64| {
        let [from, to] = [t, t + by].map(|t| place(cubic.position(t)));
        Some(distance(from?, to?) / by)
    };
    let [Some(first), Some(now), Some(last)] = [0.0, t - by / 2.0, end].map(speed) else {
        return [f64::NAN; 2];
    };
    [now, (last - first).abs() / end]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}
