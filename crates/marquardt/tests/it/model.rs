//! Curves y = f(x) of N parameters through measured points.

use marquardt::{Jacobian, LeastSquares, NotConverged, Problem};

/// f(x) and how much it grows with each parameter.
pub(crate) type Curve<const N: usize> = fn(x: f64, b: [f64; N]) -> (f64, [f64; N]);

/// What is fitted, and from where.
#[derive(Clone, Copy)]
pub(crate) struct Fit<'a, const N: usize> {
    pub(crate) curve: Curve<N>,
    pub(crate) x: &'a [f64],
    pub(crate) y: &'a [f64],
    pub(crate) start: [f64; N],
}

impl<const N: usize> Fit<'_, N> {
    /// The parameters; each is measured in what it is at the start.
    pub(crate) fn run(self) -> Result<([f64; N], LeastSquares<N>), NotConverged> {
        let span = self.y.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
        marquardt::fit(&self, span, self.start.map(f64::abs))
    }

    fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.x.iter().copied().zip(self.y.iter().copied())
    }
}

impl<const N: usize> Problem<N> for Fit<'_, N> {
    type Model = [f64; N];

    fn model(&self, changes: [f64; N]) -> Option<[f64; N]> {
        let mut b = self.start;
        for (b, change) in b.iter_mut().zip(changes) {
            *b += change;
        }
        b.iter().all(|b| b.is_finite()).then_some(b)
    }

    fn squares(&self, b: &[f64; N]) -> impl Iterator<Item = Option<f64>> {
        let square = move |(x, y)| {
            let (there, _) = (self.curve)(x, *b);
            (!there.is_nan()).then_some((y - there) * (y - there))
        };
        self.points().map(square)
    }

    fn add_rows(&self, b: &[f64; N], jacobian: &mut Jacobian<N>) -> Option<()> {
        for (x, y) in self.points() {
            let (there, slopes) = (self.curve)(x, *b);
            jacobian.add(slopes, y - there);
        }
        Some(())
    }
}
