//! Step pins as pictures: `_` a tick low, `-` a tick high, `|` the edge between them.

use core::fmt;

/// A row per axis: its name, and its pin from tick 0 on.
#[derive(PartialEq, Eq)]
pub struct Pulses(Vec<String>);

/// `pulses!["x __|--|__|--|", "y ____|----|"]`.
#[macro_export]
macro_rules! pulses {
    ($($row:literal),+ $(,)?) => {
        $crate::Pulses::from_rows(vec![$($row.to_string()),+])
    };
}

impl Pulses {
    /// The picture with these rows.
    #[must_use]
    pub const fn from_rows(rows: Vec<String>) -> Self {
        Self(rows)
    }

    /// The picture of edges of the axes called `names`: ticks, axis, whether the pin is high then.
    #[must_use]
    pub fn of(names: &str, edges: impl IntoIterator<Item = (u64, usize, bool)>) -> Self {
        let mut rows: Vec<_> = names.chars().map(|name| format!("{name} ")).collect();
        let mut pins = vec![(0, false); rows.len()];
        for (ticks, axis, is_high) in edges {
            let (since, was_high) = pins[axis];
            assert_ne!(is_high, was_high, "axis {axis} has the level already");
            let cell = if was_high { "-" } else { "_" };
            rows[axis] += &cell.repeat(usize::try_from(ticks - since).unwrap());
            rows[axis].push('|');
            pins[axis] = (ticks, is_high);
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
