//! The limits of the axes as factors, with what rounding needs of them.

use crate::number::{LARGEST, Real, SMALLEST};
use crate::{Axes, AxisLimits, PlanError};

/// By how much limits are taken lower: what a dozen products round off.
pub(crate) fn margin<R: Real>() -> R {
    R::ONE + R::of(64.0) * R::EPSILON
}

/// The largest limit in single precision, and one over the smallest.
const LARGEST_SINGLE: f64 = 1e8;

/// One over the limits of an axis, a margin included.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reciprocal<R = f64> {
    pub(crate) speed: R,
    pub(crate) acceleration: R,
    /// 0 without such a limit.
    pub(crate) jerk: R,
}

/// The reciprocals of all axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reciprocals<A: Axes, R: Real = f64> {
    axes: A::Of<Reciprocal<R>>,
    has_jerk: bool,
}

impl<A: Axes, R: Real> Reciprocals<A, R> {
    pub(crate) fn new(limits: &A::Of<AxisLimits>) -> Self {
        let mut reciprocals = A::filled(Reciprocal {
            speed: R::ZERO,
            acceleration: R::ZERO,
            jerk: R::ZERO,
        });
        for (reciprocal, limits) in A::each_mut(&mut reciprocals)
            .iter_mut()
            .zip(A::each(limits))
        {
            let per = |limit: f64| margin::<R>() / R::of(limit);
            *reciprocal = Reciprocal {
                speed: per(limits.speed),
                acceleration: per(limits.acceleration),
                jerk: limits.jerk.map_or(R::ZERO, per),
            };
        }
        Self {
            axes: reciprocals,
            has_jerk: A::each(limits).iter().any(|limits| limits.jerk.is_some()),
        }
    }

    /// With the mean acceleration from rest to the limit of speed in place of the limits of
    /// acceleration and jerk, for plans that know of no jerk.
    ///
    /// ```text
    /// v / (v/a + a/J)     with √(v J) for an a above it
    /// ```
    pub(crate) fn ramped(&self) -> Self {
        let mut ramped = *self;
        for limits in A::each_mut(&mut ramped.axes) {
            if limits.jerk > R::ZERO {
                let square = limits.speed * limits.jerk;
                let reached = limits.acceleration.max(square.sqrt());
                limits.acceleration = reached + square / reached;
            }
        }
        ramped
    }

    /// Those of each axis.
    pub(crate) fn axes(&self) -> &[Reciprocal<R>] {
        A::each(&self.axes)
    }

    /// Whether any axis has a limit of jerk.
    pub(crate) const fn has_jerk(&self) -> bool {
        self.has_jerk
    }
}

impl<A: Axes> Reciprocals<A> {
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

    /// The reciprocals in single precision, of limits that it can be computed with.
    pub(crate) fn single<E>(
        limits: &A::Of<AxisLimits>,
    ) -> Result<Reciprocals<A, f32>, PlanError<E>> {
        let (min, max) = (1.0 / LARGEST_SINGLE, LARGEST_SINGLE);
        for (axis, limits) in A::each(limits).iter().enumerate() {
            for (name, value) in [
                ("speed", limits.speed),
                ("acceleration", limits.acceleration),
            ] {
                if !(min..=max).contains(&value) {
                    return Err(PlanError::Limit {
                        axis,
                        name,
                        value,
                        min,
                        max,
                    });
                }
            }
        }
        Ok(Reciprocals::new(limits))
    }

    /// The reciprocals with a fraction of each speed limit.
    pub(crate) fn at_feed(&self, feed: f64) -> Self {
        let mut slower = *self;
        for limits in A::each_mut(&mut slower.axes) {
            limits.speed /= feed;
        }
        slower
    }
}
