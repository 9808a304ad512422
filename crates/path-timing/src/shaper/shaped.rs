//! Rows convolved with the impulses of shapers.
//!
//! Goal: the cubics of a shaped motion, from those of the motion, row by row, in memory of the
//! caller. Method: each impulse of each axis is a tap that runs through the rows with its delay;
//! wherever one of them comes to a row, the sum has a knot, and between knots it is a cubic.

use core::fmt::{self, Debug};

use super::ring::{Ring, of_axis};
use super::tap::{AxisTaps, Tap};
use crate::number::smaller;
use crate::{Axes, Row, ShapedError, Shaper, TryRow};

/// A motion in which each axis is convolved with a [`Shaper`]: rows from rows.
///
/// ```text
/// qₛ(t) = Σ Aᵢ q(t - τᵢ)
/// ```
///
/// It is a mean of the motion at several times, on each axis: positions, speeds, accelerations and
/// the jerk of cubics stay within the limits that the motion keeps, and velocity jumps become
/// smaller, one for each impulse. Shapers of different axes are aligned, so that all axes are
/// behind by the same [`delay_s`](Self::delay_s); what the tool departs by is of the second order
/// ([`Shaper::departure`]). There is a row wherever a delayed row is.
///
/// The motion begins and ends at rest; it may be held and go on. Where the rows end for now with
/// the machine at rest, the shaped motion comes to rest [`longest_delay_s`](Self::longest_delay_s)
/// later, unless they go on before; then it hands out no row until they do. Two rows are read
/// ahead.
///
/// ```
/// use path_timing::{AxisLimits, Curve, Knot, Mode, Row, Shaped, Shaper, Table};
///
/// let line = Curve::line([0.0, 0.0], [80.0, 60.0])?;
/// let axis = AxisLimits { speed: 300.0, acceleration: 5000.0, jerk: None }; // mm, s
/// let mut knots = [Knot::default(); 41];
/// let table = Table::plan([line], [axis; 2], |_| 40, &mut knots)?;
///
/// let [x, y] = [40.0, 55.0].map(|hz| Mode { hz, damping: 0.05 });
/// let mut memory = [Row::default(); 43];
/// let mut rows = Shaped::new(table.rows(), [Shaper::zvd(x)?, Shaper::mzv(y)?], &mut memory);
/// let last = rows.by_ref().last().unwrap()?;
/// assert_eq!((last.position, last.velocity), ([80.0, 60.0], [0.0; 2]));
/// let late_s = last.time_s - table.duration_s();
/// assert!((late_s - rows.longest_delay_s()).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub struct Shaped<'m, I, A: Axes> {
    rows: I,
    shapers: A::Of<Shaper>,
    ring: Ring<'m, A>,
    taps: A::Of<AxisTaps>,
    /// By how much the taps of each axis are later than its impulses.
    later_s: A,
    /// The axis whose first tap has no delay.
    leader: usize,
    /// Time of the row handed out last; none before the first.
    time_s: Option<f64>,
    is_over: bool,
}

impl<'m, I: Iterator<Item: TryRow<Axes = A>>, A: Axes> Shaped<'m, I, A> {
    /// Shapes the rows, each axis by its shaper, in memory for those within the longest delay:
    /// [`memory_for`](Self::memory_for).
    #[must_use]
    pub fn new(rows: I, shapers: A::Of<Shaper>, memory: &'m mut [Row<A>]) -> Self {
        let later_s = later_s::<A>(&shapers);
        let starts = A::each(&shapers).iter().zip(later_s.as_slice());
        let starts = starts.map(|(shaper, later_s)| first_s(shaper) + later_s);
        let leader = starts.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        Self {
            rows,
            shapers,
            ring: Ring::new(memory),
            taps: A::filled(AxisTaps::NONE),
            later_s,
            leader: leader.map_or(0, |(axis, _)| axis),
            time_s: None,
            is_over: false,
        }
    }

    /// The rows that are to be in memory at once, to shape a motion that is not held: those within
    /// the longest delay, and three. A hold takes one more.
    #[must_use]
    pub fn memory_for(rows: I, shapers: &A::Of<Shaper>) -> usize
    where
        I: Clone,
    {
        let longest_s = longest_delay_s::<A>(shapers, &later_s::<A>(shapers));
        let times = |rows: I| {
            let rows = rows.map_while(|row| row.try_row().ok());
            rows.map(|row| row.time_s)
        };
        let mut last = times(rows.clone()).peekable();
        // Rows from the one that the last tap runs to, up to the one that the first tap leaves.
        let (mut count, mut most) = (0_usize, 0_usize);
        for time_s in times(rows) {
            count = count.saturating_add(1);
            while last.next_if(|last_s| last_s + longest_s < time_s).is_some() {
                count = count.saturating_sub(1);
            }
            most = most.max(count);
        }
        most.saturating_add(3)
    }

    /// The rows that are shaped: to set the feed of a [`LookAhead`](crate::LookAhead) or a
    /// [`Playback`](crate::Playback), or to stop it.
    pub const fn rows_mut(&mut self) -> &mut I {
        &mut self.rows
    }

    /// By how many seconds each axis is behind: the mean of the delays, the same for all axes.
    #[must_use]
    pub fn delay_s(&self) -> f64 {
        let axes = A::each(&self.shapers).iter().zip(self.later_s.as_slice());
        axes.map(|(shaper, later_s)| shaper.delay_s() + later_s)
            .fold(0.0, f64::max)
    }

    /// Seconds by which the machine rests later than without shapers.
    #[must_use]
    pub fn longest_delay_s(&self) -> f64 {
        longest_delay_s::<A>(&self.shapers, &self.later_s)
    }

    /// Takes rows until the first tap knows the row after the one that it runs to, or there are
    /// none for now. The first row, if it came just now.
    fn fill(&mut self) -> Result<Option<Row<A>>, ShapedError<Error<I>>> {
        let mut first = None;
        while !self.leader().is_some_and(Tap::knows_next) {
            if self.behind().saturating_add(3) > self.ring.len() {
                self.is_over = true;
                let available = self.ring.len();
                return Err(ShapedError::Memory { available });
            }
            let Some(row) = self.rows.next() else {
                break;
            };
            let row = row.try_row().map_err(ShapedError::Rows)?;
            if self.time_s.is_some() {
                self.push(row);
            } else {
                first = Some(self.begin(row));
            }
        }
        Ok(first)
    }

    fn leader(&self) -> Option<&Tap> {
        let axis = A::each(&self.taps).get(self.leader);
        axis.and_then(|axis| axis.taps().first())
    }

    fn behind(&self) -> usize {
        let axes = A::each(&self.taps).iter();
        axes.map(AxisTaps::behind).max().unwrap_or(0)
    }

    /// The first row, at rest.
    fn begin(&mut self, row: Row<A>) -> Row<A> {
        let row = Row {
            duration_s: 0.0,
            velocity: A::zeros(),
            ..row
        };
        self.ring.push(row);
        let shapers = A::each(&self.shapers).iter();
        let numbers = self.later_s.as_slice().iter().zip(row.position.as_slice());
        let axes = A::each_mut(&mut self.taps).iter_mut();
        for ((axis, shaper), (later_s, position)) in axes.zip(shapers).zip(numbers) {
            *axis = AxisTaps::new(shaper, *later_s, *position);
        }
        self.time_s = Some(row.time_s);
        row
    }

    /// A row more. Where the machine has rested for want of rows, the rest is put in before it.
    fn push(&mut self, row: Row<A>) {
        let idle_s = self.leader().map_or(0.0, Tap::idle_s);
        if let (true, Some(newest)) = (idle_s > 0.0, self.ring.row(0)) {
            let rest = Row {
                duration_s: idle_s,
                velocity: A::zeros(),
                ..*newest
            };
            self.append(rest);
        }
        self.append(row);
    }

    fn append(&mut self, row: Row<A>) {
        let Some(before) = self.ring.row(0).copied() else {
            return;
        };
        self.ring.push(row);
        for (number, axis) in A::each_mut(&mut self.taps).iter_mut().enumerate() {
            let ends = [&before, &row].map(|row| of_axis(row, number));
            axis.push(ends, row.duration_s);
        }
    }

    /// Goes on to the next knot; none where all taps rest, or the first one waits for a row.
    fn step(&mut self) -> Option<Row<A>> {
        let time_s = self.time_s?;
        let axes = A::each(&self.taps).iter();
        let step_s = axes.map(AxisTaps::next_s).fold(f64::INFINITY, smaller);
        let leader = self.leader()?;
        let waits = !leader.knows_next() && !self.ring.row(0)?.is_at_rest();
        if waits || step_s == f64::INFINITY {
            return None;
        }
        let mut shaped = Row {
            time_s: time_s + step_s,
            duration_s: step_s,
            ..*self.ring.row(leader.behind())?
        };
        let ring = &self.ring;
        let axes = A::each_mut(&mut self.taps).iter_mut().enumerate();
        let numbers = shaped.position.as_mut_slice().iter_mut();
        let numbers = numbers.zip(shaped.velocity.as_mut_slice());
        for ((number, axis), (position, velocity)) in axes.zip(numbers) {
            axis.advance(step_s, |behind| ring.of_axis(behind, number));
            [*position, *velocity] = axis.mean();
        }
        self.time_s = Some(shaped.time_s);
        Some(shaped)
    }
}

/// The error of the rows.
type Error<I> = <<I as Iterator>::Item as TryRow>::Error;

impl<I: Iterator<Item: TryRow<Axes = A>>, A: Axes> Iterator for Shaped<'_, I, A> {
    type Item = Result<Row<A>, ShapedError<Error<I>>>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        match self.fill() {
            Ok(Some(first)) => Some(Ok(first)),
            Ok(None) => self.step().map(Ok),
            Err(error) => Some(Err(error)),
        }
    }
}

impl<I, A: Axes> Debug for Shaped<'_, I, A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shaped")
            .field("shapers", &A::each(&self.shapers))
            .field("time_s", &self.time_s)
            .finish_non_exhaustive()
    }
}

fn first_s(shaper: &Shaper) -> f64 {
    shaper.impulses().first().map_or(0.0, |first| first.time_s)
}

/// By how much the impulses of each axis are to come later, so that the means of all axes agree and
/// the first of all has no delay.
fn later_s<A: Axes>(shapers: &A::Of<Shaper>) -> A {
    let shapers = A::each(shapers);
    let starts = shapers
        .iter()
        .map(|shaper| first_s(shaper) - shaper.delay_s());
    let start_s = starts.fold(f64::INFINITY, f64::min);
    let mut later_s = A::zeros();
    for (later_s, shaper) in later_s.as_mut_slice().iter_mut().zip(shapers) {
        *later_s = -shaper.delay_s() - start_s;
    }
    later_s
}

fn longest_delay_s<A: Axes>(shapers: &A::Of<Shaper>, later_s: &A) -> f64 {
    let axes = A::each(shapers).iter().zip(later_s.as_slice());
    axes.map(|(shaper, later_s)| first_s(shaper) + shaper.duration_s() + later_s)
        .fold(0.0, f64::max)
}
