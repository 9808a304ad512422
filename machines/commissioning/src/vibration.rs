//! Frequency and damping of the modes in a ring-down.
//!
//! Goal: the modes in which a machine swings when a move has ended, from an accelerometer's
//! readings. Method: the tallest line of the spectrum is where a mode begins; all modes so far are
//! fitted at once,
//!
//! ```text
//! a(t) = c + Σ exp(-σ t) (p cos ωt + q sin ωt)
//! ```
//!
//! by Levenberg-Marquardt at the readings' own times, until the tallest line of what is left is
//! noise.

mod damped;
mod spectrum;

use core::f64::consts::TAU;
use core::fmt;
use core::ops::RangeBounds;

use anyhow::{Context, Result, ensure};
use path_timing::Mode;

pub(crate) use self::damped::Damped;
pub(crate) use self::spectrum::Spectrum;
use crate::columns::read_columns;

/// The most modes that are looked for.
const MOST: usize = 3;
/// The tallest line of noise, of hundreds, is some three times their root mean square.
const ABOVE_NOISE: f64 = 4.5;
/// Readings that a mode's four numbers and the noise are found from.
const FEWEST: usize = 64;

/// A mode that was found.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Found {
    /// Undamped natural frequency and damping ratio.
    pub mode: Mode,
    /// Standard deviation of the frequency, in Hz, and of the damping ratio.
    pub deviation: Mode,
    /// Acceleration with which it begins, in the log's unit.
    pub amplitude: f64,
}

impl Found {
    /// How far it swings at the beginning: the acceleration over ω², in the log's unit of length.
    #[must_use]
    pub fn swing(&self) -> f64 {
        self.amplitude / (TAU * self.mode.hz).powi(2)
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:.2} Hz ± {:.2}, damping {:.4} ± {:.4}, begins with {:.1} of acceleration",
            self.mode.hz,
            self.deviation.hz,
            self.mode.damping,
            self.deviation.damping,
            self.amplitude
        )
    }
}

/// An accelerometer's readings after a move has ended.
#[derive(Debug, Clone)]
pub struct RingDown {
    name: String,
    /// From the first reading on, in s, and acceleration.
    readings: Vec<[f64; 2]>,
}

impl RingDown {
    /// The readings of a column within a time, of a CSV file with a column `time` in s, such as
    /// `#time,accel_x,accel_y,accel_z`. The time is in the file's own seconds after its first
    /// reading; it begins where the commanded move has ended.
    ///
    /// # Errors
    /// A cell that is no number, a time that does not rise, too few readings; each with its place.
    pub fn parse(text: &str, column: &str, time_s: impl RangeBounds<f64>) -> Result<Self> {
        let rows = read_columns(text, ["time", column])?;
        let first = rows.first().map_or(0.0, |(_, [time, _])| *time);
        for pair in rows.windows(2) {
            if let [(_, [before, _]), (line, [time, _])] = pair {
                ensure!(
                    time > before,
                    "line {line}: time {time} is not after {before}"
                );
            }
        }
        let within = rows
            .into_iter()
            .map(|(_, [time, value])| [time - first, value])
            .filter(|[time, _]| time_s.contains(time));
        let mut readings: Vec<_> = within.collect();
        let count = readings.len();
        ensure!(
            count >= FEWEST,
            "{count} readings are too few: {FEWEST} at least"
        );
        let begin = readings.first().map_or(0.0, |[time, _]| *time);
        for [time, _] in &mut readings {
            *time -= begin;
        }
        Ok(Self {
            name: column.to_owned(),
            readings,
        })
    }

    /// The column that was read.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Times from the first reading in s, and accelerations.
    #[must_use]
    pub fn readings(&self) -> &[[f64; 2]] {
        &self.readings
    }

    /// The modes, the one that swings farthest first; three at most.
    ///
    /// # Errors
    /// Nothing in the readings is more than noise, or what is does not die away.
    pub fn modes(&self) -> Result<Vec<Found>> {
        let mut found = self.fitted()?.found();
        found.sort_by(|a, b| b.swing().total_cmp(&a.swing()));
        Ok(found)
    }

    /// The modes' sum.
    pub(crate) fn model(&self) -> Result<Damped> {
        Ok(self.fitted()?.model)
    }

    fn fitted(&self) -> Result<Fitted> {
        let mut fitted: Option<Fitted> = None;
        for count in 1..=MOST {
            let before = fitted.as_ref();
            let model = before
                .map(|fitted| fitted.model.clone())
                .unwrap_or_default();
            let left = model.left(&self.readings);
            let spectrum = Spectrum::new(&left)?;
            let Some(hz) = spectrum.tallest(ABOVE_NOISE) else {
                break;
            };
            let start = model.with_mode(hz, &left);
            let next = match count {
                1 => start.fit::<5>(&self.readings),
                2 => start.fit::<9>(&self.readings),
                _ => start.fit::<13>(&self.readings),
            };
            // A line that is not a mode: its fit grows, or is another's twin.
            match next.filter(Fitted::is_sound) {
                Some(next) => fitted = Some(next),
                None => break,
            }
        }
        fitted.context("nothing rings in these readings, or it does not die away")
    }
}

/// A model with the deviations of its numbers.
struct Fitted {
    model: Damped,
    deviations: Vec<f64>,
}

impl Fitted {
    /// Whether each mode is known to 5 % of its frequency, more than its own noise, and one of its
    /// own.
    fn is_sound(&self) -> bool {
        const KNOWN: f64 = 0.05;
        const LARGEST_DAMPING: f64 = 0.5;
        let apart = |found: &[Found]| {
            found.windows(2).all(|pair| match pair {
                [a, b] => b.mode.hz - a.mode.hz > 3.0 * (a.deviation.hz + b.deviation.hz),
                _ => true,
            })
        };
        let mut found = self.found();
        found.sort_by(|a, b| a.mode.hz.total_cmp(&b.mode.hz));
        found
            .iter()
            .all(|it| it.deviation.hz < KNOWN * it.mode.hz && it.mode.damping < LARGEST_DAMPING)
            && apart(&found)
    }

    /// In the order in which they were found.
    fn found(&self) -> Vec<Found> {
        let numbers = self.deviations.get(1..).unwrap_or_default();
        let all = self.model.rings.iter().zip(numbers.chunks(4));
        all.map(|(ring, deviations)| {
            let (sigma, omega) = (ring.sigma, ring.omega);
            let size = sigma.hypot(omega);
            let [d_sigma, d_omega] = match deviations {
                [sigma, omega, ..] => [*sigma, *omega],
                _ => [f64::INFINITY; 2],
            };
            Found {
                mode: Mode {
                    hz: size / TAU,
                    damping: sigma / size,
                },
                deviation: Mode {
                    hz: (sigma * d_sigma).hypot(omega * d_omega) / size / TAU,
                    damping: (omega * d_sigma).hypot(sigma * d_omega) * omega / size.powi(3),
                },
                amplitude: ring.cosine.hypot(ring.sine),
            }
        })
        .collect()
    }
}

#[cfg(test)]
mod tests;
