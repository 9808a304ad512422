//! The angles of the motors over time, one panel each, as an SVG picture.

use core::fmt::Write as _;

use anyhow::{Context as _, Result};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

use crate::MOTORS;
use crate::score::Score;
use crate::simulation::Run;

const WIDTH: f64 = 1000.0;
const PANEL: f64 = 96.0;
/// Room left of the panels, for names and angles.
const LEFT: f64 = 130.0;
const RIGHT: f64 = 20.0;
/// Room above the panels, for what the lines mean.
const HEAD: f64 = 40.0;
/// Room below, for the time.
const FOOT: f64 = 50.0;
/// Between the panels.
const GAP: f64 = 16.0;

const INK: &str = "#333333";
const GRID: &str = "#dddddd";
const HERE: &str = "#1b5fa8";
const THERE: &str = "#d9822b";

/// `dance.svg`: what the motors did, and what they would have done under the other law.
///
/// # Errors
/// The run has fewer motors than the score.
pub fn picture(score: &Score, run: &Run) -> Result<String> {
    let mut picture = Picture::new(score.motors().len())?;
    picture.text(8.0, HEAD / 2.0 + 4.0, "start", score.title())?;
    let (here, there) = (run.law.name(), run.law.other().name());
    picture.key(LEFT, HERE, false, &format!("as danced, law {here}"))?;
    picture.key(
        LEFT + 250.0,
        THERE,
        true,
        &format!("the same frames, law {there}"),
    )?;
    let mut top = HEAD;
    for (motor, (name, half_step_deg)) in score.motors().enumerate() {
        let series = |positions: &[[i32; MOTORS]]| -> Result<Vec<f64>> {
            let angle = |all: &[i32; MOTORS]| Some(f64::from(*all.get(motor)?) * half_step_deg);
            let angles: Option<Vec<f64>> = positions.iter().map(angle).collect();
            angles.context("more motors than latches")
        };
        picture.panel(top, name, &series(&run.positions)?, &series(&run.other)?)?;
        top += PANEL + GAP;
    }
    picture.time_axis(top - GAP, run.duration_s)?;
    picture.finish()
}

struct Picture {
    xml: Writer<Vec<u8>>,
}

impl Picture {
    fn new(panels: usize) -> Result<Self> {
        let panels = f64::from(u32::try_from(panels)?);
        let height = HEAD + panels * (PANEL + GAP) - GAP + FOOT;
        let mut xml = Writer::new_with_indent(Vec::new(), b' ', 1);
        xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        let svg = BytesStart::new("svg").with_attributes([
            ("xmlns", "http://www.w3.org/2000/svg"),
            ("width", format!("{WIDTH}").as_str()),
            ("height", &format!("{height}")),
            ("viewBox", &format!("0 0 {WIDTH} {height}")),
            ("font-family", "sans-serif"),
        ]);
        xml.write_event(Event::Start(svg))?;
        let mut picture = Self { xml };
        picture.empty(
            "rect",
            &[("width", "100%"), ("height", "100%"), ("fill", "white")],
        )?;
        Ok(picture)
    }

    /// A piece of line and what it means.
    fn key(&mut self, x: f64, colour: &str, dashed: bool, meaning: &str) -> Result<()> {
        let y = HEAD / 2.0;
        self.path(&format!("M{x} {y}h30"), colour, 1.5, dashed)?;
        self.text(x + 38.0, y + 4.0, "start", meaning)
    }

    fn panel(&mut self, top: f64, name: &str, here: &[f64], there: &[f64]) -> Result<()> {
        let both = || here.iter().chain(there).copied();
        let (low, high) = (both().fold(0.0, f64::min), both().fold(0.0, f64::max));
        // A motor that rests has a range, too.
        let high = if high - low < 1.0 { low + 1.0 } else { high };
        let y = |deg: f64| top + PANEL * (high - deg) / (high - low);
        let step = round_step((high - low) / 5.0);
        for deg in multiples(step, low, high) {
            let line = format!("M{LEFT} {:.2}H{}", y(deg), WIDTH - RIGHT);
            self.path(&line, GRID, 0.7, false)?;
            self.text(LEFT - 6.0, y(deg) + 4.0, "end", &format!("{deg}°"))?;
        }
        self.text(8.0, top + PANEL / 2.0 + 4.0, "start", name)?;
        for (angles, colour, dashed) in [(there, THERE, true), (here, HERE, false)] {
            let across = (WIDTH - LEFT - RIGHT) / f64::from(u32::try_from(angles.len() - 1)?);
            let mut line = String::new();
            for (frame, deg) in (0_u32..).zip(angles) {
                let letter = if frame == 0 { 'M' } else { 'L' };
                let x = LEFT + across * f64::from(frame);
                write!(line, "{letter}{x:.2} {:.2}", y(*deg))?;
            }
            self.path(&line, colour, 1.2, dashed)?;
        }
        let frame = format!("M{LEFT} {top}v{PANEL}H{}", WIDTH - RIGHT);
        self.path(&frame, INK, 0.8, false)
    }

    fn time_axis(&mut self, y: f64, end_s: f64) -> Result<()> {
        let across = WIDTH - LEFT - RIGHT;
        for s in multiples(round_step(end_s / 10.0), 0.0, end_s) {
            let x = LEFT + across * s / end_s;
            self.path(&format!("M{x:.2} {y}v5"), INK, 0.8, false)?;
            self.text(x, y + 18.0, "middle", &format!("{s}"))?;
        }
        self.text(LEFT + across / 2.0, y + 38.0, "middle", "time in s")
    }

    fn finish(mut self) -> Result<String> {
        self.end("svg")?;
        Ok(String::from_utf8(self.xml.into_inner())? + "\n")
    }

    fn path(&mut self, line: &str, colour: &str, width: f64, dashed: bool) -> Result<()> {
        self.empty(
            "path",
            &[
                ("d", line),
                ("fill", "none"),
                ("stroke", colour),
                ("stroke-width", &format!("{width}")),
                ("stroke-dasharray", if dashed { "4 3" } else { "none" }),
            ],
        )
    }

    fn text(&mut self, x: f64, y: f64, anchor: &str, text: &str) -> Result<()> {
        let start = BytesStart::new("text").with_attributes([
            ("x", format!("{x:.2}").as_str()),
            ("y", &format!("{y:.2}")),
            ("text-anchor", anchor),
            ("font-size", "12"),
            ("fill", INK),
        ]);
        self.xml.write_event(Event::Start(start))?;
        // XML has no place for control characters, not even escaped.
        let text = text.replace(char::is_control, " ");
        self.xml.write_event(Event::Text(BytesText::new(&text)))?;
        self.end("text")
    }

    fn empty(&mut self, name: &str, attributes: &[(&str, &str)]) -> Result<()> {
        let element = BytesStart::new(name).with_attributes(attributes.iter().copied());
        Ok(self.xml.write_event(Event::Empty(element))?)
    }

    fn end(&mut self, name: &str) -> Result<()> {
        Ok(self.xml.write_event(Event::End(BytesEnd::new(name)))?)
    }
}

/// The next of 1, 2, 5, 10, 20, ... that is not below, for a value above zero.
fn round_step(least: f64) -> f64 {
    let decade = 10_f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0];
    let step = steps.into_iter().find(|step| step * decade >= least);
    step.unwrap_or(10.0) * decade
}

/// The multiples of a step from low to high.
fn multiples(step: f64, low: f64, high: f64) -> impl Iterator<Item = f64> {
    let first = (low / step).ceil();
    (0_u32..)
        .map(move |k| (first + f64::from(k)) * step)
        .take_while(move |value| *value <= high)
        .map(|value| (value * 1e6).round() / 1e6 + 0.0)
}
