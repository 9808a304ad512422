//! What was found, as a figure: readings and their fit, the spectrum, what the shapers leave.

use anyhow::Result;
use machine_sim::{Axis, Figure, Plot, Stroke};
use path_timing::Mode;

use crate::vibration::Spectrum;
use crate::{Choice, Found, RingDown};

/// Shapers that are drawn.
const SHOWN: usize = 3;

/// The figure of one axis: its readings with the modes' sum, both spectra, and what the best
/// shapers leave of a swing at any frequency.
///
/// # Errors
/// Nothing rings in the readings.
pub fn picture(ring_down: &RingDown, modes: &[Found], choices: &[Choice]) -> Result<Figure> {
    let model = ring_down.model()?;
    let readings = ring_down.readings();
    let fitted = readings.iter().map(|[time, _]| [*time, model.at(*time)]);
    let time = Plot::chart(Axis::new("time in s"), Axis::new("acceleration"))
        .with_title("Readings")
        .line("read", Stroke::ACTUAL, readings.iter().copied())
        .line("modes' sum", Stroke::LIMIT, fitted);

    let highest = 2.0 * modes.iter().map(|it| it.mode.hz).fold(0.0, f64::max);
    let up_to = |spectrum: Spectrum| {
        let lines = spectrum.lines().take_while(|[hz, _]| *hz <= highest);
        lines.collect::<Vec<_>>()
    };
    let mut spectrum = Plot::chart(
        Axis::new("frequency in Hz").including(0.0),
        Axis::new("amplitude").including(0.0),
    )
    .with_title("Spectrum")
    .line("read", Stroke::ACTUAL, up_to(Spectrum::new(readings)?))
    .line(
        "without the modes",
        Stroke::LIMIT,
        up_to(Spectrum::new(&model.left(readings))?),
    );
    let mut left = Plot::chart(
        Axis::new("frequency in Hz").including(0.0),
        Axis::new("left of a swing, in %")
            .including(0.0)
            .including(100.0),
    )
    .with_title("Shapers");
    for (place, choice) in choices.iter().take(SHOWN).enumerate() {
        let damping = modes.first().map_or(0.0, |it| it.mode.damping);
        let hz = (1..=400).map(|part| highest * f64::from(part) / 400.0);
        let curve = hz.map(|hz| [hz, 100.0 * choice.shaper().residual(Mode { hz, damping })]);
        left = left.line(choice.name(), Stroke::series(place), curve);
    }
    for it in modes {
        let name = format!("{:.1} Hz", it.mode.hz);
        spectrum = spectrum.label([it.mode.hz, 0.0], name.clone());
        let places = [[it.mode.hz, 0.0], [it.mode.hz, 100.0]];
        left = left
            .line("", Stroke::COMMANDED, places)
            .label([it.mode.hz, 100.0], name);
    }
    let mut figure = Figure::new(format!("Vibration of {}", ring_down.name()));
    for it in modes {
        figure = figure.with_note(it.to_string());
    }
    Ok(figure
        .with_row([time])
        .with_row([spectrum])
        .with_row([left]))
}
