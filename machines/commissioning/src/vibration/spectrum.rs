//! The spectrum of readings.

use core::f64::consts::FRAC_PI_2;

use anyhow::{Context, Result};
use realfft::RealFftPlanner;

/// Amplitudes over frequency.
pub(crate) struct Spectrum {
    /// From one line to the next, in Hz.
    step_hz: f64,
    amplitudes: Vec<f64>,
    /// Lines up to this are the offset and its drift.
    first: usize,
}

/// Zeros added, so that the tallest line is near the peak.
const PADDING: usize = 4;
/// The most readings that are looked at.
const MOST: usize = 1 << 18;
/// Median over root mean square of what is distributed as noise's lines are.
const MEDIAN: f64 = 0.8326;

impl Spectrum {
    /// Of readings at rising times, taken to be even by straight lines between them. The window
    /// falls from the beginning, where a swing is largest, to the end.
    pub(crate) fn new(readings: &[[f64; 2]]) -> Result<Self> {
        let end = readings.last().context("no readings")?[0];
        let count = readings.len().min(MOST);
        let step = end / number(count - 1);
        let mut values = even(readings, step, count);
        let mean = values.iter().sum::<f64>() / number(count);
        for (place, value) in values.iter_mut().enumerate() {
            let window = (FRAC_PI_2 * number(place) / number(count)).cos().powi(2);
            *value = (*value - mean) * window;
        }
        values.resize((count * PADDING).next_power_of_two(), 0.0);
        let transform = RealFftPlanner::new().plan_fft_forward(values.len());
        let mut lines = transform.make_output_vec();
        let step_hz = (step * number(values.len())).recip();
        transform
            .process(&mut values, &mut lines)
            .context("the spectrum")?;
        Ok(Self {
            step_hz,
            // The window's mean is a half.
            amplitudes: lines
                .iter()
                .map(|line| 4.0 * line.norm() / number(count))
                .collect(),
            first: values.len() / count * 2,
        })
    }

    /// The frequency of the tallest line, if it is so many times taller than noise.
    pub(crate) fn tallest(&self, above_noise: f64) -> Option<f64> {
        let lines = self.amplitudes.get(self.first..)?;
        let mut sorted = lines.to_vec();
        sorted.sort_by(f64::total_cmp);
        let noise = sorted.get(sorted.len() / 2)? / MEDIAN;
        let all = self.lines().skip(self.first);
        let tallest = all.max_by(|a, b| a[1].total_cmp(&b[1]))?;
        (tallest[1] > above_noise * noise).then_some(tallest[0])
    }

    /// Frequencies in Hz, and amplitudes.
    pub(crate) fn lines(&self) -> impl Iterator<Item = [f64; 2]> {
        let lines = self.amplitudes.iter().enumerate();
        lines.map(|(place, amplitude)| [number(place) * self.step_hz, *amplitude])
    }
}

/// Values at even times, by straight lines between readings.
fn even(readings: &[[f64; 2]], step: f64, count: usize) -> Vec<f64> {
    let mut pairs = readings.windows(2);
    let mut pair = pairs.next();
    let value = |place| {
        let time = number(place) * step;
        while let Some([_, [end, _]]) = pair
            && *end < time
        {
            match pairs.next() {
                Some(next) => pair = Some(next),
                None => break,
            }
        }
        match pair {
            Some([[begin, from], [end, to]]) => from + (to - from) * (time - begin) / (end - begin),
            _ => 0.0,
        }
    };
    (0..count).map(value).collect()
}

#[expect(clippy::cast_precision_loss, reason = "far below 2^52")]
const fn number(count: usize) -> f64 {
    count as f64
}
