//! A leg as the axes of a platform see it.

use nalgebra::{RealField, Vector3};

use crate::number::{epsilons, larger};
use crate::path::leg::{Shape, Turning, VectorLeg};
use crate::path::{Leg, Path};
use crate::rotation::to_matrix;
use crate::turn::{Sweep, Turn};
use crate::{Platform, PoseVector};

/// Axis coordinates and their derivative by the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place<const N: usize, T> {
    pub(crate) axes: [Vector3<T>; N],
    pub(crate) slope: [Vector3<T>; N],
}

/// Axis coordinates as a function of the leg's parameter s, 0..=1.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Course<'a, const N: usize, T: RealField> {
    Turning(TurningCourse<N, T>),
    Vector(&'a Platform<N, T>, VectorLeg<T>),
}

/// Every axis is start + s slide + sin θ sine + (1 - cos θ) versine, θ = s · angle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TurningCourse<const N: usize, T> {
    start: [Vector3<T>; N],
    slide: [Vector3<T>; N],
    sine: [Vector3<T>; N],
    versine: [Vector3<T>; N],
    angle: T,
}

/// By how much more than its way an axis may move where the three of a locator are least
/// independent, and what positions round off besides.
const STILL_EPSILONS: f64 = 64.0;

/// Whether the body stays where it is on leg `number`, or moves by so little that no axis sees
/// it.
pub(crate) fn is_still<const N: usize, T: RealField + Copy>(
    platform: &Platform<N, T>,
    path: &Path<'_, T>,
    number: usize,
) -> bool {
    let ends = path
        .axes(platform, number)
        .zip(path.axes(platform, number.saturating_add(1)));
    let Some((leg, (start, end))) = path.leg(number).zip(ends) else {
        return true;
    };
    let arms = platform.anchors().iter().map(|anchor| anchor.coords.norm());
    let way = leg.length() + leg.turn() * arms.fold(T::zero(), larger);
    let far = start.iter().map(Vector3::amax).fold(T::zero(), larger);
    start == end && way <= far * epsilons(STILL_EPSILONS)
}

/// Where a course stands that is walked by equal segments.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Walk<T> {
    Turning(Sweep<1, T>),
    Vector(Sweep<3, T>),
}

impl<'a, const N: usize, T: RealField + Copy> Course<'a, N, T> {
    pub(crate) fn new(platform: &'a Platform<N, T>, leg: &Leg<T>) -> Self {
        match &leg.shape {
            Shape::Turning(leg) => Self::Turning(TurningCourse::new(platform, leg)),
            Shape::Vector(leg) => Self::Vector(platform, *leg),
        }
    }

    /// Axes and slopes at a parameter.
    pub(crate) fn place(&self, s: T) -> Place<N, T> {
        match self {
            Self::Turning(course) => {
                let turn = Turn::of(course.angle * s);
                Place {
                    axes: course.axes(s, turn),
                    slope: course.slope(turn),
                }
            }
            Self::Vector(platform, leg) => {
                let vector = leg.at(s);
                let rotation = vector.to_rotation(leg.convention);
                let angular = leg.angular(&vector.angles());
                let slide = leg.slide();
                Place {
                    axes: platform.axes_at(&rotation, &vector.position()),
                    slope: platform.in_axes(
                        platform
                            .anchors()
                            .map(|anchor| slide + angular.cross(&(rotation * anchor.coords))),
                    ),
                }
            }
        }
    }

    /// The start of a walk by `segments` equal segments.
    pub(crate) fn walk(&self, segments: u32) -> Walk<T> {
        match self {
            Self::Turning(course) => {
                Walk::Turning(Sweep::new([T::zero()], [course.angle], segments))
            }
            Self::Vector(_, leg) => Walk::Vector(Sweep::new(
                leg.from.angles().into(),
                leg.angles_change().into(),
                segments,
            )),
        }
    }

    /// Axes where a walk stands.
    #[inline]
    pub(crate) fn axes(&self, walk: &Walk<T>) -> [Vector3<T>; N] {
        match (self, walk) {
            (Self::Turning(course), Walk::Turning(sweep)) => {
                let [turn] = *sweep.now();
                course.axes(sweep.share(), turn)
            }
            (Self::Vector(platform, leg), Walk::Vector(sweep)) => {
                let [alpha, beta, gamma] = sweep.now().map(|turn| (turn.sin, turn.cos()));
                let rotation = PoseVector::rotation_of_sines([alpha, beta, gamma], leg.convention);
                let position = leg.from.position() + leg.slide() * sweep.share();
                platform.axes_at(&rotation, &position)
            }
            // A walk belongs to its course.
            _ => [Vector3::zeros(); N],
        }
    }
}

impl<T: RealField + Copy> Walk<T> {
    #[inline]
    pub(crate) fn advance(&mut self) {
        match self {
            Self::Turning(sweep) => sweep.advance(),
            Self::Vector(sweep) => sweep.advance(),
        }
    }

    pub(crate) fn seek(&mut self, index: u32) {
        match self {
            Self::Turning(sweep) => sweep.seek(index),
            Self::Vector(sweep) => sweep.seek(index),
        }
    }
}

impl<const N: usize, T: RealField + Copy> TurningCourse<N, T> {
    fn new(platform: &Platform<N, T>, leg: &Turning<T>) -> Self {
        let rotation = to_matrix(&leg.rotation);
        let arms = platform.anchors().map(|anchor| rotation * anchor.coords);
        let across = arms.map(|arm| leg.axis.cross(&arm));
        Self {
            start: platform.axes_at(&rotation, &leg.start),
            slide: platform.in_axes([leg.slide; N]),
            sine: platform.in_axes(across.map(|across| leg.sine + across)),
            versine: platform.in_axes(across.map(|across| leg.versine + leg.axis.cross(&across))),
            angle: leg.angle,
        }
    }

    #[inline]
    fn axes(&self, s: T, turn: Turn<T>) -> [Vector3<T>; N] {
        let mut axes = self.start;
        let parts = self.slide.iter().zip(&self.sine).zip(&self.versine);
        for (axes, ((slide, sine), versine)) in axes.iter_mut().zip(parts) {
            *axes += slide * s + (sine * turn.sin + versine * turn.versine);
        }
        axes
    }

    fn slope(&self, turn: Turn<T>) -> [Vector3<T>; N] {
        let mut slope = self.slide;
        for (slope, (sine, versine)) in slope.iter_mut().zip(self.sine.iter().zip(&self.versine)) {
            *slope += (sine * turn.cos() + versine * turn.sin) * self.angle;
        }
        slope
    }
}
