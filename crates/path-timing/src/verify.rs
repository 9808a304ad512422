//! A verifier of rows: what a plan promises, proven again without the planner.
//!
//! Goal: whoever runs rows, from this crate or over a wire, can prove that they keep what was
//! promised. Method: each cubic by its own formulas, from positions, velocities and time alone; the
//! path is asked for the places that the rows name. No line of it is used by the planner, nor the
//! other way round.

mod motion;
mod passage;
mod violation;

use self::motion::{Motion, bends, of_axis};
use self::passage::Passage;
pub use self::violation::Violation;
use crate::number::{cube_root, sqrt};
use crate::{Axes, AxisLimits, Path, Row, Span};

/// What is promised of rows besides the limits of the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "named fields")]
pub struct Promise<A: Axes> {
    /// Limits of each axis.
    pub limits: A::Of<AxisLimits>,
    /// By how much each velocity may jump at a corner.
    pub start_stop: A,
    /// Largest departure, in the unit of the bound that is given with each row.
    pub max_departure: f64,
    /// How many times as fast as it is a motion between two rests might at most be within the
    /// limits of the axes; infinite for feeds that are overridden.
    pub max_slowness: f64,
    /// The limits of the tool that paths have are kept, with this many times its feed; none where
    /// nothing is promised of a tool.
    pub tool_feed: Option<f64>,
}

/// Rounding of rows that are computed again from their numbers, relative to the limits, and of
/// positions and velocities relative to their size.
const ROUNDING: f64 = 1e-9;

/// Proves row after row what was promised.
///
/// ```
/// use path_timing::{Accuracy, AxisLimits, Curve, Knot, Promise, Table, Verifier};
///
/// let quarter = Curve::arc([50.0, 0.0], [0.0, 0.0], [0.0, 1.0], core::f64::consts::FRAC_PI_2)?;
/// let axis = AxisLimits { speed: 200.0, acceleration: 2000.0, jerk: None }; // mm, s
/// let accuracy = Accuracy { min_segments: 4, max_departure: 1e-3, max_time_ratio: f64::INFINITY };
/// let mut knots = [Knot::default(); 100];
/// let table = Table::plan_within([quarter], [axis; 2], accuracy, Curve::departure, &mut knots)?;
///
/// let mut verifier = Verifier::new(Promise {
///     limits: [axis; 2],
///     start_stop: [0.0; 2],
///     max_departure: 1e-3,
///     max_slowness: 3.0,
///     tool_feed: Some(1.0),
/// });
/// for row in table.rows() {
///     verifier.add(&row, |leg| [quarter].get(leg).copied(), Curve::departure)?;
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Verifier<A: Axes> {
    promise: Promise<A>,
    before: Option<Row<A>>,
    /// Accelerations at the end of the segment before and in its middle, those that the path's bend
    /// asks for at its end, and its duration; zero behind a rest and a jump.
    accelerations: A,
    middles: A,
    bends: A,
    duration_s: f64,
    /// The largest part of a limit since the last rest, as a factor of all speeds.
    use_of_limits: f64,
}

impl<A: Axes> Verifier<A> {
    /// Before the first row.
    #[must_use]
    pub fn new(promise: Promise<A>) -> Self {
        Self {
            promise,
            before: None,
            accelerations: A::zeros(),
            middles: A::zeros(),
            bends: A::zeros(),
            duration_s: 0.0,
            use_of_limits: 0.0,
        }
    }

    /// The next row: proves the segment that leads to it. `path` gives the path of a leg, if there
    /// is one, `departure` bounds what a segment departs by.
    ///
    /// # Errors
    /// [`Violation`]: the first promise that is broken.
    pub fn add<P: Path<Axes = A>>(
        &mut self,
        row: &Row<A>,
        path: impl Fn(usize) -> Option<P>,
        departure: impl Fn(&P, &Span<A>) -> f64,
    ) -> Result<(), Violation<P::Error>> {
        let (leg, s) = (row.leg, row.s);
        let path = path(leg).ok_or(Violation::Order { leg, s })?;
        let Some(from) = self.before.replace(*row) else {
            return self.add_first(row, &path);
        };
        self.check_order(&from, row)?;
        if row.duration_s == 0.0 {
            return self.add_jump(&from, row, &path);
        }
        let begins_leg = row.leg != from.leg;
        let start = if begins_leg { 0.0 } else { from.s };
        let span = Span {
            s: [start, row.s],
            rows: [from, *row],
        };
        let passages = self.check_parameter(&path, &span)?;
        self.check_tool(&path, &span, &passages)?;
        self.check_limits(&from, row, &passages)?;
        path.check(&span)
            .map_err(|reason| Violation::Path { leg, s, reason })?;
        let (promised, departure) = (self.promise.max_departure, departure(&path, &span));
        // Written so that NaN is too much.
        let is_near = departure <= promised;
        if !is_near {
            return Err(Violation::Departure {
                time_s: row.time_s,
                departure,
                promised,
            });
        }
        self.check_rest(row)
    }

    fn add_first<P: Path<Axes = A>>(
        &self,
        row: &Row<A>,
        path: &P,
    ) -> Result<(), Violation<P::Error>> {
        let is_start = row.time_s == 0.0 && row.duration_s == 0.0 && row.leg == 0 && row.s == 0.0;
        if !is_start {
            return Err(Violation::Time { time_s: row.time_s });
        }
        Passage::of_row(path, row.s, row).map(|_| ())
    }

    fn check_order<E>(&self, from: &Row<A>, row: &Row<A>) -> Result<(), Violation<E>> {
        let time_s = row.time_s;
        let off = time_s - from.time_s - row.duration_s;
        // Written so that NaN does not follow.
        let follows = row.duration_s >= 0.0 && off.abs() <= ROUNDING * time_s;
        if !follows || !time_s.is_finite() {
            return Err(Violation::Time { time_s });
        }
        let is_next_leg = row.leg == from.leg.saturating_add(1);
        let rises = if is_next_leg {
            row.s > 0.0 || row.duration_s == 0.0
        } else {
            row.leg == from.leg && row.s > from.s
        };
        if rises {
            return Ok(());
        }
        Err(Violation::Order {
            leg: row.leg,
            s: row.s,
        })
    }

    /// Both rows of a corner.
    fn add_jump<P: Path<Axes = A>>(
        &mut self,
        from: &Row<A>,
        row: &Row<A>,
        path: &P,
    ) -> Result<(), Violation<P::Error>> {
        Passage::of_row(path, row.s, row)?;
        self.check_eased(row.time_s)?;
        let velocities = from.velocity.as_slice().iter().zip(row.velocity.as_slice());
        let jumps = velocities.zip(self.promise.start_stop.as_slice());
        for (axis, ((v0, v1), allowed)) in jumps.enumerate() {
            let limit = (axis, "velocity jump", *allowed);
            within(limit, (v1 - v0).abs(), row.time_s)?;
        }
        Ok(())
    }

    /// The parameter rises from row to row, and its speeds are those of the velocities.
    fn check_parameter<P: Path<Axes = A>>(
        &self,
        path: &P,
        span: &Span<A>,
    ) -> Result<[Passage<A>; 2], Violation<P::Error>> {
        let ([from, to], [s0, s1]) = (&span.rows, span.s);
        let passages = [
            Passage::of_row(path, s0, from)?,
            Passage::of_row(path, s1, to)?,
        ];
        for passage in &passages {
            let times = passage.speed * to.duration_s / (s1 - s0);
            // Written so that NaN turns back.
            let goes_on = (-ROUNDING..=3.0 + ROUNDING).contains(&times);
            if !goes_on {
                let time_s = to.time_s;
                return Err(Violation::TurnsBack { time_s, times });
            }
        }
        Ok(passages)
    }

    /// The feed, which is a speed of the parameter, at both ends, and the tool's mean acceleration.
    fn check_tool<P: Path<Axes = A>>(
        &self,
        path: &P,
        span: &Span<A>,
        [start, end]: &[Passage<A>; 2],
    ) -> Result<(), Violation<P::Error>> {
        let (w0, w1) = (start.speed, end.speed);
        let (Some(times), Some(tool)) = (self.promise.tool_feed, path.tool()) else {
            return Ok(());
        };
        let ([_, row], [s0, s1]) = (&span.rows, span.s);
        let (time_s, duration_s) = (row.time_s, row.duration_s);
        let refused = |name, value, limit| Violation::Tool {
            name,
            time_s,
            value,
            limit,
        };
        let (fastest, feed) = (w0.max(w1), tool.feed * times);
        // Written so that NaN is above.
        let is_slow = fastest <= feed * (1.0 + SMOOTH);
        if !is_slow {
            return Err(refused("feed", fastest, feed));
        }
        let Some(limit) = tool.acceleration else {
            return Ok(());
        };
        let [before, speed] = [path.tool_rate(s0) * w0, path.tool_rate(s1) * w1];
        let rise = (speed - before).abs();
        let rounding = SMOOTH * before.max(speed);
        let is_soft = rise <= limit * duration_s * (1.0 + ROUNDING) + rounding;
        if !is_soft {
            return Err(refused("acceleration", rise / duration_s, limit));
        }
        Ok(())
    }

    fn check_limits<E>(
        &mut self,
        from: &Row<A>,
        row: &Row<A>,
        passages: &[Passage<A>; 2],
    ) -> Result<(), Violation<E>> {
        let (time_s, duration_s) = (row.time_s, row.duration_s);
        let limits = self.promise.limits;
        for (axis, limits) in A::each(&limits).iter().enumerate() {
            let positions = [&from.position, &row.position].map(|row| of_axis(row, axis));
            let velocities = [&from.velocity, &row.velocity].map(|row| of_axis(row, axis));
            let motion = Motion::new(positions, velocities, duration_s);
            let (speed, [a0, a1]) = (motion.speed(), motion.accelerations());
            let acceleration = a0.abs().max(a1.abs());
            within((axis, "speed", limits.speed), speed, time_s)?;
            within(
                (axis, "acceleration", limits.acceleration),
                acceleration,
                time_s,
            )?;
            let mut used = (speed / limits.speed).max(sqrt(acceleration / limits.acceleration));
            if let Some(limit) = limits.jerk {
                let bends = bends(axis, [from, row], passages);
                let jerk = self.jerk(axis, [a0, a1], bends, duration_s);
                within((axis, "jerk", limit), jerk, time_s)?;
                used = used.max(cube_root(jerk / limit));
            }
            self.use_of_limits = self.use_of_limits.max(used);
        }
        self.duration_s = duration_s;
        Ok(())
    }

    /// The jerk of an axis on a segment with these accelerations and bends at its ends, and from the
    /// one before to it, which it takes the place of.
    fn jerk(&mut self, axis: usize, [a0, a1]: [f64; 2], bends: [f64; 2], duration_s: f64) -> f64 {
        let [start_bend, end_bend] = bends;
        let middle = (a0 + a1) * 0.5;
        let begins = self.duration_s == 0.0;
        let before = [&self.accelerations, &self.middles].map(|values| of_axis(values, axis));
        let [end_before, middle_before] = if begins { [start_bend; 2] } else { before };
        let kept = [&mut self.accelerations, &mut self.middles, &mut self.bends];
        for (kept, value) in kept.into_iter().zip([a1, middle, end_bend]) {
            if let Some(slot) = kept.as_mut_slice().get_mut(axis) {
                *slot = value;
            }
        }
        let middles_s = (self.duration_s + duration_s) * 0.5;
        let inside = (a1 - a0).abs() / duration_s;
        let step = (a0 - end_before).abs() / middles_s;
        let between = (middle - middle_before).abs() / middles_s;
        inside.max(step).max(between)
    }

    /// Where the machine rests the acceleration goes to zero, and where its velocities jump to what
    /// the path's bend asks for.
    fn check_eased<E>(&mut self, time_s: f64) -> Result<(), Violation<E>> {
        let half_s = core::mem::take(&mut self.duration_s) * 0.5;
        if half_s == 0.0 {
            return Ok(()); // one behind the other
        }
        for (axis, limits) in A::each(&self.promise.limits).iter().enumerate() {
            if let Some(limit) = limits.jerk {
                let bend = of_axis(&self.bends, axis);
                let values = [&self.accelerations, &self.middles];
                let values = values.map(|values| (of_axis(values, axis) - bend).abs());
                let most = values[0].max(values[1]);
                within((axis, "jerk", limit), most / half_s, time_s)?;
            }
        }
        Ok(())
    }

    fn check_rest<E>(&mut self, row: &Row<A>) -> Result<(), Violation<E>> {
        if !row.is_at_rest() {
            return Ok(());
        }
        self.check_eased(row.time_s)?;
        let times = 1.0 / self.use_of_limits;
        self.use_of_limits = 0.0;
        if times <= self.promise.max_slowness {
            return Ok(());
        }
        Err(Violation::Slow {
            time_s: row.time_s,
            times,
        })
    }
}

/// Refuses what is above a limit.
fn within<E>(
    (axis, name, limit): (usize, &'static str, f64),
    value: f64,
    time_s: f64,
) -> Result<(), Violation<E>> {
    // Written so that NaN is above.
    let is_within = value <= limit * (1.0 + ROUNDING);
    if is_within {
        return Ok(());
    }
    Err(Violation::Limit {
        axis,
        name,
        time_s,
        value,
        limit,
    })
}

/// Difference of velocities at a smooth corner, relative to the fastest axis.
const SMOOTH: f64 = 1e-6;
