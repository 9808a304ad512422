//! The programmed path, the stage's with and without corrections, switches and corrections, as an
//! SVG picture in mm.

use std::io::Write;

use anyhow::Result;
use kurbo::Point;

use crate::controller::{Errors, Run};
use crate::plan::STEPS_PER_MM;
use crate::simulation::SWITCHES;

const LEFT_MM: f64 = 16.0;
const ABOVE_MM: f64 = 24.0;
const RIGHT_MM: f64 = 6.0;
const BELOW_MM: f64 = 14.0;
/// The chart of errors over time, with its axes, and without.
const CHART_MM: f64 = 46.0;
const CHART_HEIGHT_MM: f64 = 28.0;
const CLOSED: &str = "#8c1d18";
const OPEN: &str = "#e08a00";
const CORRECTION: &str = "#1a7f37";
/// Between two numbers of an axis.
const TICK_MM: u8 = 20;

/// Writes the picture. The stage's Y goes up, the picture's down.
pub(crate) fn write(mut out: impl Write, run: &Run) -> Result<()> {
    let [[x0, x1], [y0, y1]] =
        SWITCHES.map(|ends| ends.map(|steps| f64::from(steps) / STEPS_PER_MM));
    let chart_mm = if is_lossy(run) { CHART_MM } else { 0.0 };
    let width = x1 - x0 + LEFT_MM + RIGHT_MM;
    let height = y1 - y0 + ABOVE_MM + BELOW_MM + chart_mm;
    writeln!(
        out,
        r#"<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" viewBox="{} {} {width} {height}" font-family="sans-serif" font-size="3.2">
 <rect x="{}" y="{}" width="{width}" height="{height}" fill="white"/>"#,
        x0 - LEFT_MM,
        -y1 - ABOVE_MM,
        x0 - LEFT_MM,
        -y1 - ABOVE_MM,
    )?;
    axes(&mut out, x1, y1)?;
    switches(&mut out, [x0, x1], [y0, y1])?;
    writeln!(
        out,
        r#" <g transform="scale(1,-1)" fill="none" stroke-linecap="round" stroke-linejoin="round">"#
    )?;
    let programmed: String = run.programmed.iter().map(|motion| motion.svg()).collect();
    path(&mut out, "programmed", "#bcd7f0", 1.0, &programmed)?;
    if is_lossy(run) {
        path(&mut out, "open-loop", OPEN, 0.25, &polyline(&run.open))?;
    }
    path(
        &mut out,
        "closed-loop",
        CLOSED,
        0.25,
        &polyline(&run.closed),
    )?;
    writeln!(
        out,
        r#"  <g id="corrections" stroke="{CORRECTION}" stroke-width="0.25">"#
    )?;
    for at in &run.corrections {
        writeln!(
            out,
            r#"   <circle cx="{:.2}" cy="{:.2}" r="0.9"/>"#,
            at.x, at.y
        )?;
    }
    writeln!(out, "  </g>\n </g>")?;
    legend(&mut out, run, x0, -y1 - ABOVE_MM)?;
    if is_lossy(run) {
        chart(&mut out, run, [x0, x1], -y0 + BELOW_MM + 4.0)?;
    }
    writeln!(out, "</svg>")?;
    Ok(out.flush()?)
}

fn is_lossy(run: &Run) -> bool {
    run.report.open_loop.lost_steps > 0
}

fn path(out: &mut impl Write, id: &str, colour: &str, width: f64, data: &str) -> Result<()> {
    writeln!(
        out,
        r#"  <path id="{id}" stroke="{colour}" stroke-width="{width}" d="{data}"/>"#
    )?;
    Ok(())
}

fn polyline(points: &[Point]) -> String {
    let mut data = String::new();
    for (k, at) in points.iter().enumerate() {
        let command = if k == 0 { 'M' } else { 'L' };
        data += &format!("{command}{:.2} {:.2}", at.x, at.y);
    }
    data
}

fn axes(out: &mut impl Write, x1: f64, y1: f64) -> Result<()> {
    writeln!(out, r##" <g fill="#333333" stroke="none">"##)?;
    for k in 0..u8::MAX / TICK_MM {
        let at = k * TICK_MM;
        if f64::from(at) < x1 {
            writeln!(
                out,
                r##"  <path d="M{at} 1v1.5" stroke="#333333" stroke-width="0.2"/><text x="{at}" y="6.5" text-anchor="middle">{at}</text>"##
            )?;
        }
        if f64::from(at) < y1 {
            writeln!(
                out,
                r##"  <path d="M-1 -{at}h-1.5" stroke="#333333" stroke-width="0.2"/><text x="-3.2" y="{:.1}" text-anchor="end">{at}</text>"##,
                1.1 - f64::from(at)
            )?;
        }
    }
    writeln!(
        out,
        r#"  <text x="{:.1}" y="11" text-anchor="middle">X in mm</text>
  <text transform="translate(-11.5 -{:.1}) rotate(-90)" text-anchor="middle">Y in mm</text>
 </g>"#,
        x1 / 2.0,
        y1 / 2.0
    )?;
    Ok(())
}

/// A line along each edge of travel, where the switch closes.
fn switches(out: &mut impl Write, [x0, x1]: [f64; 2], [y0, y1]: [f64; 2]) -> Result<()> {
    writeln!(
        out,
        r##" <g id="switches" fill="none" stroke="#777777" stroke-width="0.5" stroke-dasharray="2 1.2">
  <path d="M{x0} {a}V{b}M{x1} {a}V{b}M{x0} {a}H{x1}M{x0} {b}H{x1}"/>
 </g>"##,
        a = -y0,
        b = -y1,
    )?;
    Ok(())
}

/// What the colours mean: the measured paths in a row each, what explains itself in one below.
fn legend(out: &mut impl Write, run: &Run, x: f64, top: f64) -> Result<()> {
    let report = &run.report;
    let measured = |name: &str, end: f64, most: f64| {
        format!("{name}: {end:.3} mm off at the end, {most:.3} mm off the curve at most")
    };
    let (end, most) = (report.closing_error_mm, report.max_deviation_mm);
    let mut rows = vec![(CLOSED, measured("closed loop", end, most))];
    if is_lossy(run) {
        let open = &report.open_loop;
        let (end, most) = (open.closing_error_mm, open.max_deviation_mm);
        rows.push((OPEN, measured("open loop", end, most)));
    }
    let mut y = top + 5.0;
    for (colour, text) in rows {
        let line = format!(r#"stroke="{colour}" stroke-width="0.5""#);
        entry(out, [x, y], &line, &text)?;
        y += 5.0;
    }
    let wide = r##"stroke="#bcd7f0" stroke-width="1""##;
    entry(out, [x, y], wide, "programmed")?;
    let dashes = r##"stroke="#777777" stroke-width="0.5" stroke-dasharray="2 1.2""##;
    entry(out, [x + 38.0, y], dashes, "limit switches")?;
    if is_lossy(run) {
        let text = format!("{} steps corrected", report.corrected_steps);
        entry(out, [x + 76.0, y], r#"stroke="none""#, &text)?;
        writeln!(
            out,
            r#" <circle cx="{}" cy="{:.1}" r="0.9" fill="none" stroke="{CORRECTION}" stroke-width="0.25"/>"#,
            x + 80.0,
            y - 1.1
        )?;
    }
    Ok(())
}

fn entry(out: &mut impl Write, [x, y]: [f64; 2], line: &str, text: &str) -> Result<()> {
    writeln!(
        out,
        r##" <path d="M{x} {:.1}h6" fill="none" {line}/><text x="{}" y="{y:.1}" fill="#333333">{text}</text>"##,
        y - 1.1,
        x + 8.0
    )?;
    Ok(())
}

/// How far both stages are from where they were commanded to, over time.
fn chart(out: &mut impl Write, run: &Run, [x0, x1]: [f64; 2], top: f64) -> Result<()> {
    let most_mm = run.errors.iter().map(|at| at.open_mm).fold(0.0, f64::max);
    let scales_mm = [0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0];
    let scale_mm = scales_mm.into_iter().find(|scale| *scale >= most_mm);
    let scale_mm = scale_mm.unwrap_or(most_mm);
    let end_s = run.report.duration_s;
    let scales_s = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 500.0, 1000.0];
    let scale_s = scales_s.into_iter().find(|scale| scale * 8.0 >= end_s);
    let scale_s = scale_s.unwrap_or(end_s);
    let bottom = top + CHART_HEIGHT_MM;
    let across = |t_s: f64| x0 + (x1 - x0) * t_s / end_s;
    let up = |mm: f64| bottom - CHART_HEIGHT_MM * mm / scale_mm;

    writeln!(
        out,
        r##" <g id="errors" fill="none" stroke="#cccccc" stroke-width="0.2">"##
    )?;
    let mut labels = String::new();
    for share in [0.0, 0.5, 1.0] {
        let (mm, y) = (share * scale_mm, up(share * scale_mm));
        writeln!(out, r#"  <path d="M{x0} {y:.2}H{x1}"/>"#)?;
        let (x, y) = (x0 - 1.5, y + 1.1);
        labels += &format!(r#"<text x="{x}" y="{y:.2}" text-anchor="end">{mm:.3}</text>"#);
    }
    let mut t_s = 0.0;
    while t_s <= end_s {
        let (x, y) = (across(t_s), bottom + 5.5);
        writeln!(out, r#"  <path d="M{x:.2} {bottom}v1.5"/>"#)?;
        labels += &format!(r#"<text x="{x:.2}" y="{y}" text-anchor="middle">{t_s}</text>"#);
        t_s += scale_s;
    }
    type OfStage = fn(&Errors) -> f64;
    let errors: [(&str, OfStage); 2] = [(OPEN, |at| at.open_mm), (CLOSED, |at| at.closed_mm)];
    for (colour, error) in errors {
        let points = run.errors.iter();
        let points: Vec<_> = points
            .map(|at| Point::new(across(at.t_s), up(error(at))))
            .collect();
        let data = polyline(&points);
        writeln!(
            out,
            r#"  <path stroke="{colour}" stroke-width="0.3" d="{data}"/>"#
        )?;
    }
    writeln!(
        out,
        r##" </g>
 <g fill="#333333">{labels}
  <text x="{x0}" y="{:.1}">mm off the commanded position, over time in s</text>
 </g>"##,
        bottom + 10.5
    )?;
    Ok(())
}
