//! The drawing, and over it the path of the simulated tool, as an SVG picture in mm.

use core::fmt::Write as _;
use std::io::Write;

use anyhow::Result;
use kurbo::{Affine, BezPath, Rect, Shape};
use nalgebra::Point2;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

const MARGIN_MM: f64 = 6.0;
/// Room for the scale bar below the drawing.
const FOOT_MM: f64 = 9.0;
/// A path of the picture holds no more than this, so that memory does not grow.
const LONGEST_PATH: usize = 1 << 16;

/// Writes the picture as the tool moves. The machine's Y goes up, the picture's down.
pub(crate) struct Picture<W: Write> {
    xml: Writer<W>,
    path: String,
    /// Where the path is, in the picture.
    last: Point2<f64>,
    frame: Rect,
}

impl<W: Write> Picture<W> {
    pub(crate) fn new(out: W, outlines: &[BezPath]) -> Result<Self> {
        let flip = Affine::FLIP_Y;
        let bounds = outlines
            .iter()
            .map(|outline| (flip * outline).bounding_box())
            .reduce(|a, b| a.union(b))
            .unwrap_or_default()
            .inset(MARGIN_MM);
        let frame = Rect::new(bounds.x0, bounds.y0, bounds.x1, bounds.y1 + FOOT_MM);
        let mut picture = Self {
            xml: Writer::new_with_indent(out, b' ', 1),
            path: String::new(),
            last: Point2::origin(),
            frame,
        };
        picture.open()?;
        picture.group("drawing", "#bcd7f0", "0.9")?;
        for outline in outlines {
            picture.write_path(&(flip * outline).to_svg())?;
        }
        picture.end("g")?;
        picture.group("tool", "#8c1d18", "0.16")?;
        Ok(picture)
    }

    pub(crate) fn move_to(&mut self, to: Point2<f64>) -> Result<()> {
        self.flush()?;
        self.last = on_grid(to);
        self.begin()
    }

    pub(crate) fn line_to(&mut self, to: Point2<f64>) -> Result<()> {
        if self.path.len() > LONGEST_PATH {
            self.flush()?;
            self.begin()?;
        }
        // Steps of the picture's grid, so that rounding does not add up.
        let from = core::mem::replace(&mut self.last, on_grid(to));
        let way = self.last - from;
        Ok(write!(self.path, "l{:.2} {:.2}", way.x, way.y)?)
    }

    pub(crate) fn finish(mut self) -> Result<()> {
        self.flush()?;
        self.end("g")?;
        self.scale_bar()?;
        self.end("svg")?;
        self.xml.get_mut().write_all(b"\n")?;
        Ok(self.xml.get_mut().flush()?)
    }

    fn begin(&mut self) -> Result<()> {
        Ok(write!(
            self.path,
            "M{:.2} {:.2}l0 0",
            self.last.x, self.last.y
        )?)
    }

    fn flush(&mut self) -> Result<()> {
        let path = core::mem::take(&mut self.path);
        if path.is_empty() {
            return Ok(());
        }
        self.write_path(&path)
    }

    fn open(&mut self) -> Result<()> {
        let Rect { x0, y0, .. } = self.frame;
        let (width, height) = (self.frame.width(), self.frame.height());
        self.xml
            .write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        let svg = BytesStart::new("svg").with_attributes([
            ("xmlns", "http://www.w3.org/2000/svg"),
            ("width", &format!("{width:.3}mm")),
            ("height", &format!("{height:.3}mm")),
            (
                "viewBox",
                &format!("{x0:.3} {y0:.3} {width:.3} {height:.3}"),
            ),
        ]);
        self.xml.write_event(Event::Start(svg))?;
        self.empty(
            "rect",
            &[
                ("x", &format!("{x0:.3}")),
                ("y", &format!("{y0:.3}")),
                ("width", &format!("{width:.3}")),
                ("height", &format!("{height:.3}")),
                ("fill", "white"),
            ],
        )
    }

    fn group(&mut self, id: &str, colour: &str, width: &str) -> Result<()> {
        let group = BytesStart::new("g").with_attributes([
            ("id", id),
            ("fill", "none"),
            ("stroke", colour),
            ("stroke-width", width),
            ("stroke-linecap", "round"),
            ("stroke-linejoin", "round"),
        ]);
        Ok(self.xml.write_event(Event::Start(group))?)
    }

    fn write_path(&mut self, path: &str) -> Result<()> {
        self.empty("path", &[("d", path)])
    }

    /// A bar of about a fifth of the width, and what the colours mean.
    fn scale_bar(&mut self) -> Result<()> {
        let longest = self.frame.width() / 5.0;
        let length = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]
            .into_iter()
            .rfind(|length| *length <= longest)
            .unwrap_or(1.0);
        let (x, y) = (self.frame.x0 + MARGIN_MM, self.frame.y1 - 5.0);
        let bar = format!("M{x:.3} {:.3}v2h{length}v-2", y - 1.0);
        self.group("scale", "#333333", "0.3")?;
        self.write_path(&bar)?;
        self.end("g")?;
        let label = format!("{length} mm");
        self.text(x + length + 1.5, y + 1.0, "#333333", &label)?;
        let right = self.frame.x1 - MARGIN_MM;
        self.text(right - 61.0, y + 1.0, "#6f9fd0", "drawing")?;
        self.text(right - 42.0, y + 1.0, "#8c1d18", "simulated tool path")
    }

    fn text(&mut self, x: f64, y: f64, colour: &str, text: &str) -> Result<()> {
        let start = BytesStart::new("text").with_attributes([
            ("x", format!("{x:.3}").as_str()),
            ("y", &format!("{y:.3}")),
            ("font-family", "sans-serif"),
            ("font-size", "4"),
            ("fill", colour),
        ]);
        self.xml.write_event(Event::Start(start))?;
        self.xml.write_event(Event::Text(BytesText::new(text)))?;
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

/// A place in the picture, to a hundredth of a millimetre.
fn on_grid(tool: Point2<f64>) -> Point2<f64> {
    let round = |mm: f64| (mm * 100.0).round() / 100.0;
    Point2::new(round(tool.x), round(-tool.y))
}
