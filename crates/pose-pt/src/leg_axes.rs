//! A leg as the axes of a platform see it.

use nalgebra::Vector3;

use crate::number::{epsilons, larger};
use crate::path::leg::{Shape, Turning, VectorLeg};
use crate::path::{Leg, PosePath};
use crate::rotation::to_matrix;
use crate::turn::{Sweep, Turn};
use crate::{Platform, PoseVector};

/// Axis coordinates as a function of the leg's parameter s, 0..=1.
#[derive(Debug, Clone, Copy)]
pub(crate) enum LegAxes<'a, const N: usize> {
    Turning(TurningAxes<N>),
    Vector(&'a Platform<N>, VectorLeg),
}

/// Every axis is start + s slide + sin θ sine + (1 - cos θ) versine, θ = s · angle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TurningAxes<const N: usize> {
    start: [Vector3<f64>; N],
    pub(crate) slide: [Vector3<f64>; N],
    pub(crate) sine: [Vector3<f64>; N],
    pub(crate) versine: [Vector3<f64>; N],
    pub(crate) angle: f64,
}

/// By how much more than the body an axis may move where the three of a locator are least
/// independent, and what positions round off besides.
const STILL_EPSILONS: f64 = 64.0;

/// Whether the body stays where it is on leg `number`, or moves by so little that no axis sees
/// it.
pub(crate) fn is_still<const N: usize>(
    platform: &Platform<N>,
    path: &PosePath<'_>,
    number: usize,
) -> bool {
    let ends = path
        .axes(platform, number)
        .zip(path.axes(platform, number.saturating_add(1)));
    let Some((leg, (start, end))) = path.leg(number).zip(ends) else {
        return false;
    };
    let far = start.iter().map(Vector3::amax).fold(0.0, larger);
    start == end && travel(platform, &leg) <= far * epsilons::<f64>(STILL_EPSILONS)
}

/// A bound on how far a point of the body that is no farther from the reference point than an
/// anchor moves on a leg.
pub(crate) fn travel<const N: usize>(platform: &Platform<N>, leg: &Leg) -> f64 {
    let arms = platform.anchors().iter().map(|anchor| anchor.coords.norm());
    leg.length() + leg.turn() * arms.fold(0.0, larger)
}

/// The state of a walk along a leg by equal segments.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Walk {
    Turning(Sweep<1>),
    Vector(Sweep<3>),
}

impl<'a, const N: usize> LegAxes<'a, N> {
    pub(crate) fn new(platform: &'a Platform<N>, leg: &Leg) -> Self {
        match &leg.shape {
            Shape::Turning(leg) => Self::Turning(TurningAxes::new(platform, leg)),
            Shape::Vector(leg) => Self::Vector(platform, *leg),
        }
    }

    /// The start of a walk by `segments` equal segments.
    pub(crate) fn walk(&self, segments: u32) -> Walk {
        match self {
            Self::Turning(leg_axes) => Walk::Turning(Sweep::new([0.0], [leg_axes.angle], segments)),
            Self::Vector(_, leg) => Walk::Vector(Sweep::new(
                leg.from.angles().into(),
                leg.angles_change().into(),
                segments,
            )),
        }
    }

    /// Axes at the present point of a walk.
    #[inline]
    pub(crate) fn axes(&self, walk: &Walk) -> [Vector3<f64>; N] {
        match (self, walk) {
            (Self::Turning(leg_axes), Walk::Turning(sweep)) => {
                let [turn] = *sweep.now();
                leg_axes.axes(sweep.fraction(), turn)
            }
            (Self::Vector(platform, leg), Walk::Vector(sweep)) => {
                let [alpha, beta, gamma] = sweep.now().map(|turn| (turn.sin, turn.cos()));
                let rotation = PoseVector::rotation_of_sines([alpha, beta, gamma], leg.convention);
                let position = leg.from.position() + leg.slide() * sweep.fraction();
                platform.axes_at(&rotation, &position)
            }
            // A walk belongs to its leg.
            _ => [Vector3::zeros(); N],
        }
    }
}

impl Walk {
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

impl<const N: usize> TurningAxes<N> {
    fn new(platform: &Platform<N>, leg: &Turning) -> Self {
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
    pub(crate) fn axes(&self, s: f64, turn: Turn) -> [Vector3<f64>; N] {
        let mut axes = self.start;
        let parts = self.slide.iter().zip(&self.sine).zip(&self.versine);
        for (axes, ((slide, sine), versine)) in axes.iter_mut().zip(parts) {
            *axes += slide * s + (sine * turn.sin + versine * turn.versine);
        }
        axes
    }
}
