//! Position-velocity-time tables along paths.

use crate::chain::Chain;
use crate::departure::check_allowed;
use crate::leg::Leg;
use crate::number::{SMALLEST, larger_or_nan};
use crate::planner::{Planner, Within, bound_of_leg};
use crate::reciprocals::Reciprocals;
use crate::rows::Rows;
use crate::{Axes, AxisLimits, Legs, Path, PlanError, Row, Span, profile};

/// Memory for one row of a [`Table`] while it is planned and as long as it lives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Knot {
    /// Parameter of its leg: 0 at the first knot of each, the length at the last.
    pub(crate) s: f64,
    /// Speed of the parameter.
    pub(crate) speed: f64,
    /// Time to the next knot; none at the last of a leg. While speeds with limits of jerk are chosen,
    /// the highest even speed.
    pub(crate) duration_s: f64,
    /// While speeds are chosen: the speed at the next knot that goes with the highest here; before, with
    /// limits of jerk, the highest speed that is wanted here.
    pub(crate) after: f64,
}

/// A position-velocity-time table along one path or several: every axis runs a cubic from each row
/// to the next, with the positions and slopes of the path at the rows.
///
/// It is the fastest such table that keeps the limits of all axes, found by a backward and a
/// forward pass over the knots. What is limited is the cubic itself: its peak speed inside, its
/// acceleration at both ends. At the end of each path the machine does what that path's
/// [`corner`](Path::corner) says.
///
/// Where an axis has a limit of jerk, all legs between two stops are run by a fastest motion without
/// the limit averaged over a window of time; a leg from rest to rest by one S-curve along it where that
/// takes less, as on a straight path, which it is the shortest motion on.
/// Between rows a cubic has one jerk; at a row its acceleration steps, which counts as a jerk over
/// the time between the middles of the segments.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a, L, A: Axes> {
    pub(crate) legs: L,
    pub(crate) knots: &'a [Knot],
    pub(crate) limits: Reciprocals<A>,
    /// By what all times are multiplied.
    pub(crate) stretch: f64,
    /// Rows with two velocities at a corner counted once.
    pub(crate) nodes: usize,
    rows: usize,
    duration_s: f64,
}

impl<'a, A: Axes, L: Legs<Axes = A>> Table<'a, L, A> {
    /// Plans the table in memory of the caller: for each leg one knot more than segments.
    /// `segments` says how many a leg has; at least 2, with jerk 7.
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
        let choose = |planner: &Planner<_>, leg: &Leg<_>, _, _, _: &mut [Knot]| {
            planner.bounded(leg.number, segments(leg.path()))
        };
        Self::plan_by(legs.into_iter(), &planner, &segments, choose, knots)
    }

    /// Plans the table with a number of segments of each leg that keeps a departure within
    /// `allowed` while one fewer does not.
    ///
    /// `departure` is a bound on what a controller departs by on a segment of a leg, in any unit; it
    /// should fall with the number of segments. The number is found by bisection, and each trial is
    /// a plan. It holds at a constant feed; of a path that is passed without a stop at an end it holds
    /// at any speeds, as [`plan_within_at_any_feed`](Self::plan_within_at_any_feed) makes it.
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
        let within = Within {
            at_least,
            allowed,
            any_feed: false,
            departure,
        };
        Self::plan_fewest(legs.into_iter(), limits, &within, knots)
    }

    /// Plans the table as [`plan_within`](Self::plan_within) does, with segments that keep the
    /// departure at any speeds: also under feed changes, and where a [`Run`](crate::Run) is held at
    /// any row and resumed. These are several times as many.
    ///
    /// `departure` is asked for each segment from rest, to rest and at three ratios of the speeds
    /// between, and with an acceleration that starts or ends at zero; the last segment of a path also
    /// from rest to rest. It must be largest at one of these, as a bound is that grows towards rest.
    /// The speed of the table must not change more than threefold on a segment that does not start or
    /// end at rest.
    ///
    /// # Errors
    /// [`PlanError`]; also where `knots` are too few.
    pub fn plan_within_at_any_feed(
        legs: impl IntoIterator<IntoIter = L>,
        limits: A::Of<AxisLimits>,
        at_least: u32,
        allowed: f64,
        departure: impl Fn(&L::Leg, &Span<A>) -> f64,
        knots: &'a mut [Knot],
    ) -> Result<Self, PlanError<L::Error>> {
        let within = Within {
            at_least,
            allowed,
            any_feed: true,
            departure,
        };
        Self::plan_fewest(legs.into_iter(), limits, &within, knots)
    }

    fn plan_fewest(
        legs: L,
        limits: A::Of<AxisLimits>,
        within: &Within<impl Fn(&L::Leg, &Span<A>) -> f64>,
        knots: &'a mut [Knot],
    ) -> Result<Self, PlanError<L::Error>> {
        check_allowed(within.allowed)?;
        let planner = Planner::new(limits)?;
        let choose = |planner: &Planner<_>, leg: &Leg<_>, rests, used, free: &mut [Knot]| {
            planner.fewest(leg, rests, [used, free.len()], free, within)
        };
        Self::plan_by(legs, &planner, |_| within.at_least, choose, knots)
    }

    fn plan_by(
        legs: L,
        planner: &Planner<A>,
        least: impl Fn(&L::Leg) -> u32,
        choose: impl Fn(
            &Planner<A>,
            &Leg<L::Leg>,
            bool,
            usize,
            &mut [Knot],
        ) -> Result<u32, PlanError<L::Error>>,
        knots: &'a mut [Knot],
    ) -> Result<Self, PlanError<L::Error>> {
        let chain = Chain::new(legs.clone(), 0);
        planner.check_legs(&chain, least, knots.len())?;
        let (mut used, mut nodes, mut jumps) = (0_usize, 0_usize, 0_usize);
        let mut starts_at_rest = true;
        for leg in chain.forward(planner.reciprocals()) {
            let leg = leg?;
            let (_, free) = profile::split(knots, used);
            let segments = choose(planner, &leg, starts_at_rest, used, free)?;
            let own = planner.lay_leg(&leg, starts_at_rest, free, segments)?;
            used = used.saturating_add(own.len());
            // The last knot of a leg is the first of the next.
            nodes = nodes
                .saturating_add(own.len())
                .saturating_sub(usize::from(nodes > 0));
            jumps = jumps.saturating_add(usize::from(leg.joint().is_jump()));
            starts_at_rest = leg.joint().is_stop();
        }
        let (knots, _) = profile::split(knots, used);
        let duration_s = planner.plan_legs(&chain, knots)?;
        Ok(Self {
            legs,
            knots,
            limits: *planner.reciprocals(),
            stretch: 1.0,
            nodes,
            rows: nodes.saturating_add(jumps),
            duration_s,
        })
    }

    /// The same motion at a fraction of its speed, above 0 and at most 1: room for a feed above
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
    /// Where the path refuses a point that it has given while the table was planned.
    pub fn departure(
        &self,
        departure: impl Fn(&L::Leg, &Span<A>) -> f64,
    ) -> Result<f64, PlanError<L::Error>> {
        let mut later = self.knots;
        self.chain()
            .forward(&self.limits)
            .try_fold(0.0, |worst, leg| {
                let (own, rest) = later.split_at(profile::first_leg(later).min(later.len()));
                later = rest;
                let bound = bound_of_leg(&leg?, own, &departure)?;
                Ok(larger_or_nan(worst, bound))
            })
    }

    pub(crate) fn chain(&self) -> Chain<L> {
        Chain::new(self.legs.clone(), 0)
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
        let point = leg.checked_point(knot.s)?;
        let row = Row::new(&point, knot.speed, 0.0, duration_s);
        duration_s = knot.duration_s;
        Ok((knot.s, row))
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
