//! Curves over time: what all the pictures share.

use core::ops::Range;

use anyhow::{Result, anyhow};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
pub(crate) type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Distinct on white, also for most colour-blind people.
pub(crate) const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 90, 160),
    RGBColor(214, 96, 0),
    RGBColor(0, 130, 90),
    RGBColor(170, 50, 120),
    RGBColor(90, 90, 90),
    RGBColor(150, 110, 0),
];
pub(crate) const INK: RGBColor = RGBColor(50, 50, 50);
const GRID: RGBColor = RGBColor(225, 225, 225);
const FONT: &str = "sans-serif";

pub(crate) fn colour(index: usize) -> RGBColor {
    COLOURS.iter().cycle().nth(index).copied().unwrap_or(INK)
}

/// Errors of drawing hold borrowed things; their text does not.
pub(crate) fn failed(error: impl core::fmt::Display) -> anyhow::Error {
    anyhow!("picture: {error}")
}

/// Room around values, also around a single one.
pub(crate) fn range(values: impl Iterator<Item = f64> + Clone) -> Range<f64> {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(f64::NEG_INFINITY, f64::max);
    let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
    let room = if high > low { (high - low) * 0.08 } else { 1.0 };
    low - room..high + room
}

/// A frame with grid, ticks and the names of both axes with their units.
pub(crate) fn frame<'a, 'b>(
    area: &'a Area<'b>,
    title: &str,
    x: (&str, Range<f64>),
    y: (&str, Range<f64>),
) -> Result<Chart<'a, 'b>> {
    let (x_digits, y_digits) = (decimals(&x.1), decimals(&y.1));
    let mut chart = ChartBuilder::on(area)
        .caption(title, (FONT, 17).into_font().color(&INK))
        .margin(12)
        .margin_right(24)
        .x_label_area_size(42)
        .y_label_area_size(74)
        .build_cartesian_2d(x.1, y.1)
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc(x.0)
        .y_desc(y.0)
        .axis_desc_style((FONT, 14).into_font().color(&INK))
        .label_style((FONT, 13).into_font().color(&INK))
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .axis_style(INK)
        .x_labels(10)
        .y_labels(6)
        .x_label_formatter(&|value| label(*value, x_digits))
        .y_label_formatter(&|value| label(*value, y_digits))
        .draw()
        .map_err(failed)?;
    Ok(chart)
}

/// A line through points, with its name in the legend; without a name it is not there.
pub(crate) fn curve(
    chart: &mut Chart<'_, '_>,
    name: &str,
    style: impl Into<ShapeStyle>,
    points: impl IntoIterator<Item = (f64, f64)>,
) -> Result<()> {
    let style = style.into();
    let series = chart.draw_series(LineSeries::new(points, style));
    let series = series.map_err(failed)?;
    if !name.is_empty() {
        series
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
    }
    Ok(())
}

pub(crate) fn legend<'a, 'b: 'a>(
    chart: &mut Chart<'a, 'b>,
    position: SeriesLabelPosition,
) -> Result<()> {
    chart
        .configure_series_labels()
        .position(position)
        .background_style(WHITE.mix(0.85))
        .border_style(GRID)
        .label_font((FONT, 13).into_font().color(&INK))
        .draw()
        .map_err(failed)
}

/// A series as stairs: each value holds until the next.
pub(crate) fn stairs(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let nexts = points.iter().skip(1);
    let steps = points.iter().zip(nexts);
    let mut stairs: Vec<_> = steps
        .flat_map(|(&(t, value), &(next, _))| [(t, value), (next, value)])
        .collect();
    stairs.extend(points.last());
    stairs
}

/// Decimals that tell six labels of a range apart.
fn decimals(range: &Range<f64>) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "a logarithm")]
    let magnitude = (range.end - range.start).abs().log10().floor() as i32;
    1 - magnitude
}

fn label(value: f64, digits: i32) -> String {
    // No minus in front of a zero.
    let value = if value.abs() < 10_f64.powi(-digits - 2) {
        0.0
    } else {
        value
    };
    match digits {
        ..=0 => format!("{value:.0}"),
        1..=5 => format!("{value:.*}", usize::try_from(digits).unwrap_or_default()),
        _ => format!("{value:.1e}"),
    }
}
