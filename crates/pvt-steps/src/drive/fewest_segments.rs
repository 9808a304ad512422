//! In how many segments a path is fast, whatever its tolerance.
//!
//! Many see changes of speed, few let a window see far. So an axis has as many of them on the way
//! that it needs to change its speed, and where the path turns by as much, wherever it does:
//!
//! ```text
//! n = max over axes of 48 |way| a / v^2 and 36 |turn of q'/v| / max |q'/v|
//! ```
//!
//! from 2 to 64; on the way no more than a tool asks for that brakes by its own acceleration, from
//! the path's highest speed. Where it begins or ends next to rest, at a stop or beside a sharp turn
//! of another path, its speed rises or falls on it, however short it is: from 8 on, where both from
//! 12 on.

use path_timing::{AxisLimits, Corner, Path, PathPoint, Span, ToolLimits};

/// Fewest segments: one up, one down.
const FEWEST: u32 = 2;

/// Fewest from a slow end, or to one; where jerk is limited the acceleration comes and goes on the
/// way.
const FEWEST_AT_SLOW_END: u32 = 8;

/// Fewest from one to the other.
const FEWEST_BETWEEN_SLOW_ENDS: u32 = 12;

/// Segments of a turn that is sharp: a path beside it is slow where they meet.
const SHARP: f64 = 24.0;

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

/// Paths one after the other, each with the segments that it is fast with: few where it is short
/// and straight, so that the window sees far, and more where speeds change along it; as many up as
/// down, as a way from rest to rest is fastest in its middle.
pub(super) struct FewestSegments<I: Iterator, const N: usize> {
    limits: [AxisLimits; N],
    paths: I,
    before: Option<Shape<N>>,
    next: Option<(I::Item, Shape<N>)>,
}

/// A path with the fewest segments that it is fast with.
pub(super) struct Counted<P> {
    pub(super) path: P,
    pub(super) fewest: u32,
}

/// What is seen of a path.
#[derive(Clone, Copy)]
struct Shape<const N: usize> {
    slopes: [[f64; N]; 2],
    is_smooth: bool,
    /// Speed of the fastest axis, relative to its limit, at unit speed of the path.
    steepest: f64,
    /// Segments for its turns, and for its ways as well.
    of_turns: f64,
    of_all: f64,
}

impl<P: Path<Axes = [f64; N]>, I: Iterator<Item = P>, const N: usize> FewestSegments<I, N> {
    pub(super) fn new(limits: [AxisLimits; N], paths: I) -> Self {
        let mut segments = Self {
            limits,
            paths,
            before: None,
            next: None,
        };
        segments.look_ahead();
        segments
    }

    fn look_ahead(&mut self) {
        self.next = self.paths.next().map(|path| {
            let shape = Shape::of(&self.limits, &path);
            (path, shape)
        });
    }

    /// Whether a path goes on to the next one without a stop.
    fn goes_on(&self, from: &Shape<N>, to: &Shape<N>) -> bool {
        let ([_, end], [start, _]) = (from.slopes, to.slopes);
        let mut axes = self.limits.iter().zip(end.into_iter().zip(start));
        from.is_smooth
            && axes.all(|(limit, (p0, p1))| (p1 - p0).abs() <= SMOOTH * to.steepest * limit.speed)
    }
}

impl<P: Path<Axes = [f64; N]>, I: Iterator<Item = P>, const N: usize> Iterator
    for FewestSegments<I, N>
{
    type Item = Counted<P>;

    fn next(&mut self) -> Option<Counted<P>> {
        let (path, shape) = self.next.take()?;
        self.look_ahead();
        let begins_slowly =
            (self.before).is_none_or(|before| before.is_sharp() || !self.goes_on(&before, &shape));
        let ends_slowly = (self.next.as_ref())
            .is_none_or(|(_, next)| next.is_sharp() || !self.goes_on(&shape, next));
        self.before = Some(shape);
        let fewest = match [begins_slowly, ends_slowly] {
            [true, true] => FEWEST_BETWEEN_SLOW_ENDS,
            [false, false] => FEWEST,
            _ => FEWEST_AT_SLOW_END,
        };
        let fewest = (fewest..MOST)
            .step_by(2)
            .find(|&segments| f64::from(segments) >= shape.of_all)
            .unwrap_or(MOST);
        Some(Counted { path, fewest })
    }
}

impl<const N: usize> Shape<N> {
    fn of<P: Path<Axes = [f64; N]>>(limits: &[AxisLimits; N], path: &P) -> Self {
        let is_smooth = matches!(path.corner(), Corner::Smooth);
        let Some(places) = places(path) else {
            return Self {
                slopes: [[0.0; N]; 2],
                is_smooth,
                steepest: 0.0,
                of_turns: 0.0,
                of_all: 0.0,
            };
        };
        let mut axes = limits.map(AxisAlong::new);
        for place in places {
            let place = place.position.into_iter().zip(place.slope);
            for (axis, at) in axes.iter_mut().zip(place) {
                axis.go_to(at);
            }
        }
        let [start, .., end] = places;
        // No number, where a limit is none or nothing moves, is passed over.
        let steepest = axes.iter().map(|axis| axis.steepest).fold(0.0, f64::max);
        let of_turns = axes
            .iter()
            .map(|axis| axis.segments_of_turns(steepest))
            .fold(0.0, f64::max);
        let of_ways = axes
            .iter()
            .map(AxisAlong::segments_of_way)
            .fold(0.0, f64::max)
            .min(segments_of_tool(path, steepest));
        Self {
            slopes: [start.slope, end.slope],
            is_smooth,
            steepest,
            of_turns,
            of_all: of_turns.max(of_ways),
        }
    }

    const fn is_sharp(&self) -> bool {
        self.of_turns >= SHARP
    }
}

impl<P: Path> Path for Counted<P> {
    type Axes = P::Axes;
    type Error = P::Error;

    fn length(&self) -> f64 {
        self.path.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<P::Axes>, P::Error> {
        self.path.point(s)
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.path.tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        self.path.tool_rate(s)
    }

    fn corner(&self) -> Corner<P::Axes> {
        self.path.corner()
    }

    fn check(&self, span: &Span<P::Axes>) -> Result<(), P::Error> {
        self.path.check(span)
    }

    fn is_too_coarse(&self, reason: &P::Error) -> bool {
        self.path.is_too_coarse(reason)
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

/// As many as the way asks for at the tool's acceleration, if there is such a limit.
fn segments_of_tool<P: Path>(path: &P, steepest: f64) -> f64 {
    let tool = path.tool();
    let limits = tool.and_then(|tool| Some((tool.feed, tool.acceleration?)));
    limits.map_or(f64::INFINITY, |(feed, acceleration)| {
        let speed = feed.min(1.0 / steepest);
        SEGMENTS_OF_TWO_BRAKINGS * path.length() * acceleration / (speed * speed)
    })
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

    fn segments_of_turns(&self, steepest: f64) -> f64 {
        SEGMENTS_OF_A_TURN * self.turn / steepest
    }

    fn segments_of_way(&self) -> f64 {
        let AxisLimits {
            speed,
            acceleration,
            ..
        } = self.limit;
        SEGMENTS_OF_TWO_BRAKINGS * self.way * acceleration / (speed * speed)
    }
}
