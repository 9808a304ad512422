//! What differs from machine to machine.

mod arm;
mod axis;
mod delta;
mod reason;
mod stage;

use core::fmt::{self, Display, Formatter};

use path_timing::{AxisLimits, Curve, Path, Span};

use crate::settings_error::SettingsError;

pub use arm::{ArmGeometry, TwoLinkArm};
pub use axis::{Axis, Joint, Slide, Unit};
pub use delta::{DeltaGeometry, RotaryDelta};
pub(crate) use reason::Reason;
pub use reason::Reasoned;
pub use stage::{StageGeometry, XyStage};

/// A kind of machine with N axes whose tool has N coordinates, in mm. Axes are in radians or mm.
pub trait Kinematics<const N: usize>: Sized {
    /// What the command `machine` answers.
    const NAME: &'static str;
    /// Names of the axes, in the order of their pins.
    const AXES: [&'static str; N];
    /// The same, as what a command should have.
    const ONE_AXIS: &'static str;
    /// Whether the tool runs arcs as well.
    const HAS_ARCS: bool;
    /// Whether the axes are the coordinates of the tool.
    const IS_CARTESIAN: bool;

    /// What a person sets for the machine as a whole.
    type Geometry;
    /// What a person sets for an axis.
    type Axis: Axis;
    /// What a table is planned of.
    type Path: Path<Axes = [f64; N], Error: Reasoned>;
    /// Why a curve is no path.
    type NoPath: Display;
    /// Why the axes cannot be somewhere.
    type NoPlace: Display;

    /// The machine with the ranges of its axes, which are not empty.
    ///
    /// # Errors
    /// [`SettingsError`].
    fn new(geometry: &Self::Geometry, ranges: [[f64; 2]; N]) -> Result<Self, SettingsError>;

    /// Where the tool is, in mm.
    ///
    /// # Errors
    /// Where it is nowhere.
    fn tool_mm(&self, axes: [f64; N]) -> Result<[f64; N], Self::NoPlace>;

    /// Whether the axes may be somewhere within their ranges.
    ///
    /// # Errors
    /// Why they may not.
    fn check(&self, axes: [f64; N]) -> Result<(), Self::NoPlace> {
        let _ = axes;
        Ok(())
    }

    /// The path of the axes along a curve of the tool that begins where they are, and in how many
    /// segments a table of it is to be tried.
    ///
    /// # Errors
    /// Why there is none.
    fn path(
        &self,
        curve: Curve<N>,
        axes: [f64; N],
        limits: &[AxisLimits; N],
    ) -> Result<(Self::Path, f64), Self::NoPath>;

    /// The most by which the tool leaves the curve on a segment of a table, in mm.
    fn departure(path: &Self::Path, span: &Span<[f64; N]>) -> f64;

    /// Where the tool can go, with a comma and a space behind it, if that is not the axes' ranges.
    ///
    /// # Errors
    /// Those of `f`.
    fn fmt_reach(&self, f: &mut Formatter<'_>) -> fmt::Result;
}

/// Places between which the axes are looked at for what they turn.
const LOOKS: u32 = 4;

/// By how much the axes turn along a curve, all added up, as some places tell.
fn turned<const N: usize, E>(length: f64, at: impl Fn(f64) -> Result<[f64; N], E>) -> f64 {
    let step = length / f64::from(LOOKS);
    let places = (0..=LOOKS).filter_map(|look| at(f64::from(look) * step).ok());
    let turns = places.clone().zip(places.skip(1)).map(|(from, to)| {
        let turns = from.into_iter().zip(to).map(|(from, to)| (to - from).abs());
        turns.sum::<f64>()
    });
    turns.sum()
}
