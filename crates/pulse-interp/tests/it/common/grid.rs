//! Paths as pictures: Y up, `#` where the path has been, `+` its centre if that is elsewhere.

use core::fmt;

use pulse_interp::Move;

use super::walk::path;

/// The points of a path in the smallest rectangle that holds them, as rows from the top.
#[derive(PartialEq, Eq)]
pub(crate) struct Grid(pub(crate) Vec<String>);

/// `grid!["..#", ".#.", "#.."]`, rows from the top.
macro_rules! grid {
    ($($row:literal),+ $(,)?) => {
        $crate::common::grid::Grid(vec![$($row.to_string()),+])
    };
}
pub(crate) use grid;

impl Grid {
    /// The picture of `moves` from `start`, both in steps from (0, 0).
    pub(crate) fn of(start: [i32; 2], moves: impl IntoIterator<Item = Move>) -> Self {
        let path = path(start, moves);
        let range = |axis: usize| {
            let along = || path.iter().map(move |at| at[axis]);
            along().min().unwrap()..=along().max().unwrap()
        };
        let cell = |at: [i32; 2]| match at {
            at if path.contains(&at) => '#',
            [0, 0] => '+',
            _ => '.',
        };
        let rows = range(1).rev();
        Self(
            rows.map(|y| range(0).map(|x| cell([x, y])).collect())
                .collect(),
        )
    }
}

/// One row a line, so that a failed `assert_eq!` shows both pictures.
impl fmt::Debug for Grid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|row| write!(f, "\n{row}"))
    }
}
