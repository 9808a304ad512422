//! The legs of a path on which something moves and the blends between them, as the axes run them,
//! to be timed by `path-timing`.

mod error;
mod hermite;
mod motion;
mod rounding;
mod strokes;

use nalgebra::Vector3;
use path_timing::{Corner, PathPoint, Span};

pub use error::BodyPathError;
pub use hermite::hermite_distance_error;

use crate::leg_axes::{LegAxes, is_still, travel};
use crate::number::larger;
use crate::path::{Leg, PosePath};
use crate::{LimitError, Platform};
use motion::AxesPoint;
use rounding::Rounding;

/// A leg of a [`PosePath`], or the rounding of one of its poses, as a path of all axes: what
/// [`path_timing::Table`] and [`path_timing::LookAhead`] plan.
///
/// It is made by [`Platform::paths`]. Its parameter has no unit.
#[derive(Debug, Clone, Copy)]
pub struct BodyPath<'a, const N: usize> {
    platform: &'a Platform<N>,
    part: Part<'a, N>,
    /// The leg, or that before the rounding.
    leg: usize,
    /// In the parameter that is common to all.
    length: f64,
    /// Exactly where its neighbours have them: a controller gets one position for the end of one
    /// and the start of the next, while each by itself would round it once more.
    ends: [[Vector3<f64>; N]; 2],
    /// Whether the next one is entered without a stop.
    goes_on: bool,
}

#[derive(Debug, Clone, Copy)]
enum Part<'a, const N: usize> {
    /// The part of a leg between two of its parameters.
    Leg(LegAxes<'a, N>, [f64; 2]),
    Blend(Rounding),
}

impl<const N: usize> Platform<N> {
    /// The legs of `path` on which something moves, each as a path of all axes, with the roundings
    /// of the poses between them.
    ///
    /// Every pose where the direction changes is a stop, but for those that are rounded: see
    /// [`PosePath::with_blends`]. Strokes are checked by what plans, for whole segments.
    #[must_use]
    pub fn paths<'a>(&'a self, path: &PosePath<'a>) -> BodyPaths<'a, N> {
        let travels = path.numbered_legs().map(|(_, leg)| travel(self, &leg));
        BodyPaths {
            platform: self,
            longest: travels.fold(0.0, larger),
            path: *path,
            first: 0,
        }
    }

    /// Speed, acceleration and jerk of each axis, as `path-timing` takes them.
    #[must_use]
    pub fn axis_limits(&self) -> [[path_timing::AxisLimits; 3]; N] {
        self.locators().map(|locator| {
            locator.limits.map(|limits| path_timing::AxisLimits {
                speed: limits.speed,
                acceleration: limits.acceleration,
                jerk: limits.jerk,
            })
        })
    }
}

impl<const N: usize> BodyPath<'_, N> {
    /// The number in the path, from 0, of this leg, or of the leg before this rounding.
    #[must_use]
    pub const fn leg(&self) -> usize {
        self.leg
    }

    /// [`hermite_distance_error`] of a segment: a departure for
    /// [`path_timing::Table::plan_within`].
    #[must_use]
    pub fn departure(&self, span: &Span<[[f64; 3]; N]>) -> f64 {
        hermite_distance_error(self.platform, &span.rows)
    }

    fn axes_point(&self, s: f64) -> AxesPoint<N> {
        match &self.part {
            Part::Leg(leg_axes, [from, to]) => {
                let rate = (to - from) / self.length;
                let point = leg_axes.point(from + s * rate);
                AxesPoint {
                    slope: point.slope.map(|slope| slope * rate),
                    ..point
                }
            }
            Part::Blend(rounding) => AxesPoint::of(self.platform, &rounding.motion(s)),
        }
    }

    fn refused(&self, s: f64, reason: LimitError) -> BodyPathError {
        let part = s / self.length;
        match self.part {
            Part::Leg(..) => BodyPathError::Leg {
                leg: self.leg,
                part,
                reason,
            },
            Part::Blend(_) => BodyPathError::Blend {
                pose: self.leg.saturating_add(1),
                part,
                reason,
            },
        }
    }
}

impl<const N: usize> path_timing::Path for BodyPath<'_, N> {
    type Axes = [[f64; 3]; N];
    type Error = BodyPathError;

    fn length(&self) -> f64 {
        self.length
    }

    fn point(&self, s: f64) -> Result<PathPoint<[[f64; 3]; N]>, BodyPathError> {
        let AxesPoint { axes, slope } = self.axes_point(s);
        let [start, end] = self.ends;
        let axes = if s <= 0.0 {
            start
        } else if s >= self.length {
            end
        } else {
            axes
        };
        Ok(PathPoint {
            position: axes.map(Into::into),
            slope: slope.map(Into::into),
        })
    }

    fn corner(&self) -> Corner<[[f64; 3]; N]> {
        if self.goes_on {
            Corner::Smooth
        } else {
            Corner::Stop
        }
    }

    fn check(&self, span: &Span<[[f64; 3]; N]>) -> Result<(), BodyPathError> {
        let [start, _] = span.s;
        strokes::check(self.platform, span).map_err(|reason| self.refused(start, reason))
    }
}

/// The paths of all axes along a [`PosePath`], by [`Platform::paths`].
#[derive(Debug, Clone, Copy)]
pub struct BodyPaths<'a, const N: usize> {
    platform: &'a Platform<N>,
    path: PosePath<'a>,
    /// The longest travel of a leg, which the common parameter takes 1 to run.
    longest: f64,
    /// The first part that is still to come: 2 n is leg n, 2 n + 1 the blend after it.
    first: usize,
}

impl<'a, const N: usize> BodyPaths<'a, N> {
    /// What the common parameter takes to run a leg: 1 where there are only stops.
    fn size(&self, leg: &Leg) -> f64 {
        if self.path.blends().is_empty() {
            1.0
        } else {
            travel(self.platform, leg) / self.longest
        }
    }

    fn parts(self) -> impl Iterator<Item = usize> {
        let end = self.path.legs().saturating_mul(2);
        (self.first..end).filter(move |part| self.has(*part))
    }

    fn has(&self, part: usize) -> bool {
        if part.is_multiple_of(2) {
            !self.is_still(part / 2)
        } else {
            self.rounding(part / 2).is_some()
        }
    }

    fn is_still(&self, number: usize) -> bool {
        is_still(self.platform, &self.path, number)
    }

    /// The rounding of the pose after leg `number`.
    fn rounding(&self, number: usize) -> Option<Rounding> {
        let next = number.checked_add(1)?;
        if self.path.blends().is_empty() || self.is_still(number) || self.is_still(next) {
            return None;
        }
        let blend = self.path.blends().get(number)?;
        let (before, after) = (self.path.leg(number)?, self.path.leg(next)?);
        let sizes = [self.size(&before), self.size(&after)];
        Rounding::new(blend, [&before, &after], sizes)
    }

    /// The part of a leg that its blends leave, as two of its parameters.
    fn rest(&self, number: usize, leg: &Leg) -> [f64; 2] {
        let before = number.checked_sub(1);
        let taken = |rounding: Option<Rounding>| {
            rounding.map_or(0.0, |rounding| rounding.reach() / self.size(leg))
        };
        let start = before.and_then(|before| self.rounding(before));
        [taken(start), 1.0 - taken(self.rounding(number))]
    }

    /// Axes at a parameter of a leg.
    fn axes(&self, number: usize, s: f64) -> Option<[Vector3<f64>; N]> {
        if s <= 0.0 {
            self.path.axes(self.platform, number)
        } else if s >= 1.0 {
            self.path.axes(self.platform, number.checked_add(1)?)
        } else {
            let leg = self.path.leg(number)?;
            Some(LegAxes::new(self.platform, &leg).point(s).axes)
        }
    }

    fn path_of(&self, part: usize) -> Option<BodyPath<'a, N>> {
        let number = part / 2;
        if part.is_multiple_of(2) {
            self.leg(number)
        } else {
            self.blend(number)
        }
    }

    fn leg(&self, number: usize) -> Option<BodyPath<'a, N>> {
        let leg = self.path.leg(number)?;
        let [from, to] = self.rest(number, &leg);
        Some(BodyPath {
            platform: self.platform,
            part: Part::Leg(LegAxes::new(self.platform, &leg), [from, to]),
            leg: number,
            length: (to - from) * self.size(&leg),
            ends: [self.axes(number, from)?, self.axes(number, to)?],
            goes_on: self.rounding(number).is_some(),
        })
    }

    fn blend(&self, number: usize) -> Option<BodyPath<'a, N>> {
        let rounding = self.rounding(number)?;
        let next = number.checked_add(1)?;
        let [_, from] = self.rest(number, &self.path.leg(number)?);
        let [to, _] = self.rest(next, &self.path.leg(next)?);
        Some(BodyPath {
            platform: self.platform,
            part: Part::Blend(rounding),
            leg: number,
            length: 2.0 * rounding.reach(),
            ends: [self.axes(number, from)?, self.axes(next, to)?],
            goes_on: true,
        })
    }
}

impl<'a, const N: usize> Iterator for BodyPaths<'a, N> {
    type Item = BodyPath<'a, N>;

    fn next(&mut self) -> Option<Self::Item> {
        let part = self.parts().next()?;
        self.first = part.saturating_add(1);
        self.path_of(part)
    }
}
