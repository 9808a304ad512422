//! Step pins as pictures: `_` a tick low, `-` a tick high, `|` the edge between them.

use core::fmt;

use stepper_sync::{Edge, Level};

/// A row per axis: its name, and its pin from tick 0 on.
#[derive(PartialEq, Eq)]
pub(crate) struct Pulses(pub(crate) Vec<String>);

/// `pulses!["x __|--|__|--|", "y ____|----|"]`.
macro_rules! pulses {
    ($($row:literal),+ $(,)?) => {
        $crate::common::pulses::Pulses(vec![$($row.to_string()),+])
    };
}
pub(crate) use pulses;

impl Pulses {
    /// The picture of the `edges` of the axes called `names`.
    pub(crate) fn of(names: &str, edges: impl IntoIterator<Item = Edge>) -> Self {
        let mut rows: Vec<_> = names.chars().map(|name| format!("{name} ")).collect();
        let mut pins = vec![(0, Level::Low); rows.len()];
        for Edge {
            axis, ticks, level, ..
        } in edges
        {
            let (since, before) = pins[axis];
            assert_ne!(level, before, "axis {axis} has the level already");
            let cell = if before == Level::Low { "_" } else { "-" };
            rows[axis] += &cell.repeat(usize::try_from(ticks - since).unwrap());
            rows[axis].push('|');
            pins[axis] = (ticks, level);
        }
        Self(rows)
    }
}

/// One row a line, so that a failed `assert_eq!` shows both pictures.
impl fmt::Debug for Pulses {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|row| write!(f, "\n{row}"))
    }
}
