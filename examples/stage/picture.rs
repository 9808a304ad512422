//! The programmed path, the stage's with and without corrections, switches and corrections, as an
//! SVG picture in mm.

use std::io::Write;

use anyhow::Result;
use kurbo::Point;

use crate::controller::Run;
use crate::plan::STEPS_PER_MM;
use crate::simulation::SWITCHES;

const LEFT_MM: f64 = 16.0;
const ABOVE_MM: f64 = 24.0;
const RIGHT_MM: f64 = 6.0;
const BELOW_MM: f64 = 14.0;
/// Between two numbers of an axis.
const TICK_MM: u8 = 20;

/// Writes the picture. The stage's Y goes up, the picture's down.
pub(crate) fn write(mut out: impl Write, run: &Run) -> Result<()> {
    let [[x0, x1], [y0, y1]] =
        SWITCHES.map(|ends| ends.map(|steps| f64::from(steps) / STEPS_PER_MM));
    let (width, height) = (x1 - x0 + LEFT_MM + RIGHT_MM, y1 - y0 + ABOVE_MM + BELOW_MM);
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
    if run.report.open_loop.lost_steps > 0 {
        path(&mut out, "open-loop", "#e08a00", 0.25, &polyline(&run.open))?;
    }
    path(
        &mut out,
        "closed-loop",
        "#8c1d18",
        0.25,
        &polyline(&run.closed),
    )?;
    writeln!(
        out,
        r##"  <g id="corrections" stroke="#1a7f37" stroke-width="0.25">"##
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
    writeln!(out, "</svg>")?;
    Ok(out.flush()?)
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

fn legend(out: &mut impl Write, run: &Run, x: f64, top: f64) -> Result<()> {
    let report = &run.report;
    let open = &report.open_loop;
    let closed = format!(
        "closed loop: {:.3} mm at the end, {:.3} mm at most",
        report.closing_error_mm, report.max_deviation_mm
    );
    let corrected = format!("corrections: {} steps", report.corrected_steps);
    let mut rows = vec![
        ("#8c1d18", "0.5", "", closed),
        ("#bcd7f0", "1", "", "programmed".to_owned()),
        ("#777777", "0.5", "2 1.2", "limit switches".to_owned()),
    ];
    if open.lost_steps > 0 {
        let text = format!(
            "open loop: {:.3} mm at the end, {:.3} mm at most",
            open.closing_error_mm, open.max_deviation_mm
        );
        rows.insert(1, ("#e08a00", "0.5", "", text));
        rows.push(("#1a7f37", "0.5", "0.6 0.8", corrected));
    }
    let mut y = top + 5.0;
    let mut at = x;
    for (k, (colour, width, dashes, text)) in rows.iter().enumerate() {
        // The measured paths in a row each, what explains itself in one below.
        if k > 0 && (k == 1 || (open.lost_steps > 0 && k == 2)) {
            y += 5.0;
            at = x;
        }
        writeln!(
            out,
            r##" <path d="M{at} {:.1}h6" fill="none" stroke="{colour}" stroke-width="{width}" stroke-dasharray="{}"/><text x="{:.1}" y="{y:.1}" fill="#333333">{text}</text>"##,
            y - 1.1,
            if dashes.is_empty() { "none" } else { dashes },
            at + 8.0,
        )?;
        at += 40.0;
    }
    Ok(())
}
