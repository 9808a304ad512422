//! One curve of a run, with the disc taken over from the curve before.

use anyhow::Result;
use path_timing::{Corner, Path, PathPoint, Span, ToolLimits};
use scara_kin::{ArmPathError, DiscPath};

/// A curve of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg {
    path: DiscPath,
    /// Where the disc stands at the start, in radians.
    disc_rad: f64,
    /// By how much that is off the tangent; it goes to nothing along the curve.
    off_rad: f64,
    /// The tool is lifted before it.
    is_corner: bool,
    /// What the motors start with, in rad/s: joints jump by no more where the drawing has a kink.
    start_speeds: [f64; 3],
}

impl Leg {
    /// A curve that begins at rest, the disc along it.
    pub(super) fn from_rest(path: DiscPath, is_corner: bool, start_speeds: [f64; 3]) -> Self {
        Self {
            path,
            disc_rad: 0.0,
            off_rad: 0.0,
            is_corner,
            start_speeds,
        }
    }

    /// A curve that goes on from another, at whose end the disc stands at `disc_rad`.
    pub(super) fn going_on(
        path: DiscPath,
        disc_rad: f64,
        start_speeds: [f64; 3],
    ) -> Result<Self, ArmPathError> {
        let [.., own_rad] = path.point(0.0)?.position;
        Ok(Self {
            path,
            disc_rad,
            off_rad: disc_rad - own_rad,
            is_corner: false,
            start_speeds,
        })
    }

    /// The same with a share of what the motors start with.
    pub(super) fn with_share(&self, share: f64) -> Self {
        Self {
            start_speeds: self.start_speeds.map(|speed| speed * share),
            ..*self
        }
    }

    pub(super) const fn is_corner(&self) -> bool {
        self.is_corner
    }

    pub(super) fn departure(&self, span: &Span<[f64; 3]>) -> f64 {
        self.path.departure(span)
    }
}

impl Path for Leg {
    type Axes = [f64; 3];
    type Error = ArmPathError;

    fn length(&self) -> f64 {
        self.path.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 3]>, ArmPathError> {
        let mut point = self.path.point(s)?;
        if self.off_rad.abs() > 0.0 {
            let x = s / self.length();
            let ([.., disc], [.., slope]) = (&mut point.position, &mut point.slope);
            *disc = if s <= 0.0 {
                self.disc_rad
            } else {
                *disc + self.off_rad * (1.0 - x * x * (3.0 - 2.0 * x))
            };
            *slope -= self.off_rad * 6.0 * x * (1.0 - x) / self.length();
        }
        Ok(point)
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.path.tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        self.path.tool_rate(s)
    }

    fn corner(&self) -> Corner<[f64; 3]> {
        Corner::Jump(self.start_speeds)
    }

    fn check(&self, span: &Span<[f64; 3]>) -> Result<(), ArmPathError> {
        self.path.check(span)
    }
}
