//! Position-velocity-time tables.

mod check;
mod leg;
mod planner;
mod points;
mod scurve;
pub(crate) mod segment;
mod smooth;
mod track;
mod window;

use nalgebra::Vector3;

use crate::course::{Place, is_still};
use crate::number::{larger_or_nan, smallest};
use crate::path::Path;
use crate::strain::hermite_strain;
use crate::{Cut, PlanError, Platform};
use planner::Planner;
pub use points::{PvtPoint, PvtPoints};
use track::Track;

/// Memory for one point of a [`PvtTable`] while it is planned and as long as it lives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Knot {
    /// Parameter of the leg.
    s: f64,
    /// Speed of the parameter.
    speed: f64,
    /// Time to the next knot.
    segment_s: f64,
    /// Parts of the leg.
    parts: u32,
}

/// A checked position-velocity-time table: every axis runs a cubic from each point to the next,
/// with the positions and velocities of the body's own motion at the points.
///
/// Along each leg it is the fastest such table that keeps the limits of all axes, found by a
/// backward and a forward pass over the points. What is checked is the cubic itself: its
/// peak speed inside, its acceleration at both ends. The machine stops at every pose on the
/// way, where the direction changes; a pose to be passed without a stop has no place in a path.
///
/// Where an axis has a limit of jerk, each leg is one S-curve along the path, which is the
/// shortest motion on a straight way, or the fastest motion without the limit averaged over a
/// window of time, whichever takes less.
/// Between points a cubic has one jerk; at a point its acceleration steps, which counts as a
/// jerk over the time between the middles of the segments.
#[derive(Debug, Clone, Copy)]
pub struct PvtTable<'a, const N: usize> {
    platform: &'a Platform<N>,
    path: Path<'a>,
    knots: &'a [Knot],
    points: usize,
    duration_s: f64,
    /// By what all times are multiplied.
    stretch: f64,
}

/// Fewest parts of a leg: it starts and stops.
const MIN_PARTS: u32 = 2;

impl<'a, const N: usize> PvtTable<'a, N> {
    /// Plans the table in memory of the caller: for each leg one knot more than parts.
    ///
    /// With [`Cut::strain`] each leg has a number of parts that keeps the allowed strain while
    /// one part fewer does not, by [`hermite_strain`]; it is found by bisection, and each trial
    /// is a plan.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan(
        platform: &'a Platform<N>,
        path: &Path<'a>,
        cut: Cut,
        knots: &'a mut [Knot],
    ) -> Result<Self, PlanError> {
        cut.check(platform)?;
        let planner = Planner {
            platform,
            path: *path,
            cut,
            // Each phase of an S-curve has a part.
            least: if has_jerk(platform) {
                scurve::PHASES
            } else {
                MIN_PARTS
            }
            .max(cut.at_least),
        };
        planner.check_memory(knots.len())?;
        let (mut used, mut points) = (0_usize, 1_usize);
        for track in moving(platform, path, 0) {
            let free = knots.get_mut(used..).unwrap_or_default();
            let taken = planner.plan_leg(&track, used, free)?;
            points = points.saturating_add(taken).saturating_sub(1);
            used = used.saturating_add(taken);
        }
        let knots = knots.get_mut(..used).unwrap_or_default();
        planner::check_legs(platform, path, knots)?;
        let knots = &*knots;
        Ok(Self {
            platform,
            path: *path,
            knots,
            points,
            duration_s: knots.iter().fold(0.0, |sum, knot| sum + knot.segment_s),
            stretch: 1.0,
        })
    }

    /// The same motion at a share of its speed, above 0 and at most 1: room for a feed above
    /// 100 %.
    ///
    /// # Errors
    /// [`PlanError::Pace`].
    pub fn at_pace(self, pace: f64) -> Result<Self, PlanError> {
        let min = self.stretch * smallest::<f64>();
        if pace >= min && pace <= 1.0 {
            return Ok(Self {
                stretch: self.stretch / pace,
                duration_s: self.duration_s / pace,
                ..self
            });
        }
        Err(PlanError::Pace { pace, min })
    }

    /// The number of points: one more than segments.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is a first point")]
    pub const fn len(&self) -> usize {
        self.points
    }

    /// Seconds from the first point to the last.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The platform of the table.
    #[must_use]
    pub const fn platform(&self) -> &'a Platform<N> {
        self.platform
    }

    /// The most by which the distance of two locators ever departs from that of their anchors:
    /// the largest [`hermite_strain`] of all segments.
    #[must_use]
    pub fn strain_bound(&self) -> f64 {
        strain_bound(self.platform, self.points())
    }

    /// The place of a point, slopes by time, and the time to the next point.
    pub(crate) fn node(&self, number: usize) -> Option<(Place<N, f64>, f64)> {
        let (mut knots, mut left) = (self.knots, number);
        for track in moving(self.platform, &self.path, 0) {
            let size = knots_of(knots.first()?.parts);
            let (own, later) = knots.split_at_checked(size)?;
            // The last knot of a leg is the first of the next, but for the last leg.
            if left.saturating_add(1) < size || later.is_empty() {
                let knot = own.get(left)?;
                let mut place = track.place(knot.s);
                let speed = knot.speed / self.stretch;
                place.slope = place.slope.map(|slope| slope * speed);
                return Some((place, knot.segment_s * self.stretch));
            }
            (knots, left) = (later, left.saturating_sub(size.saturating_sub(1)));
        }
        let mut place = first_track(self.platform, &self.path)?.place(0.0);
        place.slope = [Vector3::zeros(); N];
        (number == 0).then_some((place, 0.0))
    }

    /// The points in their order.
    #[must_use]
    pub fn points(&self) -> PvtPoints<'a, N> {
        PvtPoints::new(
            self.platform,
            &self.path,
            self.knots,
            self.stretch,
            self.points,
        )
    }
}

fn has_jerk<const N: usize>(platform: &Platform<N>) -> bool {
    let mut limits = platform.locators().iter().flat_map(|l| &l.limits);
    limits.any(|limits| limits.jerk.is_some())
}

fn strain_bound<const N: usize>(platform: &Platform<N>, mut points: PvtPoints<'_, N>) -> f64 {
    let Some(mut from) = points.next() else {
        return 0.0;
    };
    points.fold(0.0, |worst, to| {
        let strain = hermite_strain(platform, &from, &to);
        from = to;
        larger_or_nan(worst, strain)
    })
}

/// The legs on which something moves, from the leg `first` on.
fn moving<'a, const N: usize>(
    platform: &'a Platform<N>,
    path: &Path<'a>,
    first: usize,
) -> impl Iterator<Item = Track<'a, N>> + use<'a, N> {
    let path = *path;
    let legs = (first..path.legs()).filter(move |number| !is_still(platform, &path, *number));
    legs.filter_map(move |number| Track::new(platform, &path, number))
}

/// The first leg on which something moves; the first of all where nothing does.
fn first_track<'a, const N: usize>(
    platform: &'a Platform<N>,
    path: &Path<'a>,
) -> Option<Track<'a, N>> {
    let track = moving(platform, path, 0).next();
    track.or_else(|| Track::new(platform, path, 0))
}

/// Both ends of each segment of the leg whose knots are the first of `knots`.
fn segments<'a, const N: usize>(
    track: &'a Track<'_, N>,
    knots: &'a [Knot],
) -> impl Iterator<Item = [PvtPoint<N>; 2]> + use<'a, N> {
    let point = move |knot: &Knot, segment_s: f64| {
        PvtPoint::new(&track.place(knot.s), knot.speed, 0.0, segment_s)
    };
    let parts = knots.first().map_or(0, |knot| knot.parts);
    let knots = knots.get(..knots_of(parts)).unwrap_or_default();
    let mut from = knots.first().map(|knot| point(knot, 0.0));
    knots.windows(2).filter_map(move |pair| {
        let [before, knot] = pair else { return None };
        let to = point(knot, before.segment_s);
        Some([from.replace(to)?, to])
    })
}

/// Knots of a leg with so many parts.
fn knots_of(parts: u32) -> usize {
    usize::try_from(parts).map_or(usize::MAX, |parts| parts.saturating_add(1))
}
