//! The legs of a path on which something moves and the blends between them, as the axes run them.

use nalgebra::Vector3;
use path_timing::{Corner, Span};

use super::strokes;
use crate::course::{Course, CoursePoint, is_still, travel};
use crate::number::larger;
use crate::path::blend::Rounding;
use crate::path::{Leg, Path};
use crate::{LimitError, Platform, PvtPoint};

/// A leg or a blend with both ends exactly where its neighbours have them: a controller gets one
/// position for the end of one and the start of the next, while each by itself would round it anew.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Track<'a, const N: usize> {
    platform: &'a Platform<N>,
    piece: Piece<'a, N>,
    /// In the parameter that is common to all.
    length: f64,
    ends: [[Vector3<f64>; N]; 2],
    /// Whether the next one is entered without a stop.
    goes_on: bool,
    /// Bounds on the length of the reference point's path and on the turn of the body.
    pub(super) travel: [f64; 2],
}

#[derive(Debug, Clone, Copy)]
enum Piece<'a, const N: usize> {
    /// The part of a leg between two of its parameters.
    Leg(Course<'a, N>, [f64; 2]),
    Blend(Rounding),
}

impl<const N: usize> path_timing::Path for Track<'_, N> {
    type Axes = [[f64; 3]; N];
    type Error = LimitError;

    fn length(&self) -> f64 {
        self.length
    }

    fn point(&self, s: f64) -> Result<path_timing::PathPoint<[[f64; 3]; N]>, LimitError> {
        let point = match &self.piece {
            Piece::Leg(course, [from, to]) => {
                let rate = (to - from) / self.length;
                let point = course.point(from + s * rate);
                CoursePoint {
                    slope: point.slope.map(|slope| slope * rate),
                    ..point
                }
            }
            Piece::Blend(rounding) => CoursePoint::of(self.platform, &rounding.motion(s)),
        };
        let [start, end] = self.ends;
        let axes = if s <= 0.0 {
            start
        } else if s >= self.length {
            end
        } else {
            point.axes
        };
        Ok(path_timing::PathPoint {
            position: axes.map(Into::into),
            slope: point.slope.map(Into::into),
        })
    }

    fn corner(&self) -> Corner<[[f64; 3]; N]> {
        if self.goes_on {
            Corner::Smooth
        } else {
            Corner::Stop
        }
    }

    fn check(&self, span: &Span<[[f64; 3]; N]>) -> Result<(), LimitError> {
        strokes::check(self.platform, span)
    }
}

/// The legs on which something moves and the blends between them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moving<'a, const N: usize> {
    pub(super) platform: &'a Platform<N>,
    path: Path<'a>,
    /// The longest travel of a leg, which the common parameter takes 1 to run.
    longest: f64,
    /// The first piece that is still to come: 2 n is leg n, 2 n + 1 the blend after it.
    first: usize,
}

impl<'a, const N: usize> Moving<'a, N> {
    pub(super) fn new(platform: &'a Platform<N>, path: &Path<'a>) -> Self {
        let travels = path.numbered_legs().map(|(_, leg)| travel(platform, &leg));
        Self {
            platform,
            longest: travels.fold(0.0, larger),
            path: *path,
            first: 0,
        }
    }

    /// What the common parameter takes to run a leg: 1 where there are only stops.
    fn size(&self, leg: &Leg) -> f64 {
        if self.path.has_blends() {
            travel(self.platform, leg) / self.longest
        } else {
            1.0
        }
    }

    fn pieces(self) -> impl Iterator<Item = usize> {
        let end = self.path.legs().saturating_mul(2);
        (self.first..end).filter(move |piece| self.has(*piece))
    }

    fn has(&self, piece: usize) -> bool {
        if piece.is_multiple_of(2) {
            !self.is_still(piece / 2)
        } else {
            self.rounding(piece / 2).is_some()
        }
    }

    /// The number in the path of leg `index` of these; of a blend that of the leg before it.
    pub(crate) fn number(&self, index: usize) -> usize {
        self.pieces().nth(index).map_or(0, |piece| piece / 2)
    }

    /// The part of leg `index` of these that is done at a parameter of it, 0..=1.
    pub(crate) fn part(&self, index: usize, s: f64) -> f64 {
        let mut rest = *self;
        let track = rest.nth(index);
        track.map_or(0.0, |track| s / track.length)
    }

    /// At the first pose, at rest.
    pub(super) fn first_point(&self) -> Option<PvtPoint<N>> {
        let axes = self.path.axes(self.platform, 0)?;
        Some(PvtPoint {
            time_s: 0.0,
            segment_s: 0.0,
            axes,
            velocities: [Vector3::zeros(); N],
        })
    }

    fn is_still(&self, number: usize) -> bool {
        is_still(self.platform, &self.path, number)
    }

    /// The rounding of the pose after leg `number`.
    fn rounding(&self, number: usize) -> Option<Rounding> {
        let next = number.checked_add(1)?;
        if !self.path.has_blends() || self.is_still(number) || self.is_still(next) {
            return None;
        }
        self.path.rounding(number, |leg| self.size(leg))
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
            Some(Course::new(self.platform, &leg).point(s).axes)
        }
    }

    fn track(&self, piece: usize) -> Option<Track<'a, N>> {
        let number = piece / 2;
        if piece.is_multiple_of(2) {
            self.leg(number)
        } else {
            self.blend(number)
        }
    }

    fn leg(&self, number: usize) -> Option<Track<'a, N>> {
        let leg = self.path.leg(number)?;
        let [from, to] = self.rest(number, &leg);
        Some(Track {
            platform: self.platform,
            piece: Piece::Leg(Course::new(self.platform, &leg), [from, to]),
            length: (to - from) * self.size(&leg),
            ends: [self.axes(number, from)?, self.axes(number, to)?],
            goes_on: self.rounding(number).is_some(),
            travel: [leg.length(), leg.turn()].map(|whole| whole * (to - from)),
        })
    }

    fn blend(&self, number: usize) -> Option<Track<'a, N>> {
        let rounding = self.rounding(number)?;
        let next = number.checked_add(1)?;
        let [_, from] = self.rest(number, &self.path.leg(number)?);
        let [to, _] = self.rest(next, &self.path.leg(next)?);
        Some(Track {
            platform: self.platform,
            piece: Piece::Blend(rounding),
            length: 2.0 * rounding.reach(),
            ends: [self.axes(number, from)?, self.axes(next, to)?],
            goes_on: true,
            travel: rounding.travel(),
        })
    }
}

impl<'a, const N: usize> Iterator for Moving<'a, N> {
    type Item = Track<'a, N>;

    fn next(&mut self) -> Option<Self::Item> {
        let piece = self.pieces().next()?;
        self.first = piece.saturating_add(1);
        self.track(piece)
    }
}
