//! The limits of the axes as factors, with what rounding needs of them.

use crate::number::{LARGEST, SMALLEST, cube_root, sqrt};
use crate::{Axes, AxisLimits, Knot, PlanError, ToolLimits};

/// By how much limits are taken lower: what a dozen products round off.
pub(crate) const MARGIN: f64 = 1.0 + 64.0 * f64::EPSILON;

/// One over the limits of an axis, a margin included.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reciprocal {
    pub(crate) speed: f64,
    pub(crate) acceleration: f64,
    /// 0 without such a limit.
    pub(crate) jerk: f64,
}

/// The reciprocals of all axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reciprocals<A: Axes> {
    axes: A::Of<Reciprocal>,
    has_jerk: bool,
}

impl<A: Axes> Reciprocals<A> {
    pub(crate) fn new(limits: &A::Of<AxisLimits>) -> Self {
        let mut reciprocals = A::filled(Reciprocal {
            speed: 0.0,
            acceleration: 0.0,
            jerk: 0.0,
        });
        for (reciprocal, limits) in A::each_mut(&mut reciprocals)
            .iter_mut()
            .zip(A::each(limits))
        {
            *reciprocal = Reciprocal {
                speed: MARGIN / limits.speed,
                acceleration: MARGIN / limits.acceleration,
                jerk: limits.jerk.map_or(0.0, |jerk| MARGIN / jerk),
            };
        }
        Self {
            axes: reciprocals,
            has_jerk: A::each(limits).iter().any(|limits| limits.jerk.is_some()),
        }
    }

    /// The reciprocals of limits within the range of the crate.
    pub(crate) fn checked<E>(limits: &A::Of<AxisLimits>) -> Result<Self, PlanError<E>> {
        for (axis, limits) in A::each(limits).iter().enumerate() {
            if let Some((name, value)) = limits.outside() {
                return Err(PlanError::Limit {
                    axis,
                    name,
                    value,
                    min: SMALLEST,
                    max: LARGEST,
                });
            }
        }
        Ok(Self::new(limits))
    }

    /// The reciprocals with a fraction of each speed limit.
    pub(crate) fn at_feed(&self, feed: f64) -> Self {
        let mut slower = *self;
        for limits in A::each_mut(&mut slower.axes) {
            limits.speed /= feed;
        }
        slower
    }

    /// The shortest time of a segment that starts and ends at rest.
    ///
    /// ```text
    /// speed 3Δq / 2T   acceleration 6Δq / T²   jerk 12Δq / T³
    /// ```
    pub(crate) fn rest_to_rest_s(
        &self,
        [from, to]: [&Knot<A>; 2],
        tool: Option<&ToolLimits>,
    ) -> f64 {
        let ends = [from, to].map(|knot| knot.point.position.as_slice());
        let [starts, ends] = ends;
        let distances = starts.iter().zip(ends);
        let distances = distances.map(|(q0, q1)| (q1 - q0).abs());
        let of_axes = (A::each(&self.axes).iter().zip(distances)).map(|(limits, distance)| {
            [limits.speed, limits.acceleration, limits.jerk].map(|limit| distance * limit)
        });
        let of_tool = tool.map(|tool| {
            let acceleration = tool
                .acceleration
                .map_or(0.0, |limit| MARGIN * to.ds / limit);
            [MARGIN * to.ds / tool.feed, acceleration, 0.0]
        });
        of_axes
            .chain(of_tool)
            .fold(0.0, |time_s: f64, [speed, acceleration, jerk]| {
                time_s
                    .max(1.5 * speed)
                    .max(sqrt(6.0 * acceleration))
                    .max(cube_root(12.0 * jerk))
            })
    }

    /// Whether any axis has a limit of jerk.
    pub(crate) const fn has_jerk(&self) -> bool {
        self.has_jerk
    }

    /// Those of each axis.
    pub(crate) fn axes(&self) -> &[Reciprocal] {
        A::each(&self.axes)
    }
}
