//! The staircase of the wheel, and the speeds it becomes.

use handwheel::WheelSampler;
use machine_sim::{Axis, Figure, Plot, Stroke};

use crate::panel::PanelSettings;
use crate::world::Jog;

/// What is seen before the first command and after the last, in seconds.
const BEFORE_S: f64 = 0.4;
const AFTER_S: f64 = 0.6;

pub(crate) fn jog(jog: &Jog, settings: &PanelSettings) -> Figure {
    // A wheel turned so little that no axis is commanded to move is shown all the same.
    let turned = jog.samples.iter().filter(|(_, counts)| *counts != 0);
    let mut times: Vec<_> = jog.commanded.iter().map(|[t, _]| *t).collect();
    if times.is_empty() {
        times.extend(turned.map(|(t, _)| *t));
    }
    let start = times.first().copied().unwrap_or_default() - BEFORE_S;
    let end = times.last().copied().unwrap_or_default() + AFTER_S;
    let time = || Axis::new("time in s").over(start..=end);
    let is_seen = |t: f64| (start..=end).contains(&t);

    // Counts of a sample belong to the time before its end.
    let sample_s = WheelSampler::PERIOD.as_secs_f64();
    let samples = jog.samples.iter().filter(|(t, _)| is_seen(*t));
    let counted = samples.map(|(t, n)| (t - sample_s, *n));
    let wheel = settings.wheel;
    let half_bin = f64::from(wheel.max()) / f64::from(2 * u32::from(wheel.bins()));
    #[expect(clippy::cast_precision_loss, reason = "at most 2^17 half bins")]
    let quantised = counted
        .clone()
        .map(|(t, n)| [t, wheel.level(n) as f64 * half_bin]);
    let counted = counted.map(|(t, n)| [t, f64::from(n)]);
    let counts = Plot::chart(time(), Axis::new("counts").including(0.0))
        .with_title("Wheel: counts in 200 ms")
        .with_height(HEIGHT_PX)
        .line("counted", Stroke::COMMANDED, stairs(counted))
        .line("middle of the bin", Stroke::ACTUAL, stairs(quantised));

    let done = jog.done.iter().copied().filter(|[t, _]| is_seen(*t));
    let commanded = stairs(jog.commanded.iter().copied());
    let speeds = Plot::chart(time(), Axis::new("speed in mm/s").including(0.0))
        .with_title("Speed of the axis")
        .with_height(HEIGHT_PX)
        .line("commanded by the panel", Stroke::COMMANDED, commanded)
        .line("axis", Stroke::ACTUAL, done);
    let letter = ["X", "Y", "Z"].get(jog.axis).copied().unwrap_or_default();
    let title = format!("Jog: locator {}, axis {letter}", jog.locator + 1);
    let note = format!(
        "{} counts in 200 ms are full speed; below, all counts in one of {} bins give one speed.",
        wheel.max(),
        wheel.bins()
    );
    Figure::new(title)
        .with_note(note)
        .with_row([counts])
        .with_row([speeds])
}

const HEIGHT_PX: f64 = 240.0;

/// Each value holds until the next.
fn stairs(points: impl IntoIterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut stairs: Vec<[f64; 2]> = Vec::new();
    for [t, value] in points {
        stairs.extend(stairs.last().map(|[_, before]| [t, *before]));
        stairs.push([t, value]);
    }
    stairs
}
