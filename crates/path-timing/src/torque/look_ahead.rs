//! Streams within the torque of their motors.

use core::fmt::{self, Debug};

use super::laden::Laden;
use super::{Dynamics, TorqueLimits};
use crate::look_ahead::{Feed, Feeder, Window};
use crate::reciprocals::Reciprocals;
use crate::{Axes, AxisLimits, FeedError, Knot, Path, PlanError, Row};

/// The rows along a stream of paths that need not end, as of a [`LookAhead`](crate::LookAhead),
/// with which no motor gives more torque than it has: at any feed up to 1, while it changes, and on
/// the way to a rest at any time.
///
/// The speeds at both ends of a segment are chosen by [`TorqueLimits::utilisation`]. Where that leaves
/// less between the ends than at them, this segment alone is slower; a
/// [`TorqueTable`](super::TorqueTable) is so as a whole. It is work for a PC.
///
/// A segment that is run slower than the fastest that was found, at the same ratio of speeds, asks
/// for no more where each motor has, at each speed up to that one, what friction and gravity take
/// there. Where one only brakes against viscous friction at a speed that it could not hold, the
/// machine brakes harder than planned on the way down; where even that asks for more torque than
/// there is, the rows do: ask `utilisation` of them where that can be.
pub struct TorqueLookAhead<'w, P: Path, I, F, D: Dynamics<Axes = P::Axes>> {
    torque: TorqueLimits<D>,
    feeder: Feeder<P, I, F>,
    window: Window<'w, P::Axes>,
    limits: Reciprocals<P::Axes>,
    wanted: f64,
    /// Path speed at the row handed out last; none before the first.
    speed: Option<f64>,
    time_s: f64,
    /// The path on which the row handed out last lies.
    leg: usize,
}

impl<D: Dynamics> TorqueLimits<D> {
    /// The rows along `paths` in a window, as [`LookAhead::new`](crate::LookAhead::new) makes them,
    /// that keep the limits of the axes and the torques of the motors. Jerk is not limited: `limits`
    /// with a jerk are planned without it.
    ///
    /// ```
    /// use path_timing::{AxisLimits, Curve, Dynamics, Friction, Knot, Span, TorqueCurve};
    /// use path_timing::TorqueLimits;
    ///
    /// /// Slides of 2 kg and 5 kg, in m.
    /// struct Slides;
    /// impl Dynamics for Slides {
    ///     type Axes = [f64; 2];
    ///     fn torques(&self, _: &[f64; 2], _: &[f64; 2], acceleration: &[f64; 2]) -> [f64; 2] {
    ///         [2.0 * acceleration[0], 5.0 * acceleration[1]]
    ///     }
    ///     fn friction(&self) -> [Friction; 2] {
    ///         [Friction { viscous: 4.0, coulomb: 1.5 }; 2]
    ///     }
    ///     fn bend(&self, _: &Span<[f64; 2]>) -> [f64; 2] {
    ///         [0.0; 2] // accelerations of a cubic are straight
    ///     }
    /// }
    ///
    /// let motors = [TorqueCurve::holding(40.0, 0.2, 1.5)?; 2]; // N, m/s
    /// let load = TorqueLimits { dynamics: Slides, motors };
    /// let point = |n: u32| [f64::from(n / 2) * 0.1, f64::from(n.div_ceil(2)) * 0.1];
    /// let sides = (0..).map_while(|n| Curve::line(point(n), point(n + 1)).ok());
    /// let free = AxisLimits { speed: 1.5, acceleration: 100.0, jerk: None };
    /// let mut window = [Knot::default(); 64];
    /// let mut motion = load.look_ahead(sides, [free; 2], |_| Ok(12), &mut window)?;
    /// for row in motion.by_ref().take(200) {
    ///     let row = row?; // `row.duration_s` after the row before
    /// }
    /// motion.stop();
    /// let last = motion.last().unwrap()?; // at rest on the path
    /// # assert_eq!(last.velocity, [0.0; 2]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`PlanError::Limit`]; [`PlanError::Memory`] for a window of fewer than 4 knots.
    pub fn look_ahead<'w, P, I, F>(
        self,
        paths: impl IntoIterator<IntoIter = I>,
        limits: <D::Axes as Axes>::Of<AxisLimits>,
        segments: F,
        window: &'w mut [Knot<D::Axes>],
    ) -> Result<TorqueLookAhead<'w, P, I, F, D>, PlanError<P::Error>>
    where
        P: Path<Axes = D::Axes>,
        I: Iterator<Item = P>,
        F: FnMut(&P) -> Result<u32, PlanError<P::Error>>,
    {
        let limits = self.reached(&limits)?;
        Ok(TorqueLookAhead {
            torque: self,
            feeder: Feeder::new(paths.into_iter(), segments),
            window: Window::checked(window)?,
            limits,
            wanted: 1.0,
            speed: None,
            time_s: 0.0,
            leg: 0,
        })
    }
}

impl<P, I, F, D> TorqueLookAhead<'_, P, I, F, D>
where
    P: Path,
    I: Iterator<Item = P>,
    F: FnMut(&P) -> Result<u32, PlanError<P::Error>>,
    D: Dynamics<Axes = P::Axes>,
{
    /// Wants a feed of at most 1; 0 holds. The speed goes there as fast as the torques allow.
    ///
    /// The tool's feed and the highest speeds of axes and motors are multiplied by it; torques stay
    /// as they are.
    ///
    /// # Errors
    /// [`FeedError`]; the wanted feed stays.
    pub fn set_feed(&mut self, feed: f64) -> Result<(), FeedError> {
        self.wanted = FeedError::checked(feed, 1.0)?;
        Ok(())
    }

    /// Holds: comes to rest at a knot as soon as the torques allow. [`set_feed`](Self::set_feed) goes
    /// on.
    pub const fn stop(&mut self) {
        self.wanted = 0.0;
    }

    /// Whether the machine rests at the row handed out last.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.speed.is_none_or(|speed| speed <= 0.0)
    }

    /// Whether all paths have been run, or the machine rests before one that was refused: as
    /// [`LookAhead::is_finished`](crate::LookAhead::is_finished).
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.is_at_rest() && !self.window.goes_on() && self.feeder.is_empty()
    }

    /// The next row; `None` where the machine rests: held, or at the end of the last path for now.
    ///
    /// # Errors
    /// As [`LookAhead::next_row`](crate::LookAhead::next_row). [`PlanError::Overload`], again and
    /// again, where the machine rests before a segment that its motors have not the torque for.
    pub fn next_row(&mut self) -> Result<Option<Row<P::Axes>>, PlanError<P::Error>> {
        let pairs = Laden(&self.torque);
        let filled = if !self.feeder.is_refused() && self.window.make_room(false) {
            self.feeder
                .fill(&mut self.window, &self.limits, |from, to| {
                    self.torque.is_known(from, to)
                })
        } else {
            Ok(())
        };
        let feed = Feed {
            max: 1.0,
            wanted: self.wanted,
        };
        self.window.look_back(&pairs, &self.limits, feed);
        filled?;
        let Some(first) = self.window.first() else {
            return Ok(None);
        };
        let Some(speed) = self.speed else {
            self.speed = Some(0.0);
            return Ok(Some(first.row(0.0)));
        };
        let overload = PlanError::Overload {
            leg: self.leg.saturating_add(usize::from(first.ends_leg)),
            s: first.next_start(),
        };
        let Some(step) = self.window.step(&pairs, &self.limits, feed, speed) else {
            return Ok(None);
        };
        if !step.duration_s.is_finite() {
            return Err(overload);
        }
        self.window.advance();
        self.speed = Some(step.speed);
        self.time_s += step.duration_s;
        self.leg = self.leg.saturating_add(usize::from(step.begins_leg));
        Ok(Some(Row {
            time_s: self.time_s,
            duration_s: step.duration_s,
            leg: self.leg,
            ..step.knot.row(step.speed)
        }))
    }
}

impl<P, I, F, D> Iterator for TorqueLookAhead<'_, P, I, F, D>
where
    P: Path,
    I: Iterator<Item = P>,
    F: FnMut(&P) -> Result<u32, PlanError<P::Error>>,
    D: Dynamics<Axes = P::Axes>,
{
    type Item = Result<Row<P::Axes>, PlanError<P::Error>>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_row().transpose()
    }
}

impl<P: Path, I, F, D: Dynamics<Axes = P::Axes>> Debug for TorqueLookAhead<'_, P, I, F, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TorqueLookAhead")
            .field("paths", &self.feeder.count())
            .field("time_s", &self.time_s)
            .field("speed", &self.speed)
            .field("wanted", &self.wanted)
            .finish_non_exhaustive()
    }
}
