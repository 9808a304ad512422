//! Rows in parts that have whole numbers of ticks.
//!
//! A row has less than 2^32 ticks: 59 s at 72 MHz. Where a path is gone along slowly, its rows last
//! longer. Each part of one is the same cubic, from a time to the next:
//!
//! ```text
//! q(u) = Bézier of b0 .. b3, u = 0..=1        q'(u) = 3 ((b1 - b0) (1-u)² + 2 (b2 - b1) u (1-u)
//!                                                       + (b3 - b2) u²) / T
//! ```

use path_timing::{Cubic, Row};

use crate::StepScale;

/// Most parts of a row, some 34 hours at 72 MHz: one that lasts longer stays whole, and is refused.
const MOST: f64 = 4096.0;

/// Steps from 0 that there are numbers for.
const MOST_STEPS: f64 = 2_147_483_648.0;

/// Rows of which none has more than a duration; but what will be refused is so as a whole, before
/// anything of it moves.
pub(super) struct Parts<I, const N: usize> {
    rows: I,
    longest_s: f64,
    scales: [StepScale; N],
    /// The row handed out last, or the one that is in parts.
    last: Option<Row<[f64; N]>>,
    cut: Option<Cut<N>>,
}

/// A row of which parts are still to come.
#[derive(Clone, Copy)]
struct Cut<const N: usize> {
    from: Row<[f64; N]>,
    to: Row<[f64; N]>,
    /// Parts, and those handed out.
    count: f64,
    taken: f64,
}

impl<I, const N: usize> Parts<I, N> {
    pub(super) const fn new(rows: I, longest_s: f64, scales: [StepScale; N]) -> Self {
        Self {
            rows,
            longest_s,
            scales,
            last: None,
            cut: None,
        }
    }

    /// Whether the row ends where there are steps for.
    fn has_steps(&self, row: &Row<[f64; N]>) -> bool {
        let mut axes = row.position.iter().zip(self.scales);
        axes.all(|(position, scale)| (position * scale.steps_per_unit()).abs() < MOST_STEPS)
    }
}

impl<I: Iterator<Item = Result<Row<[f64; N]>, E>>, E, const N: usize> Iterator for Parts<I, N> {
    type Item = I::Item;

    fn next(&mut self) -> Option<I::Item> {
        if let Some(cut) = &mut self.cut {
            let part = cut.part();
            if cut.taken >= cut.count {
                self.cut = None;
            }
            return Some(Ok(part));
        }
        let row = match self.rows.next()? {
            Ok(row) => row,
            Err(error) => return Some(Err(error)),
        };
        let durations = row.duration_s / self.longest_s;
        let is_long = durations > 1.0 && durations < MOST && self.has_steps(&row);
        match self.last.replace(row) {
            Some(from) if is_long => {
                self.cut = Some(Cut {
                    from,
                    to: row,
                    count: whole_from(durations),
                    taken: 0.0,
                });
                self.next()
            }
            _ => Some(Ok(row)),
        }
    }
}

impl<const N: usize> Cut<N> {
    /// The next part; the last one ends where the row does, to the last bit.
    fn part(&mut self) -> Row<[f64; N]> {
        self.taken += 1.0;
        let duration_s = self.to.duration_s / self.count;
        if self.taken >= self.count {
            return Row {
                duration_s,
                ..self.to
            };
        }
        let u = self.taken / self.count;
        let mut cubics = Cubic::between(&self.from, &self.to);
        let states: [[f64; 2]; N] =
            core::array::from_fn(|_| cubics.next().map_or([0.0; 2], |cubic| state(&cubic, u)));
        Row {
            time_s: self.to.time_s - duration_s * (self.count - self.taken),
            duration_s,
            position: states.map(|[position, _]| position),
            velocity: states.map(|[_, velocity]| velocity),
            ..self.to
        }
    }
}

/// The next whole number above one that is not below 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "below the most parts"
)]
fn whole_from(x: f64) -> f64 {
    f64::from((x as u32).saturating_add(1))
}

/// Position and velocity at a fraction of the duration.
fn state(cubic: &Cubic, u: f64) -> [f64; 2] {
    let [b0, b1, b2, b3] = cubic.control_points();
    let rest = 1.0 - u;
    let outer = (b1 - b0) * rest * rest + (b3 - b2) * u * u;
    let velocity = 3.0 * (outer + 2.0 * (b2 - b1) * u * rest) / cubic.duration_s;
    [cubic.position(u), velocity]
}
