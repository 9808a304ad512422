//! What rows are iterated as: each itself, or a result.

use core::convert::Infallible;

use crate::{Axes, Row};

/// A [`Row`] or a `Result` of one: what a [`Shaped`](crate::Shaped) takes, from
/// [`Rows`](crate::Rows) and [`Playback`](crate::Playback) or from [`LookAhead`](crate::LookAhead).
pub trait TryRow: sealed::Sealed {
    /// `[f64; N]` for N axes.
    type Axes: Axes;
    /// Why there is no row.
    type Error;

    /// The row.
    ///
    /// # Errors
    /// Why there is none.
    fn try_row(self) -> Result<Row<Self::Axes>, Self::Error>;
}

impl<A: Axes> TryRow for Row<A> {
    type Axes = A;
    type Error = Infallible;

    fn try_row(self) -> Result<Self, Infallible> {
        Ok(self)
    }
}

impl<A: Axes, E> TryRow for Result<Row<A>, E> {
    type Axes = A;
    type Error = E;

    fn try_row(self) -> Self {
        self
    }
}

mod sealed {
    use crate::{Axes, Row};

    #[expect(
        unnameable_types,
        reason = "there is nothing else that a row can come as"
    )]
    pub trait Sealed {}

    impl<A: Axes> Sealed for Row<A> {}
    impl<A: Axes, E> Sealed for Result<Row<A>, E> {}
}
