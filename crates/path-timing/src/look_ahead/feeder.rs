//! What enters the window of a stream: the knots of its paths, one after the other.

use crate::junction::Junction;
use crate::knots::{LARGEST_GAP, is_resolved};
use crate::laying::{Cutting, Laying, bounded};
use crate::leg::Leg;
use crate::look_ahead::Window;
use crate::planner::{Beyond, check_gap, fewest, junction_to};
use crate::reciprocals::Reciprocals;
use crate::stretch::stretch_evenly;
use crate::{Axes, Corner, Knot, Path, PlanError};

/// The part of the steepest slope by which slopes may disagree on a segment before it is halved for
/// time's sake. The knots of a stream do not gather where the machine is slow: of 315 bent curves in
/// 6 segments the slowest took 1.35 times as long as in 400, and takes 1.16.
const COMFORTABLE_GAP: f64 = 0.05;

/// How often at most: next to a cusp it would be for ever.
const FEW_HALVINGS: u32 = 4;

/// By how much slopes may disagree. With a limit of jerk shorter segments take no less time at
/// corners, and a window of five knots sees none of what follows.
fn gap<A: Axes>(limits: &Reciprocals<A>, halvings: u32) -> f64 {
    if halvings < FEW_HALVINGS && !limits.has_jerk() {
        COMFORTABLE_GAP
    } else {
        LARGEST_GAP
    }
}

/// Paths of which the first have entered a window.
pub(crate) struct Feeder<P: Path, I, F> {
    paths: I,
    /// The path after the one that enters the window.
    following: Option<P>,
    segments: F,
    /// The path whose knots enter the window.
    entering: Option<Cutting<P>>,
    /// Paths that have begun.
    count: usize,
    /// Whether a path was refused: the stream ends there.
    is_refused: bool,
    /// The corner of the path before, with its end in the window, and the length of that path.
    corner: Option<(Corner<P::Axes>, f64)>,
}

impl<P: Path, I, F> Feeder<P, I, F> {
    pub(crate) const fn new(paths: I, segments: F) -> Self {
        Self {
            paths,
            following: None,
            segments,
            entering: None,
            count: 0,
            is_refused: false,
            corner: None,
        }
    }

    /// Paths that have begun.
    pub(crate) const fn count(&self) -> usize {
        self.count
    }

    pub(crate) const fn is_refused(&self) -> bool {
        self.is_refused
    }

    /// Whether nothing enters any more, or for now.
    pub(crate) const fn is_empty(&self) -> bool {
        self.is_refused || (self.entering.is_none() && self.following.is_none())
    }
}

impl<P: Path, I: Iterator<Item = P>, F: FnMut(&P) -> Result<u32, PlanError<P::Error>>>
    Feeder<P, I, F>
{
    /// Fills the window; nothing more after an error.
    ///
    /// A segment is halved where what its path or `is_known` says is that it is too coarse.
    pub(crate) fn fill(
        &mut self,
        window: &mut Window<'_, P::Axes>,
        limits: &Reciprocals<P::Axes>,
        is_known: impl Fn(&Knot<P::Axes>, &Knot<P::Axes>) -> bool,
    ) -> Result<(), PlanError<P::Error>> {
        let filled = self.push_knots(window, limits, is_known);
        self.is_refused = filled.is_err();
        filled
    }

    fn push_knots(
        &mut self,
        window: &mut Window<'_, P::Axes>,
        limits: &Reciprocals<P::Axes>,
        is_known: impl Fn(&Knot<P::Axes>, &Knot<P::Axes>) -> bool,
    ) -> Result<(), PlanError<P::Error>> {
        while window.has_room() {
            let Some(entering) = &mut self.entering else {
                let Some(path) = self.following.take().or_else(|| self.paths.next()) else {
                    return Ok(());
                };
                self.following = self.paths.next();
                self.entering = Some(self.begin(path, window, limits)?);
                continue;
            };
            let is_stretched = limits.has_jerk() && entering.laying.leg.tool().is_none();
            let to = entering.next_knot(
                |from, to, length| {
                    if is_stretched {
                        stretch_evenly(limits, [from, to], length)
                    } else {
                        1.0
                    }
                },
                |from, to, halvings| {
                    is_resolved(limits, from, to, gap(limits, halvings)) && is_known(from, to)
                },
            )?;
            window.push(to);
            if to.ends_leg {
                let leg = &entering.laying.leg;
                self.corner = Some((leg.path().corner(), leg.length()));
                self.entering = None;
            }
        }
        Ok(())
    }

    /// Begins a path: its first knot is the last of the path before.
    fn begin(
        &mut self,
        path: P,
        window: &mut Window<'_, P::Axes>,
        limits: &Reciprocals<P::Axes>,
    ) -> Result<Cutting<P>, PlanError<P::Error>> {
        let number = self.count;
        self.count = number.wrapping_add(1);
        let segments = (self.segments)(&path).map_err(|error| error.of_leg(number))?;
        let segments = bounded(number, segments, 1)?;
        let leg = Leg::new(number, path)?;
        let start = leg.point(0.0)?;
        let mut before: Beyond<P::Axes> = (Junction::Stop, 0.0);
        if let (Some((corner, length)), Some(end)) = (self.corner.take(), window.last_mut()) {
            check_gap(number, &end.point.position, &start.position)?;
            let junction = Junction::new(limits, &corner, &end.point.slope, &start.slope);
            before = (junction, length);
            if let Some(jump) = end.join(&junction, &start) {
                window.push(jump);
            }
        } else {
            window.push(Knot::start(start));
        }
        // A path that is refused is so when it begins: until then the machine is to rest before it.
        let next = self.following.as_ref();
        let corner = leg.path().corner();
        // Whether a jump is a slow one, two more places of the paths would tell.
        let is_asked = segments == 1 || matches!(corner, Corner::Smooth);
        let after = is_asked
            .then(|| junction_to(&leg, next, limits).ok())
            .flatten();
        let is_slow = |junction: Junction<P::Axes>| junction.cap().is_finite();
        let ends_slowly = !matches!(corner, Corner::Smooth) || after.is_some_and(is_slow);
        let fewest = if segments == 1 {
            let after = (
                after.unwrap_or(Junction::Stop),
                next.map_or(0.0, Path::length),
            );
            fewest(limits, &leg, &start, [&before, &after])
        } else {
            1
        };
        let ends = [is_slow(before.0), ends_slowly];
        let laying = Laying::new(leg, start);
        Ok(Cutting::new(laying, ends, segments.max(fewest)))
    }
}
