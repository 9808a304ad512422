//! Rows cut into parts of a time.
//!
//! Goal: rows for what has a largest time of a row, as the ticks of a timer, however slowly the
//! path is gone along. Method: parts of the same time, whose positions and velocities are those of
//! the row's cubic, so that each is the same cubic.

use crate::{Axes, Cubic, Row, TryRow};

/// Rows of which none lasts longer than a time: longer ones are cut into parts, which are the same
/// motion.
///
/// A row that would have more than 4096 parts stays as it is.
///
/// ```
/// use path_timing::{AxisLimits, Curve, Knot, ShortRows, Table};
///
/// let axis = AxisLimits { speed: 0.01, acceleration: 100.0, jerk: None }; // mm, s
/// let mut knots = [Knot::default(); 9];
/// let line = Curve::line([0.0, 0.0], [80.0, 60.0])?;
/// let table = Table::plan([line], [axis; 2], |_| 8, &mut knots)?;
/// assert!(table.rows().any(|row| row.duration_s > 1000.0));
///
/// for row in ShortRows::new(table.rows(), 59.0) {
///     let row = row?;
///     assert!(row.duration_s <= 59.0);
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct ShortRows<I, A> {
    rows: I,
    longest_s: f64,
    /// The row before the next one.
    last: Option<Row<A>>,
    /// The row that is cut.
    cut: Option<Cut<A>>,
}

/// A row of which parts are still to come.
#[derive(Debug, Clone, Copy)]
struct Cut<A> {
    from: Row<A>,
    to: Row<A>,
    /// Parts, and those handed out.
    count: u16,
    taken: u16,
}

/// Most parts of a row.
const MOST: u16 = 4096;

impl<I: Iterator<Item: TryRow<Axes = A>>, A: Axes> ShortRows<I, A> {
    /// The rows, none longer than a time above 0 in seconds.
    #[must_use]
    pub const fn new(rows: I, longest_s: f64) -> Self {
        Self {
            rows,
            longest_s,
            last: None,
            cut: None,
        }
    }

    /// The rows that are cut: to set the feed of a [`LookAhead`](crate::LookAhead) or a
    /// [`Playback`](crate::Playback), or to stop it.
    pub const fn rows_mut(&mut self) -> &mut I {
        &mut self.rows
    }

    /// The parts of a row: one where it is short, or too long.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 0 to the most parts"
    )]
    fn parts(&self, row: &Row<A>) -> u16 {
        let times = row.duration_s / self.longest_s;
        let is_cut = times > 1.0 && times < f64::from(MOST);
        if is_cut {
            (times as u16).saturating_add(1)
        } else {
            1
        }
    }
}

impl<I: Iterator<Item: TryRow<Axes = A>>, A: Axes> Iterator for ShortRows<I, A> {
    type Item = Result<Row<A>, <I::Item as TryRow>::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.cut.is_none() {
            let row = match self.rows.next()?.try_row() {
                Ok(row) => row,
                Err(error) => return Some(Err(error)),
            };
            self.cut = Some(Cut {
                from: self.last.replace(row).unwrap_or(row),
                to: row,
                count: self.parts(&row),
                taken: 0,
            });
        }
        let cut = self.cut.as_mut()?;
        cut.taken = cut.taken.saturating_add(1);
        let part = cut.part();
        if cut.taken >= cut.count {
            self.cut = None;
        }
        Some(Ok(part))
    }
}

impl<A: Axes> Cut<A> {
    /// The part taken last; that of the end ends where the row does, to the last bit.
    fn part(&self) -> Row<A> {
        let [taken, count] = [self.taken, self.count].map(f64::from);
        let mut part = self.to;
        part.duration_s /= count;
        if self.taken >= self.count {
            return part;
        }
        part.time_s -= part.duration_s * (count - taken);
        let fraction = taken / count;
        let states = (part.position.as_mut_slice().iter_mut()).zip(part.velocity.as_mut_slice());
        for ((position, velocity), cubic) in states.zip(Cubic::between(&self.from, &self.to)) {
            *position = cubic.position(fraction);
            *velocity = cubic.velocity(fraction);
        }
        part.s = self.start_s() + (self.to.s - self.start_s()) * fraction;
        part
    }

    /// The parameter of its leg at which the row begins.
    fn start_s(&self) -> f64 {
        if self.from.leg == self.to.leg {
            self.from.s
        } else {
            0.0
        }
    }
}
