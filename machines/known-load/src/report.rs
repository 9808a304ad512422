//! What is said of torque and vibration, to programs and to people.

use core::fmt;

use serde::Serialize;

use crate::torque::TorqueUsed;
use crate::vibration::Vibration;

/// What the motors are asked for; displayed, a line.
#[derive(Debug, Clone, Serialize)]
pub struct TorqueReport {
    /// The largest part of its pull-out torque that is asked of any motor: a proven bound.
    part: f64,
    /// Of which.
    axis: String,
    t_s: f64,
    /// Where the tool is then.
    at_mm: Vec<f64>,
    /// The part of the pull-out torque that is planned.
    planned: f64,
}

impl TorqueReport {
    /// With the names of the axes, and where the tool is when a motor is asked for the most.
    #[must_use]
    pub fn new<const N: usize>(
        used: &TorqueUsed<N>,
        axes: [&str; N],
        at_mm: impl Into<Vec<f64>>,
    ) -> Self {
        let most = used.most;
        Self {
            part: most.part,
            axis: axes.get(most.axis).copied().unwrap_or_default().to_owned(),
            t_s: most.t_s,
            at_mm: at_mm.into(),
            planned: used.planned,
        }
    }
}

impl fmt::Display for TorqueReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (part, planned) = (100.0 * self.part, 100.0 * self.planned);
        let (axis, t_s) = (&self.axis, self.t_s);
        write!(
            f,
            "at most {part:.1} % of what the motors can turn, by {axis} at {t_s:.3} s and"
        )?;
        for mm in &self.at_mm {
            write!(f, " {mm:.1}")?;
        }
        write!(f, " mm; {planned:.1} % are planned")
    }
}

/// How a tool swings, with and without shaping; displayed, a line.
#[derive(Debug, Clone, Serialize)]
pub struct VibrationReport {
    /// What swings.
    #[serde(skip)]
    tool: String,
    hz: f64,
    #[serde(flatten)]
    swing: Swing,
    /// The same motion without a shaper.
    unshaped: Option<Swing>,
}

/// Of a simulated tool.
#[derive(Debug, Clone, Copy, Serialize)]
struct Swing {
    /// The farthest that it was off its place.
    max_off_mm: f64,
    /// How far it swings where a motion ends.
    left_mm: f64,
}

impl Swing {
    const fn of(vibration: &Vibration) -> Self {
        Self {
            max_off_mm: vibration.most_mm,
            left_mm: vibration.left_mm,
        }
    }
}

impl VibrationReport {
    /// Of a tool by its name, and of the same without a shaper.
    #[must_use]
    pub fn new(tool: &str, vibration: &Vibration, unshaped: Option<&Vibration>) -> Self {
        Self {
            tool: tool.to_owned(),
            hz: vibration.hz,
            swing: Swing::of(vibration),
            unshaped: unshaped.map(Swing::of),
        }
    }
}

impl fmt::Display for VibrationReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Swing {
            max_off_mm,
            left_mm,
        } = self.swing;
        write!(
            f,
            "{} ({:.1} Hz) is at most {max_off_mm:.4} mm off its place, and swings by {left_mm:.4} mm at \
             the end",
            self.tool, self.hz
        )?;
        if let Some(Swing {
            max_off_mm,
            left_mm,
        }) = self.unshaped
        {
            write!(f, "; without shaping {max_off_mm:.4} and {left_mm:.4} mm")?;
        }
        Ok(())
    }
}
