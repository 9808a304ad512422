//! A sum of damped swings, and its fit.
#![expect(
    clippy::indexing_slicing,
    reason = "N = 1 + 4 K numbers in the order of `Damped::numbers`"
)]

use core::f64::consts::TAU;

use marquardt::{Jacobian, Problem, fit};

use super::Fitted;

/// An offset and swings.
#[derive(Debug, Clone, Default)]
pub(crate) struct Damped {
    offset: f64,
    pub(super) rings: Vec<Ring>,
}

/// `exp(-σ t) (cosine · cos ωt + sine · sin ωt)`
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring {
    pub(super) sigma: f64,
    pub(super) omega: f64,
    pub(super) cosine: f64,
    pub(super) sine: f64,
}

/// Damping ratios that a mode is begun with.
const FIRST_DAMPINGS: [f64; 5] = [0.003, 0.01, 0.03, 0.08, 0.2];

impl Ring {
    /// The two swings of amplitude 1 at a time.
    fn parts(&self, time: f64) -> [f64; 2] {
        let size = (-self.sigma * time).exp();
        let (sin, cos) = (self.omega * time).sin_cos();
        [size * cos, size * sin]
    }

    fn at(&self, time: f64) -> f64 {
        let [cos, sin] = self.parts(time);
        self.cosine * cos + self.sine * sin
    }

    /// With the amplitudes that fit readings best, and the square that it takes off their sum.
    fn with_amplitudes(mut self, readings: &[[f64; 2]]) -> (Self, f64) {
        let [mut cc, mut cs, mut ss, mut cy, mut sy] = [0.0; 5];
        for [time, value] in readings {
            let [cos, sin] = self.parts(*time);
            cc += cos * cos;
            cs += cos * sin;
            ss += sin * sin;
            cy += cos * value;
            sy += sin * value;
        }
        let det = (cc * ss - cs * cs).max(f64::MIN_POSITIVE);
        self.cosine = (cy * ss - sy * cs) / det;
        self.sine = (sy * cc - cy * cs) / det;
        (self, self.cosine * cy + self.sine * sy)
    }
}

impl Damped {
    pub(crate) fn at(&self, time: f64) -> f64 {
        self.offset + self.rings.iter().map(|ring| ring.at(time)).sum::<f64>()
    }

    /// Readings without it.
    pub(crate) fn left(&self, readings: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let left = readings.iter();
        left.map(|[time, value]| [*time, value - self.at(*time)])
            .collect()
    }

    /// With one more swing at about a frequency, as what is left has it.
    pub(super) fn with_mode(mut self, hz: f64, left: &[[f64; 2]]) -> Self {
        let omega = TAU * hz;
        let tried = FIRST_DAMPINGS.map(|damping| {
            let ring = Ring {
                sigma: damping * omega,
                omega,
                cosine: 0.0,
                sine: 0.0,
            };
            ring.with_amplitudes(left)
        });
        let best = tried.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
        self.rings.extend(best.map(|(ring, _)| ring));
        self
    }

    /// The best fit from here, N = 1 + 4 for each swing; none where there is none.
    pub(super) fn fit<const N: usize>(&self, readings: &[[f64; 2]]) -> Option<Fitted> {
        let largest = readings.iter().map(|[_, value]| value.abs());
        let span = largest.fold(f64::MIN_POSITIVE, f64::max);
        let rate = readings.last().map_or(1.0, |[time, _]| time.recip());
        let units = core::array::from_fn(|at| match at {
            0 => span,
            _ if (at - 1) % 4 < 2 => rate,
            _ => span,
        });
        let problem = Readings {
            start: self.numbers()?,
            readings,
        };
        let (model, found) = fit::<N, _>(&problem, span, units).ok()?;
        let deviations = found.deviations().map(|it| it.unwrap_or(f64::INFINITY));
        Some(Fitted {
            model,
            deviations: deviations.to_vec(),
        })
    }

    fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        let rings = self.rings.iter();
        let numbers = rings.flat_map(|ring| [ring.sigma, ring.omega, ring.cosine, ring.sine]);
        let all: Vec<_> = core::iter::once(self.offset).chain(numbers).collect();
        all.try_into().ok()
    }

    fn of(numbers: &[f64]) -> Option<Self> {
        let (offset, rings) = numbers.split_first()?;
        let rings = rings.chunks_exact(4).map(|ring| Ring {
            sigma: ring[0],
            omega: ring[1],
            cosine: ring[2],
            sine: ring[3],
        });
        Some(Self {
            offset: *offset,
            rings: rings.collect(),
        })
    }
}

/// Readings as a function of changes of a model's numbers.
struct Readings<'a, const N: usize> {
    start: [f64; N],
    readings: &'a [[f64; 2]],
}

impl<const N: usize> Problem<N> for Readings<'_, N> {
    type Model = Damped;

    /// What grows is no model.
    fn model(&self, changes: [f64; N]) -> Option<Damped> {
        let numbers: [f64; N] = core::array::from_fn(|at| self.start[at] + changes[at]);
        let model = Damped::of(&numbers)?;
        let dies = |ring: &Ring| ring.sigma > 0.0 && ring.omega > 0.0;
        model.rings.iter().all(dies).then_some(model)
    }

    fn squares(&self, model: &Damped) -> impl Iterator<Item = Option<f64>> {
        let squares = self.readings.iter();
        squares.map(|[time, value]| Some((value - model.at(*time)).powi(2)))
    }

    fn add_rows(&self, model: &Damped, jacobian: &mut Jacobian<N>) -> Option<()> {
        for [time, value] in self.readings {
            let mut row = [0.0; N];
            row[0] = 1.0;
            for (ring, columns) in model.rings.iter().zip(row[1..].chunks_exact_mut(4)) {
                let [cos, sin] = ring.parts(*time);
                columns.copy_from_slice(&[
                    -time * (ring.cosine * cos + ring.sine * sin),
                    time * (ring.sine * cos - ring.cosine * sin),
                    cos,
                    sin,
                ]);
            }
            jacobian.add(row, value - model.at(*time));
        }
        Some(())
    }
}
