//! From paths to steps in one call: planned by `path-timing`, quantised, put out.

mod fewest_segments;

use core::convert::Infallible;

use path_timing::{
    AxisLimits, Knot, LookAhead, Path, PlanError, Row, ShortRows, Span, segments_within,
};
use thiserror::Error;

use self::fewest_segments::{Counted, FewestSegments};
use crate::quantiser::hz;
use crate::{
    KnotError, PvtQuantiser, PvtSteps, Rate, RowError, ScaleError, Step, StepDirTiming, StepScale,
};

/// Knots in sight, of some 170 bytes for two axes: enough to brake within as many segments.
const KNOTS: usize = 64;

/// Most ticks of a row, half of what it may have: its ends are rounded.
const MAX_TICKS: f64 = 2_147_483_648.0;

/// Why paths do not become steps. `E` is the path's own error.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum DriveError<E> {
    /// An axis has no scale; [`Drive::new`] alone says so.
    #[error("axis {axis}: {error}")]
    Scale {
        /// Index of the axis.
        axis: usize,
        /// What is wrong with its steps per unit.
        error: ScaleError,
    },
    /// The motion cannot be planned.
    #[error(transparent)]
    Plan(PlanError<E>),
    /// A row has no whole numbers of steps and ticks.
    #[error(transparent)]
    Knot(#[from] KnotError),
    /// A driver cannot take the steps of a row.
    #[error(transparent)]
    Row(#[from] RowError),
}

/// `N` stepper motors along paths, from rest to rest, as fast as their limits allow.
///
/// ```text
/// path -> LookAhead -> rows -> PvtQuantiser -> whole steps, ticks -> PvtSteps -> edges
/// ```
///
/// It plans in windows of `W` knots, which are in it: a path may be of any length, and is as fast
/// as braking within the window allows. What is not to be decided here is done by these parts one
/// by one: feed override, tables with jerk, edges on a wire.
///
/// ```
/// use path_timing::{AxisLimits, Curve};
/// use scara_kin::{Arm, ArmPath, Elbow};
/// use pvt_steps::{Drive, Rate};
///
/// let arm = Arm::new(132.0, 132.0)?; // links, mm
/// let line = arm.path(Curve::line([-80.0, 100.0], [80.0, 100.0])?, Elbow::Right)?;
/// let joint = AxisLimits { speed: 3.0, acceleration: 30.0, jerk: None }; // rad, s
/// let steps_per_rad = 32_000.0 / std::f64::consts::TAU;
/// let mut drive = Drive::new([joint; 2], [steps_per_rad; 2], Rate::from_hz(72_000_000)?)?;
/// for step in drive.along([line], 0.01, ArmPath::departure) {
///     let step = step?;
///     println!("tick {}: axis {} {:?}", step.ticks, step.axis, step.direction);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Drive<const N: usize, const W: usize = KNOTS> {
    limits: [AxisLimits; N],
    scales: [StepScale; N],
    rate: Rate,
    timing: StepDirTiming,
    window: [Knot<[f64; N]>; W],
}

impl<const N: usize> Drive<N> {
    /// Motors with limits and steps per unit of each axis, and the rate of the timer that makes
    /// their steps; drivers with the timing of a DRV8825, knots for 64 segments in sight.
    ///
    /// # Errors
    /// [`DriveError::Scale`].
    pub fn new(
        limits: [AxisLimits; N],
        steps_per_unit: [f64; N],
        rate: Rate,
    ) -> Result<Self, DriveError<Infallible>> {
        let scale = |axis, steps_per_unit| {
            StepScale::new(steps_per_unit).map_err(|error| DriveError::Scale { axis, error })
        };
        // Each is replaced, or nothing is returned.
        let mut scales = [scale(0, 1.0)?; N];
        for (axis, (slot, steps_per_unit)) in scales.iter_mut().zip(steps_per_unit).enumerate() {
            *slot = scale(axis, steps_per_unit)?;
        }
        Ok(Self {
            limits,
            scales,
            rate,
            timing: StepDirTiming::DRV8825,
            window: [Knot::default(); KNOTS],
        })
    }
}

impl<const N: usize, const W: usize> Drive<N, W> {
    /// The same with `M` knots in sight.
    #[must_use]
    pub fn with_knots<const M: usize>(self) -> Drive<N, M> {
        Drive {
            limits: self.limits,
            scales: self.scales,
            rate: self.rate,
            timing: self.timing,
            window: [Knot::default(); M],
        }
    }

    /// The same for drivers with another timing.
    #[must_use]
    pub const fn with_timing(mut self, timing: StepDirTiming) -> Self {
        self.timing = timing;
        self
    }

    /// The limits of the axes, with speeds of at most a step in the least ticks of the driver and
    /// three more: one for the rounding of each of two steps, one for that of the velocity.
    fn limits_of_drivers(&self) -> [AxisLimits; N] {
        let min_intervals = self.timing.min_intervals(self.rate);
        let least_ticks = u32::try_from(min_intervals.step_ticks).map_or(f64::INFINITY, f64::from);
        let rate_hz = hz(self.rate);
        let most_hz = rate_hz / (least_ticks + 3.0);
        let mut limits = self.limits;
        for (axis, scale) in limits.iter_mut().zip(&self.scales) {
            let most = most_hz / scale.steps_per_unit().abs();
            // Written so that what is no number stays, to be refused.
            if axis.speed > most {
                axis.speed = most;
            }
        }
        limits
    }

    /// The steps along `paths`, with ticks from 0 on: each path in as many segments as keep
    /// `departure`, a bound in the unit of `tolerance`, within it at any speeds, and in no fewer
    /// than its length, its turns and slow ends ask for, 2 to 64.
    ///
    /// The motors stand where the first path begins. No axis is faster than its driver takes steps,
    /// whatever its limit; by how much its velocity jumps at a corner, the path's
    /// [`Corner`](path_timing::Corner) says. After an error there are no steps, and the motors may
    /// be in motion: paths that are looked at whole when they are made, and go on where those before
    /// end, give none.
    ///
    /// # Errors
    /// [`DriveError`] in place of a step, the last item then.
    pub fn along<P: Path<Axes = [f64; N]>>(
        &mut self,
        paths: impl IntoIterator<Item = P>,
        tolerance: f64,
        departure: impl Fn(&P, &Span<[f64; N]>) -> f64,
    ) -> impl Iterator<Item = Result<Step, DriveError<P::Error>>> {
        let limits = self.limits_of_drivers();
        let paths = FewestSegments::new(limits, paths.into_iter());
        let segments = move |Counted { path, fewest }: &Counted<P>| {
            segments_within(path, *fewest, tolerance, &departure)
        };
        let planned = LookAhead::new(paths, limits, segments, &mut self.window);
        let (rows, refused) = match planned {
            Ok(rows) => (Some(rows), None),
            Err(error) => (None, Some(Err(error))),
        };
        let rows = refused.into_iter().chain(rows.into_iter().flatten());
        let (rate, scales, timing) = (self.rate, self.scales, self.timing);
        let rows = rows.map(move |row| {
            let row = row.map_err(DriveError::Plan)?;
            // There are numbers for the steps at its end, before any of its parts moves.
            PvtQuantiser::new(rate, scales, row.position)?;
            Ok(row)
        });
        let mut rows = ShortRows::new(rows, MAX_TICKS / hz(rate));
        let mut axes: Option<AxesAt<N>> = None;
        let mut is_over = false;
        core::iter::from_fn(move || {
            while !is_over {
                if let Some(step) = axes.as_mut().and_then(|axes| axes.steps.next()) {
                    return Some(Ok(step));
                }
                let taken = rows.next()?.and_then(|row| {
                    match &mut axes {
                        Some(axes) => axes.take(&row)?,
                        None => axes = Some(AxesAt::new(rate, scales, timing, &row)?),
                    }
                    Ok(())
                });
                if let Err(error) = taken {
                    is_over = true;
                    return Some(Err(error));
                }
            }
            None
        })
    }
}

/// Motors at the row that was taken last.
struct AxesAt<const N: usize> {
    quantiser: PvtQuantiser<N>,
    steps: PvtSteps<N>,
}

impl<const N: usize> AxesAt<N> {
    fn new(
        rate: Rate,
        scales: [StepScale; N],
        timing: StepDirTiming,
        first: &Row<[f64; N]>,
    ) -> Result<Self, KnotError> {
        let quantiser = PvtQuantiser::new(rate, scales, first.position)?;
        Ok(Self {
            steps: PvtSteps::new(quantiser.knots(), timing.min_intervals(rate)),
            // By how much velocities jump, the corners of the paths say.
            quantiser: quantiser.with_start_stop_speeds([f64::INFINITY; N]),
        })
    }

    fn take<E>(&mut self, row: &Row<[f64; N]>) -> Result<(), DriveError<E>> {
        let row = self.quantiser.row(row.time_s, row.position, row.velocity)?;
        Ok(self.steps.push(&row)?)
    }
}
