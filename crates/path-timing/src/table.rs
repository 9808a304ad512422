//! Position-velocity-time tables along paths.

use crate::leg::Leg;
use crate::number::{SMALLEST, larger_or_nan};
use crate::planner::{Planner, bound_of_leg};
use crate::rows::Rows;
use crate::segment::Reciprocals;
use crate::{Axes, AxisLimits, Legs, Path, PlanError, Row, Span};

/// Memory for one row of a [`Table`] while it is planned and as long as it lives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Knot {
    /// Where it stands, as a share of its leg: 0 at the first knot of each.
    pub(crate) s: f64,
    /// Speed of the share.
    pub(crate) speed: f64,
    /// Time to the next knot; none at the last of a leg.
    pub(crate) duration_s: f64,
    /// While speeds are chosen: the speed at the next knot that goes with the highest here.
    pub(crate) after: f64,
}

/// A position-velocity-time table along one path or several: every axis runs a cubic from each row
/// to the next, with the positions and slopes of the path at the rows.
///
/// Along each leg it is the fastest such table that keeps the limits of all axes, found by a
/// backward and a forward pass over the knots. What is limited is the cubic itself: its peak speed
/// inside, its acceleration at both ends. The machine stops at the end of each leg.
///
/// Where an axis has a limit of jerk, each leg is one S-curve along the path, which is the
/// shortest motion on a straight way, or the fastest motion without the limit averaged over a
/// window of time, whichever takes less.
/// Between rows a cubic has one jerk; at a row its acceleration steps, which counts as a jerk over
/// the time between the middles of the segments.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a, L, A: Axes> {
    pub(crate) legs: L,
    pub(crate) knots: &'a [Knot],
    pub(crate) limits: Reciprocals<A>,
    /// By what all times are multiplied.
    pub(crate) stretch: f64,
    rows: usize,
    duration_s: f64,
}

impl<'a, A: Axes, L: Legs<Axes = A>> Table<'a, L, A> {
    /// Plans the table in memory of the caller: for each leg one knot more than segments.
    /// `segments` says how many a leg has; it gets 2 at the least, with jerk 7.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan(
        legs: impl IntoIterator<IntoIter = L>,
        limits: A::Of<AxisLimits>,
        segments: impl Fn(&L::Leg) -> u32,
        knots: &'a mut [Knot],
    ) -> Result<Self, PlanError<L::Error>> {
        let planner = Planner::new(limits)?;
        let choose = |planner: &Planner<_>, leg: &Leg<_>, _, _: &mut [Knot]| {
            planner.bounded(leg.number, segments(leg.path()))
        };
        Self::plan_by(legs.into_iter(), &planner, &segments, choose, knots)
    }

    /// Plans the table with a number of segments of each leg that keeps a departure within
    /// `allowed` while one fewer does not.
    ///
    /// `departure` is a bound on what a controller departs by on a segment of a leg, in any unit; it
    /// should fall with the number of segments. The number is found by bisection, and each trial is
    /// a plan.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan_within(
        legs: impl IntoIterator<IntoIter = L>,
        limits: A::Of<AxisLimits>,
        at_least: u32,
        allowed: f64,
        departure: impl Fn(&L::Leg, &Span<A>) -> f64,
        knots: &'a mut [Knot],
    ) -> Result<Self, PlanError<L::Error>> {
        if !(allowed > 0.0 && allowed.is_finite()) {
            return Err(PlanError::Allowed { allowed });
        }
        let planner = Planner::new(limits)?;
        let choose = |planner: &Planner<_>, leg: &Leg<_>, used, free: &mut [Knot]| {
            planner.fewest(leg, used, free, at_least, allowed, &departure)
        };
        Self::plan_by(legs.into_iter(), &planner, |_| at_least, choose, knots)
    }

    fn plan_by(
        legs: L,
        planner: &Planner<A>,
        least: impl Fn(&L::Leg) -> u32,
        choose: impl Fn(
            &Planner<A>,
            &Leg<L::Leg>,
            usize,
            &mut [Knot],
        ) -> Result<u32, PlanError<L::Error>>,
        knots: &'a mut [Knot],
    ) -> Result<Self, PlanError<L::Error>> {
        planner.check_legs(legs.clone(), least, knots.len())?;
        let (mut used, mut rows, mut duration_s) = (0_usize, 0_usize, 0.0);
        for (number, path) in legs.clone().enumerate() {
            let leg = Leg::new(number, path);
            let free = knots.get_mut(used..).unwrap_or_default();
            let segments = choose(planner, &leg, used, free)?;
            let own = planner.plan_leg(&leg, free, segments)?;
            duration_s = planner.finish(&leg, own, duration_s)?;
            // The last row of a leg is the first of the next.
            rows = rows
                .saturating_add(own.len())
                .saturating_sub(usize::from(number > 0));
            used = used.saturating_add(own.len());
        }
        Ok(Self {
            legs,
            knots: knots.get(..used).unwrap_or_default(),
            limits: *planner.reciprocals(),
            stretch: 1.0,
            rows,
            duration_s,
        })
    }

    /// The same motion at a share of its speed, above 0 and at most 1: room for a feed above
    /// 100 %.
    ///
    /// # Errors
    /// [`PlanError::SpeedScale`].
    pub fn at_speed(&self, scale: f64) -> Result<Self, PlanError<L::Error>> {
        let min = self.stretch * SMALLEST;
        if scale >= min && scale <= 1.0 {
            return Ok(Self {
                stretch: self.stretch / scale,
                duration_s: self.duration_s / scale,
                ..self.clone()
            });
        }
        Err(PlanError::SpeedScale { scale, min })
    }

    /// The paths, as they were given.
    #[must_use]
    pub const fn legs(&self) -> &L {
        &self.legs
    }

    /// The number of rows: one more than segments; 0 without a leg.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.rows
    }

    /// Whether there is no leg.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Seconds from the first row to the last.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The largest of a bound of the departure over all segments, as given to
    /// [`plan_within`](Self::plan_within).
    ///
    /// # Errors
    /// Where the path refuses a place that it has given while the table was planned.
    pub fn departure(
        &self,
        departure: impl Fn(&L::Leg, &Span<A>) -> f64,
    ) -> Result<f64, PlanError<L::Error>> {
        let mut knots = self.knots;
        (0..)
            .zip(self.legs.clone())
            .try_fold(0.0, |worst, (number, path)| {
                let end = knots.iter().position(|knot| knot.s >= 1.0);
                let count = end.map_or(knots.len(), |end| end.saturating_add(1));
                let own = knots.get(..count).unwrap_or_default();
                knots = knots.get(count..).unwrap_or_default();
                let bound = bound_of_leg(&Leg::new(number, path), own, &departure)?;
                Ok(larger_or_nan(worst, bound))
            })
    }

    /// The rows in their order.
    #[must_use]
    pub fn rows(&self) -> Rows<'a, L> {
        Rows::new(self)
    }
}

/// The segments of a leg.
pub(crate) fn spans_of_leg<P: Path>(
    leg: &Leg<P>,
    knots: &[Knot],
) -> impl Iterator<Item = Result<Span<P::Axes>, PlanError<P::Error>>> {
    let mut from: Option<(f64, Row<P::Axes>)> = None;
    let mut duration_s = 0.0;
    let rows = knots.iter().map(move |knot| {
        let place = leg.checked_place(knot.s)?;
        let row = Row::new(&place, knot.speed, 0.0, duration_s);
        duration_s = knot.duration_s;
        Ok((leg.parameter(knot.s), row))
    });
    rows.filter_map(move |row| match row {
        Ok((s, to)) => from.replace((s, to)).map(|(before, from)| {
            Ok(Span {
                s: [before, s],
                rows: [from, to],
            })
        }),
        Err(error) => Some(Err(error)),
    })
}
