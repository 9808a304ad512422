//! Random smooth paths of two axes, as the judges in Python know them.

use core::convert::Infallible;
use core::fmt::{self, Display, Formatter};

use path_timing::{Path, PathFn, PathPoint};
use test_support::Random;

/// Each axis goes along the path at a slope, with waves on its way: amplitude, frequency in rad,
/// phase.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Waves([(f64, [[f64; 3]; 2]); 2]);

impl Waves {
    pub(crate) fn random(random: &mut Random) -> Self {
        let mut wave = |amplitude: f64, rates: [f64; 2]| {
            let rate = random.within(rates[0], rates[1]);
            let amplitude = random.within(0.0, amplitude) / rate;
            [amplitude, rate, random.within(0.0, 6.3)]
        };
        let waves = [(); 2].map(|()| [wave(1.0, [2.0, 8.0]), wave(0.7, [8.0, 20.0])]);
        Self(waves.map(|waves| (random.within(-1.0, 1.0), waves)))
    }

    pub(crate) fn path(&self) -> impl Path<Axes = [f64; 2], Error = Infallible> + Clone + use<> {
        let axes = self.0;
        PathFn::new(1.0, move |s| {
            let at = axes.map(|(slope, waves)| {
                waves
                    .iter()
                    .fold([slope * s, slope], |[q, p], [size, rate, phase]| {
                        let (sin, cos) = (rate * s + phase).sin_cos();
                        [q + size * sin, p + size * rate * cos]
                    })
            });
            let position = at.map(|[position, _]| position);
            let slope = at.map(|[_, slope]| slope);
            Ok(PathPoint { position, slope })
        })
    }
}

/// All numbers.
impl Display for Waves {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (slope, waves) in &self.0 {
            write!(f, " {slope}")?;
            for number in waves.as_flattened() {
                write!(f, " {number}")?;
            }
        }
        Ok(())
    }
}
