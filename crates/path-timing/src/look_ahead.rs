//! Rows along an endless stream of paths, planned in a window of fixed size.

mod feeder;
mod window;

use core::fmt::{self, Debug};

use crate::feed_change::SmoothFeed;
use crate::number::{LARGEST, SMALLEST};
use crate::reciprocals::Reciprocals;
use crate::stepping::OfAxes;
use crate::{Axes, AxisLimits, FeedError, Knot, Path, PlanError, Row};
pub(crate) use feeder::Feeder;
pub(crate) use window::{Feed, Window};

/// The rows along a stream of paths that need not end, planned in a window of the caller's memory.
///
/// Each call of [`next_row`](Self::next_row) hands out one row, which is never revised. What
/// follows the window's end is unknown, so the machine can always stop there: the last speed in the
/// window is 0, and rises when the stream goes on. The rows are as fast as those of a
/// [`Table`](crate::Table) where half of the window is longer than the braking distance v²/2a; a
/// shorter window costs time, never a limit.
///
/// When half of the window has been handed out, it is filled up and its speeds are computed from
/// its end: at most two backward evaluations and one forward for each knot, two more backward at a
/// feed below the highest. Where the stream has no path for now, the machine comes to rest at the
/// end of the last one and goes on when there is one.
///
/// With a limit of jerk speeds come from an interior point, which is work for a PC: some 15 to 30
/// Newton steps for each knot where half of the window is twice as long as the braking, or more.
/// What changes is planned again, from before the braking at the window's old end on. No feed is
/// above 1. A change of the feed is smooth, as that of a [`Playback`](crate::Playback), and begins
/// where the knots of the window allow it to end: to be held at any time takes a window longer than
/// the way to rest.
///
/// ```
/// use path_timing::{AxisLimits, Curve, Knot, LookAhead};
///
/// // Sides of a staircase that never ends, in mm.
/// let point = |n: u32| [f64::from(n / 2) * 20.0, f64::from(n.div_ceil(2)) * 20.0];
/// let sides = (0..).map_while(|n| Curve::line(point(n), point(n + 1)).ok());
/// let axis = AxisLimits { speed: 200.0, acceleration: 2000.0, jerk: None };
/// let mut window = [Knot::default(); 32];
/// let mut motion = LookAhead::new(sides, [axis; 2], |_| Ok(8), &mut window)?;
/// for row in motion.by_ref().take(1000) {
///     let row = row?; // `row.duration_s` after the row before: `row.position`, `row.velocity`
/// }
/// motion.stop();
/// let last = motion.last().unwrap()?; // at rest on the path
/// # assert_eq!(last.velocity, [0.0; 2]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct LookAhead<'w, P: Path, I, F> {
    feeder: Feeder<P, I, F>,
    window: Window<'w, P::Axes>,
    limits: Reciprocals<P::Axes>,
    max: f64,
    wanted: f64,
    /// Path speed at the row handed out last; none before the first.
    speed: Option<f64>,
    /// The same at the row before it.
    before: f64,
    /// With a limit of jerk.
    smooth: SmoothFeed,
    time_s: f64,
    /// The path on which the row handed out last lies.
    leg: usize,
}

impl<'w, P: Path, I: Iterator<Item = P>, F: FnMut(&P) -> Result<u32, PlanError<P::Error>>>
    LookAhead<'w, P, I, F>
{
    /// The rows along `paths`, each cut into as many `segments` as the function says: a fixed
    /// number, or what [`segments_within`](crate::segments_within) finds.
    ///
    /// From rest to rest they are at least 2, and on a long path between short ones, whose corners
    /// may be slow: on one segment the speed does not rise and fall again. One is halved, up to
    /// twelve times, where the slopes at its ends do not tell how the path goes between them, and
    /// where the path takes it for too coarse; up to four times, without a limit of jerk, where it
    /// bends so much that it would take longer.
    ///
    /// # Errors
    /// [`PlanError::Limit`]; [`PlanError::Memory`] for a window of fewer than 4 knots.
    pub fn new(
        paths: impl IntoIterator<IntoIter = I>,
        limits: <P::Axes as Axes>::Of<AxisLimits>,
        segments: F,
        window: &'w mut [Knot<P::Axes>],
    ) -> Result<Self, PlanError<P::Error>> {
        let limits = Reciprocals::checked(&limits)?;
        Ok(Self {
            feeder: Feeder::new(paths.into_iter(), segments),
            window: Window::checked(window)?,
            limits,
            max: 1.0,
            wanted: 1.0,
            speed: None,
            before: 0.0,
            smooth: SmoothFeed::FULL,
            time_s: 0.0,
            leg: 0,
        })
    }

    /// With feeds of up to `max`, 2 for 200 %, before the first row. It looks further ahead for the
    /// higher feed. With a limit of jerk no feed is above 1.
    ///
    /// # Errors
    /// [`PlanError::Feed`].
    pub fn with_max_feed(mut self, max: f64) -> Result<Self, PlanError<P::Error>> {
        let highest = if self.limits.has_jerk() { 1.0 } else { LARGEST };
        if !(SMALLEST..=highest).contains(&max) {
            return Err(PlanError::Feed {
                feed: max,
                min: SMALLEST,
                max: highest,
            });
        }
        (self.max, self.wanted) = (max, self.wanted.min(max));
        Ok(self)
    }

    /// Wants a feed, 1 for 100 %; 0 holds. The speed goes there as fast as the accelerations allow.
    ///
    /// The tool's feed is multiplied by it, and below 1 the speed limits of the axes too;
    /// accelerations stay as they are.
    ///
    /// # Errors
    /// [`FeedError`]; the wanted feed stays.
    pub fn set_feed(&mut self, feed: f64) -> Result<(), FeedError> {
        self.wanted = FeedError::checked(feed, self.max)?;
        Ok(())
    }

    /// Holds: comes to rest at a knot as soon as the limits allow, and may gain speed for that where
    /// the machine is slow. [`set_feed`](Self::set_feed) goes on.
    pub const fn stop(&mut self) {
        self.wanted = 0.0;
    }

    /// Whether the machine rests at the row handed out last.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.speed.is_none_or(|speed| speed <= 0.0)
    }

    /// Whether all paths have been run and the machine rests at the end of the last one, or before
    /// one that was refused: what a `None` of [`next_row`](Self::next_row) means, which else is a
    /// hold.
    ///
    /// A stream that had no path may have one later: the next call of `next_row` asks it again.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.is_at_rest() && !self.window.goes_on() && self.feeder.is_empty()
    }

    /// The next row; `None` where the machine rests: held, or at the end of the last path for now,
    /// which [`is_finished`](Self::is_finished) tells apart.
    ///
    /// # Errors
    /// [`PlanError`] with the place, once, when a path is refused; no other path is taken then. It
    /// comes a window before the machine is there: further calls hand out the rows to a rest at the
    /// last knot before that point.
    pub fn next_row(&mut self) -> Result<Option<Row<P::Axes>>, PlanError<P::Error>> {
        let filled = self.fill();
        if self.limits.has_jerk() {
            if self.wanted > 0.0 && self.is_at_rest() {
                self.window.rest(&self.limits);
            }
            self.window.look_through(&self.limits);
        } else {
            self.window.look_back(&OfAxes, &self.limits, self.feed());
        }
        filled?;
        let Some(speed) = self.speed else {
            return Ok(self.first_row());
        };
        let step = if self.limits.has_jerk() {
            let (feed, wanted) = (&mut self.smooth, self.wanted);
            let speeds = [self.before, speed];
            self.window
                .step_smoothly(&self.limits, feed, wanted, speeds)
        } else {
            self.window.step(&OfAxes, &self.limits, self.feed(), speed)
        };
        let Some(step) = step else {
            return Ok(None);
        };
        self.window.advance();
        if step.knot.ds > 0.0 {
            self.before = speed;
        }
        self.speed = Some(step.speed);
        self.time_s += step.duration_s;
        self.leg = self.leg.saturating_add(usize::from(step.begins_leg));
        Ok(Some(Row {
            time_s: self.time_s,
            duration_s: step.duration_s,
            leg: self.leg,
            ..step.knot.row(step.speed)
        }))
    }

    const fn feed(&self) -> Feed {
        Feed {
            max: self.max,
            wanted: self.wanted,
        }
    }

    /// The first row, at rest.
    fn first_row(&mut self) -> Option<Row<P::Axes>> {
        let first = self.window.first()?;
        self.speed = Some(0.0);
        Some(first.row(0.0))
    }

    /// Fills the window when half of it is free.
    fn fill(&mut self) -> Result<(), PlanError<P::Error>> {
        let has_jerk = self.limits.has_jerk();
        // A change of the feed was tried on the speeds ahead.
        let stays = has_jerk && !self.smooth.is_constant() && !self.is_at_rest();
        if self.feeder.is_refused() || stays || !self.window.make_room(has_jerk) {
            return Ok(());
        }
        self.feeder
            .fill(&mut self.window, &self.limits, |_, _| true)
    }
}

impl<P: Path, I: Iterator<Item = P>, F: FnMut(&P) -> Result<u32, PlanError<P::Error>>> Iterator
    for LookAhead<'_, P, I, F>
{
    type Item = Result<Row<P::Axes>, PlanError<P::Error>>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_row().transpose()
    }
}

impl<P: Path, I, F> Debug for LookAhead<'_, P, I, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LookAhead")
            .field("paths", &self.feeder.count())
            .field("time_s", &self.time_s)
            .field("speed", &self.speed)
            .field("wanted", &self.wanted)
            .finish_non_exhaustive()
    }
}
