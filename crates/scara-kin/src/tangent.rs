//! The angle of a tool that must stay tangent to the curve.

use core::fmt::{Display, Formatter};

use nalgebra::{RealField, Vector2};
use trig_kernels::{Trig, atan2};

use crate::digits::Digits;
use crate::limits::{half_turn, turned};
use crate::range::{is_angle, largest_angle};
use crate::{Arm, Joints};

/// A disc or blade on the forearm that is turned so that it stays tangent to the curve.
///
/// ```text
/// θ3 = heading - (base rotation + shoulder + elbow)
/// ```
///
/// The angle is unwrapped: from one call to the next it changes by at most half a
/// turn, so it never jumps where the heading passes ±π.
///
/// ```
/// use scara_kin::nalgebra::Vector2;
/// use scara_kin::{Arm, Joints, TangentTool};
///
/// let arm = Arm::new(132.0, 132.0)?;
/// let joints = Joints::new(0.2, 0.9);
/// let mut disc = TangentTool::new(20f64.to_radians())?;
/// let along_x = disc.follow(&arm, joints, Vector2::x())?;
/// let along_y = disc.follow(&arm, joints, Vector2::y())?;
/// assert!(along_x.corner.is_none());
/// assert!(along_y.corner.is_some()); // 90° is over the threshold: lift, turn, lower
/// assert!((along_y.tool_angle - along_x.tool_angle - 90f64.to_radians()).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentTool<T = f64> {
    corner: T,
    tool_angle: T,
    heading: Option<T>,
}

/// Where a tangent tool has to turn.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct ToolTurn<T = f64> {
    /// Angle of the tool against the forearm, in radians, unwrapped.
    pub tool_angle: T,
    /// The change of heading in -π..=π rad where it is a corner: above the threshold,
    /// so that the tool must be lifted and turned before it goes on.
    pub corner: Option<T>,
}

/// Why a tangent tool cannot be set.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TangentError<T = f64> {
    /// The corner threshold is not an angle above zero.
    Corner {
        /// The threshold given, in radians.
        corner: T,
    },
    /// The direction of the curve has no length, or is not finite.
    NoHeading {
        /// X of the direction given.
        x: T,
        /// Y of the direction given.
        y: T,
    },
    /// An angle is not a number within the range of angles: the tool's after many turns, where
    /// [`TangentTool::starting_at`] begins again.
    OutOfRange {
        /// The angle.
        name: &'static str,
        /// Its value, in radians.
        value: T,
        /// Largest angle that is accurate in `T`, in radians.
        largest: T,
    },
}

impl<T: RealField + Copy> Display for TangentError<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match *self {
            Self::Corner { corner } => write!(
                f,
                "corner threshold {} rad is not above zero",
                Digits(corner)
            ),
            Self::NoHeading { x, y } => {
                write!(f, "direction ({}, {}) has no heading", Digits(x), Digits(y))
            }
            Self::OutOfRange {
                name,
                value,
                largest,
            } => write!(
                f,
                "{name} is {} rad, not within ±{} rad",
                Digits(value),
                Digits(largest)
            ),
        }
    }
}

impl<T: RealField + Copy> core::error::Error for TangentError<T> {}

impl<T: RealField + Trig> TangentTool<T> {
    /// A tool at θ3 = 0 that counts changes of heading above `corner`, in radians, as
    /// corners. With π or more there are none.
    ///
    /// # Errors
    /// [`TangentError::Corner`] unless `corner` is above zero.
    pub fn new(corner: T) -> Result<Self, TangentError<T>> {
        if corner > T::zero() {
            Ok(Self {
                corner,
                tool_angle: T::zero(),
                heading: None,
            })
        } else {
            Err(TangentError::Corner { corner })
        }
    }

    /// The tool at the angle at which it stands now, in radians, instead of 0.
    ///
    /// # Errors
    /// [`TangentError::OutOfRange`] unless `tool_angle` is within ±1/√ε (f64: 6.7e7, f32: 2896).
    pub fn starting_at(mut self, tool_angle: T) -> Result<Self, TangentError<T>> {
        within("starting angle", tool_angle)?;
        self.tool_angle = tool_angle;
        Ok(self)
    }

    /// The tool's angle now, in radians.
    #[must_use]
    pub const fn tool_angle(&self) -> T {
        self.tool_angle
    }

    /// Begins a new stroke: the next direction is no corner, whatever it is. The angle
    /// is kept, so that the tool takes the shorter turn to the new heading.
    pub const fn lift(&mut self) {
        self.heading = None;
    }

    /// Turns the tool to the curve's `direction` at the pose `joints`.
    ///
    /// # Errors
    /// [`TangentError::NoHeading`]; [`TangentError::OutOfRange`] for a joint or for the tool
    /// after many turns. The tool then stays as it was.
    pub fn follow(
        &mut self,
        arm: &Arm<T>,
        joints: Joints<T>,
        direction: Vector2<T>,
    ) -> Result<ToolTurn<T>, TangentError<T>> {
        let (x, y) = (direction.x, direction.y);
        let is_finite = x.is_finite() && y.is_finite();
        if !is_finite || (x == T::zero() && y == T::zero()) {
            return Err(TangentError::NoHeading { x, y });
        }
        within("shoulder", joints.shoulder)?;
        within("elbow", joints.elbow)?;
        let heading = atan2(y, x);
        let change = self.heading.map(|before| half_turn(heading - before));
        let base = arm.base().rotation;
        let base = atan2(base.im, base.re);
        let wanted = heading - base - joints.shoulder - joints.elbow;
        let turns = ((self.tool_angle - wanted) / T::two_pi()).round();
        let tool_angle = turned(wanted, turns);
        within("tool angle", tool_angle)?;
        self.tool_angle = tool_angle;
        self.heading = Some(heading);
        Ok(ToolTurn {
            tool_angle,
            corner: change.filter(|change| change.abs() > self.corner),
        })
    }
}

/// Refuses by its name what is not within the range of angles.
fn within<T: RealField + Copy>(name: &'static str, value: T) -> Result<(), TangentError<T>> {
    if is_angle(value) {
        Ok(())
    } else {
        Err(TangentError::OutOfRange {
            name,
            value,
            largest: largest_angle(),
        })
    }
}
