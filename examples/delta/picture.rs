//! Top and side view: the workspace, the platform's path, the mechanism where it ended.

use std::io::Write;

use anyhow::Result;
use nalgebra::{Point3, Vector3};

use crate::machine::Machine;
use crate::simulation::Outcome;

const GAP_MM: f64 = 48.0;
/// Points of an outline.
const OUTLINE: u32 = 240;

const WORKSPACE: &str = "#e8f0fa";
const EDGE: &str = "#9dbbe0";
const TICKED: &str = "#d99a2b";
const TRAINS: &str = "#8c1d18";
const ARMS: &str = "#444444";

/// A view: which coordinates go right and up, and where its window is in the picture.
struct View {
    title: &'static str,
    axes: [Vector3<f64>; 2],
    names: [&'static str; 2],
    low: [f64; 2],
    high: [f64; 2],
    /// Left and top of the window.
    at: [f64; 2],
}

impl View {
    fn place(&self, point: &Point3<f64>) -> (f64, f64) {
        let [right, up] = self.axes.map(|axis| axis.dot(&point.coords));
        (
            self.at[0] + right - self.low[0],
            self.at[1] + self.high[1] - up,
        )
    }

    fn path<'p>(&self, points: impl IntoIterator<Item = &'p Point3<f64>>) -> String {
        let mut path = String::new();
        for point in points {
            let (x, y) = self.place(point);
            let letter = if path.is_empty() { 'M' } else { 'L' };
            path.push_str(&format!("{letter}{x:.2} {y:.2}"));
        }
        path
    }

    fn width(&self) -> f64 {
        self.high[0] - self.low[0]
    }

    fn height(&self) -> f64 {
        self.high[1] - self.low[1]
    }
}

pub(crate) fn write(
    mut out: impl Write,
    machine: &Machine,
    trains: &Outcome,
    ticked: &Outcome,
) -> Result<()> {
    let middle = machine.point([0; 3])?.z;
    let lowest = trains.way.iter().fold(middle, |z, point| z.min(point.z));
    let workspace = machine.delta.workspace();
    let centre = f64::midpoint(middle, lowest);
    let flat: Vec<_> = workspace.horizontal_slice(centre, OUTLINE)?.collect();
    let upright: Vec<_> = workspace.vertical_slice(0.0, centre, OUTLINE)?.collect();

    let mechanism = mechanism(machine, trains)?;
    let everything = || {
        flat.iter()
            .chain(&upright)
            .chain(&trains.way)
            .chain(mechanism.iter().flatten())
    };
    let (low, high) = everything().fold((Point3::origin(), Point3::origin()), |(low, high), p| {
        (low.inf(p), high.sup(p))
    });
    let margin = 12.0;
    let top = View {
        title: "seen from above",
        axes: [Vector3::x(), Vector3::y()],
        names: ["x", "y"],
        low: [low.x - margin, low.y - margin],
        high: [high.x + margin, high.y + margin],
        at: [GAP_MM, 24.0],
    };
    let side = View {
        title: "seen from the front",
        axes: [Vector3::x(), Vector3::z()],
        names: ["x", "z"],
        low: [low.x - margin, low.z - margin],
        high: [high.x + margin, high.z + margin],
        at: [GAP_MM * 2.0 + top.width(), 24.0],
    };
    let width = side.at[0] + side.width() + 16.0;
    let height = 24.0 + top.height().max(side.height()) + 58.0;
    writeln!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.1}mm\" height=\"{height:.1}mm\" viewBox=\"0 0 {width:.1} {height:.1}\" font-family=\"sans-serif\" font-size=\"9\">\n<rect width=\"{width:.1}\" height=\"{height:.1}\" fill=\"white\"/>"
    )?;
    for (view, outline) in [(&top, &flat), (&side, &upright)] {
        frame(&mut out, view)?;
        stroke(
            &mut out,
            &format!("{}Z", view.path(outline)),
            WORKSPACE,
            EDGE,
            0.6,
        )?;
        grid(&mut out, view)?;
        for part in &mechanism {
            stroke(&mut out, &view.path(part), "none", ARMS, 1.4)?;
        }
        stroke(&mut out, &view.path(&ticked.way), "none", TICKED, 0.7)?;
        stroke(&mut out, &view.path(&trains.way), "none", TRAINS, 0.9)?;
    }
    let z = format!("workspace: at z = {centre:.0} mm, and at y = 0");
    legend(
        &mut out,
        height - 12.0,
        [
            (EDGE, z.as_str()),
            (ARMS, "mechanism at the end"),
            (TRAINS, "path, trains"),
            (TICKED, "path, control tick"),
        ],
    )?;
    writeln!(out, "</svg>")?;
    Ok(out.flush()?)
}

/// Base, arms and platform where the steps ended.
fn mechanism(machine: &Machine, outcome: &Outcome) -> Result<Vec<Vec<Point3<f64>>>> {
    let pose = machine.delta.pose_of(machine.angles(outcome.end))?;
    let platform = pose.point();
    let (mut hips, mut wrists, mut arms) = (Vec::new(), Vec::new(), Vec::new());
    for (geometry, knee) in machine.delta.arms().iter().zip(pose.knees()) {
        let (sin, cos) = geometry.azimuth.sin_cos();
        let outward = Vector3::new(cos, sin, 0.0);
        let hip = Point3::from(outward * geometry.base);
        let wrist = platform + outward * geometry.platform;
        hips.push(hip);
        wrists.push(wrist);
        arms.push(vec![hip, *knee, wrist]);
    }
    for ring in [&mut hips, &mut wrists] {
        let first = ring.first().copied();
        ring.extend(first);
    }
    arms.push(hips);
    arms.push(wrists);
    Ok(arms)
}

fn stroke(out: &mut impl Write, path: &str, fill: &str, colour: &str, width: f64) -> Result<()> {
    Ok(writeln!(
        out,
        "<path d=\"{path}\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"/>"
    )?)
}

fn frame(out: &mut impl Write, view: &View) -> Result<()> {
    let [x, y] = view.at;
    let (width, height) = (view.width(), view.height());
    writeln!(
        out,
        "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" fill=\"none\" stroke=\"#888888\" stroke-width=\"0.5\"/>"
    )?;
    text(out, x + width / 2.0, y - 8.0, "middle", view.title)
}

/// Lines every 100 mm, with their coordinates outside the frame.
fn grid(out: &mut impl Write, view: &View) -> Result<()> {
    let [left, top] = view.at;
    let (right, bottom) = (left + view.width(), top + view.height());
    let hundreds = |low: f64, high: f64| {
        (-100..=100)
            .map(|k| f64::from(k) * 100.0)
            .filter(move |mm| low <= *mm && *mm <= high)
    };
    for mm in hundreds(view.low[0], view.high[0]) {
        let x = left + mm - view.low[0];
        stroke(
            out,
            &format!("M{x:.2} {top:.2}V{bottom:.2}"),
            "none",
            "#dddddd",
            0.3,
        )?;
        text(out, x, bottom + 11.0, "middle", &format!("{mm}"))?;
    }
    for mm in hundreds(view.low[1], view.high[1]) {
        let y = top + view.high[1] - mm;
        stroke(
            out,
            &format!("M{left:.2} {y:.2}H{right:.2}"),
            "none",
            "#dddddd",
            0.3,
        )?;
        text(out, left - 4.0, y + 3.0, "end", &format!("{mm}"))?;
    }
    let [across, up] = view.names.map(|name| format!("{name} (mm)"));
    text(
        out,
        f64::midpoint(left, right),
        bottom + 23.0,
        "middle",
        &across,
    )?;
    text(out, left - 4.0, top - 8.0, "end", &up)
}

fn text(out: &mut impl Write, x: f64, y: f64, anchor: &str, text: &str) -> Result<()> {
    Ok(writeln!(
        out,
        "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\" fill=\"#333333\">{text}</text>"
    )?)
}

fn legend(out: &mut impl Write, y: f64, entries: [(&str, &str); 4]) -> Result<()> {
    let mut x = GAP_MM;
    for (colour, words) in entries {
        stroke(
            out,
            &format!("M{x:.2} {:.2}h16", y - 3.0),
            "none",
            colour,
            2.0,
        )?;
        text(out, x + 20.0, y, "start", words)?;
        // About half the height per letter.
        x += 36.0 + 4.9 * words.chars().fold(0.0, |count, _| count + 1.0);
    }
    Ok(())
}
