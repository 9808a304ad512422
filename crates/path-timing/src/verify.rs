//! A verifier of rows: what a plan promises, proven again without the planner.
//!
//! Goal: whoever runs rows, from this crate or over a wire, can prove that they keep what was
//! promised. Method: each cubic by its own formulas, from positions, velocities and time alone; the
//! path is asked for the places that the rows name. No line of it is used by the planner, nor the
//! other way round.

use trig_kernels::SixDigits;

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

/// A promise that rows break. `E` is the path's own error.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Violation<E> {
    /// A limit of an axis is passed in the segment up to a time.
    #[error("axis {axis}, up to {} s: {name} reaches {}, the limit is {}", SixDigits(*.time_s), SixDigits(*.value), SixDigits(*.limit))]
    Limit {
        /// The axis, from 0.
        axis: usize,
        /// Which: `speed`, `acceleration`, `jerk` or `velocity jump`.
        name: &'static str,
        /// Time of the row at the end of the segment.
        time_s: f64,
        /// The largest value.
        value: f64,
        /// The limit.
        limit: f64,
    },
    /// A limit of the tool is passed at a row, or by its mean acceleration from the row before.
    #[error("tool, up to {} s: {name} reaches {}, the limit is {}", SixDigits(*.time_s), SixDigits(*.value), SixDigits(*.limit))]
    Tool {
        /// Which: `feed` or `acceleration`.
        name: &'static str,
        /// Time of the row.
        time_s: f64,
        /// The largest value.
        value: f64,
        /// The limit.
        limit: f64,
    },
    /// A position or a velocity is not that of the path at the place that the row names.
    #[error("axis {axis}, at {} s: {name} is {} off the path", SixDigits(*.time_s), SixDigits(*.by))]
    OffPath {
        /// The axis, from 0.
        axis: usize,
        /// Which: `position` or `velocity`.
        name: &'static str,
        /// Time of the row.
        time_s: f64,
        /// By how much.
        by: f64,
    },
    /// The parameter of the path turns back on a segment: its speed at an end times the duration is
    /// negative or more than three times the length.
    #[error("up to {} s: the path turns back; {} times the length", SixDigits(*.time_s), SixDigits(*.times))]
    TurnsBack {
        /// Time of the row at the end of the segment.
        time_s: f64,
        /// The speed at an end times the duration, over the length.
        times: f64,
    },
    /// The tool departs by more than was promised.
    #[error("up to {} s: a departure of {}, {} is promised", SixDigits(*.time_s), SixDigits(*.departure), SixDigits(*.promised))]
    Departure {
        /// Time of the row at the end of the segment.
        time_s: f64,
        /// The departure's bound.
        departure: f64,
        /// The largest one promised.
        promised: f64,
    },
    /// A time is not after the one before by the duration of the segment.
    #[error("at {} s: the row does not follow the one before", SixDigits(*.time_s))]
    Time {
        /// Time of the row.
        time_s: f64,
    },
    /// Paths are not in their order, a parameter does not rise, or there is no such path.
    #[error("leg {leg}, at {}: the row does not follow the one before", SixDigits(*.s))]
    Order {
        /// The leg of the row.
        leg: usize,
        /// Its parameter.
        s: f64,
    },
    /// A motion between two rests is slower than it is promised to be.
    #[error("up to {} s: all limits allow {} times the speed", SixDigits(*.time_s), SixDigits(*.times))]
    Slow {
        /// Time of the rest.
        time_s: f64,
        /// How many times as fast it might be.
        times: f64,
    },
    /// The machine may not be there.
    #[error("leg {leg}, up to {}: {reason}", SixDigits(*.s))]
    Path {
        /// The leg.
        leg: usize,
        /// The parameter of the row.
        s: f64,
        /// What the path said.
        reason: E,
    },
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
    /// Accelerations at the end of the segment before and in its middle, and its duration; zero at
    /// rest and at a jump.
    accelerations: A,
    middles: A,
    duration_s: f64,
    /// The largest part of a limit since the last rest, as a factor of all speeds.
    use_of_limits: f64,
}

/// The cubic of an axis by itself: in units of its duration q = q₀ + v₀ τ + b τ² + c τ³.
struct Motion {
    v0: f64,
    b: f64,
    c: f64,
    duration_s: f64,
}

impl Motion {
    fn new([q0, q1]: [f64; 2], [v0, v1]: [f64; 2], duration_s: f64) -> Self {
        let (rise, v0, v1) = (q1 - q0, v0 * duration_s, v1 * duration_s);
        Self {
            v0,
            b: 3.0 * rise - 2.0 * v0 - v1,
            c: v0 + v1 - 2.0 * rise,
            duration_s,
        }
    }

    /// The largest speed, at an end or where 2b + 6c τ = 0.
    fn speed(&self) -> f64 {
        let at = |tau: f64| (self.v0 + (2.0 * self.b + 3.0 * self.c * tau) * tau).abs();
        let ends = at(0.0).max(at(1.0));
        let vertex = -self.b / (3.0 * self.c);
        let inside = if vertex > 0.0 && vertex < 1.0 {
            at(vertex)
        } else {
            0.0
        };
        ends.max(inside) / self.duration_s
    }

    fn accelerations(&self) -> [f64; 2] {
        let square = self.duration_s * self.duration_s;
        [
            2.0 * self.b / square,
            (2.0 * self.b + 6.0 * self.c) / square,
        ]
    }
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
        let speeds = self.check_parameter(&path, &span)?;
        self.check_tool(&path, &span, speeds)?;
        self.check_limits(&from, row)?;
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
        speed_on_path(path, row.s, row).map(|_| ())
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
        speed_on_path(path, row.s, row)?;
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
    ) -> Result<[f64; 2], Violation<P::Error>> {
        let ([from, to], [s0, s1]) = (&span.rows, span.s);
        let speeds = [speed_on_path(path, s0, from)?, speed_on_path(path, s1, to)?];
        for speed in speeds {
            let times = speed * to.duration_s / (s1 - s0);
            // Written so that NaN turns back.
            let goes_on = (-ROUNDING..=3.0 + ROUNDING).contains(&times);
            if !goes_on {
                let time_s = to.time_s;
                return Err(Violation::TurnsBack { time_s, times });
            }
        }
        Ok(speeds)
    }

    /// The feed, which is a speed of the parameter, at both ends, and the tool's mean acceleration.
    fn check_tool<P: Path<Axes = A>>(
        &self,
        path: &P,
        span: &Span<A>,
        [w0, w1]: [f64; 2],
    ) -> Result<(), Violation<P::Error>> {
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

    fn check_limits<E>(&mut self, from: &Row<A>, row: &Row<A>) -> Result<(), Violation<E>> {
        let positions = from.position.as_slice().iter().zip(row.position.as_slice());
        let velocities = from.velocity.as_slice().iter().zip(row.velocity.as_slice());
        let limits = A::each(&self.promise.limits).iter().enumerate();
        let all = limits.zip(positions.zip(velocities));
        let middles = self.middles.as_mut_slice().iter_mut();
        let ends = (self.accelerations.as_mut_slice().iter_mut()).zip(middles);
        let (time_s, duration_s) = (row.time_s, row.duration_s);
        let middles_s = (self.duration_s + duration_s) * 0.5;
        for (((axis, limits), ((q0, q1), (v0, v1))), (before, middle_before)) in all.zip(ends) {
            let motion = Motion::new([*q0, *q1], [*v0, *v1], duration_s);
            let (speed, [a0, a1]) = (motion.speed(), motion.accelerations());
            let (acceleration, middle) = (a0.abs().max(a1.abs()), (a0 + a1) * 0.5);
            within((axis, "speed", limits.speed), speed, time_s)?;
            within(
                (axis, "acceleration", limits.acceleration),
                acceleration,
                time_s,
            )?;
            let mut used = (speed / limits.speed).max(sqrt(acceleration / limits.acceleration));
            if let Some(limit) = limits.jerk {
                let inside = (a1 - a0).abs() / duration_s;
                let step = (a0 - *before).abs() / middles_s;
                let between = (middle - *middle_before).abs() / middles_s;
                let jerk = inside.max(step).max(between);
                within((axis, "jerk", limit), jerk, time_s)?;
                used = used.max(cube_root(jerk / limit));
            }
            self.use_of_limits = self.use_of_limits.max(used);
            (*before, *middle_before) = (a1, middle);
        }
        self.duration_s = duration_s;
        Ok(())
    }

    /// Where the machine rests, or its velocities jump, the acceleration goes to zero.
    fn check_eased<E>(&mut self, time_s: f64) -> Result<(), Violation<E>> {
        let limits = A::each(&self.promise.limits).iter().enumerate();
        let half_s = self.duration_s * 0.5;
        let ends = self.accelerations.as_slice().iter();
        let ends = ends.zip(self.middles.as_slice());
        for ((axis, limits), (end, middle)) in limits.zip(ends) {
            if let Some(limit) = limits.jerk {
                let most = end.abs().max(middle.abs());
                within((axis, "jerk", limit), most / half_s, time_s)?;
            }
        }
        (self.accelerations, self.middles) = (A::zeros(), A::zeros());
        self.duration_s = 0.0;
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

/// The speed of the parameter with which a row passes a place of the path.
fn speed_on_path<P: Path>(
    path: &P,
    s: f64,
    row: &Row<P::Axes>,
) -> Result<f64, Violation<P::Error>> {
    let (leg, time_s) = (row.leg, row.time_s);
    let point = path
        .point(s)
        .map_err(|reason| Violation::Path { leg, s, reason })?;
    let off = |axis, name, by| Violation::OffPath {
        axis,
        name,
        time_s,
        by,
    };
    let positions = row
        .position
        .as_slice()
        .iter()
        .zip(point.position.as_slice());
    for (axis, (is, wanted)) in positions.enumerate() {
        // Written so that NaN is off.
        let is_there = (is - wanted).abs() <= ROUNDING * (1.0 + wanted.abs());
        if !is_there {
            return Err(off(axis, "position", is - wanted));
        }
    }
    let velocities = || row.velocity.as_slice().iter().zip(point.slope.as_slice());
    let steepest = velocities().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let Some((velocity, slope)) = steepest.filter(|(_, slope)| **slope != 0.0) else {
        return Ok(0.0);
    };
    let speed = velocity / slope;
    for (axis, (is, slope)) in velocities().enumerate() {
        let by = is - slope * speed;
        // A smooth corner has the slope of the path after it: nine digits.
        if by.abs() > SMOOTH * velocity.abs() {
            return Err(off(axis, "velocity", by));
        }
    }
    Ok(speed)
}

/// Difference of velocities at a smooth corner, relative to the fastest axis.
const SMOOTH: f64 = 1e-6;
