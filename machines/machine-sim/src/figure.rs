//! Figures as SVG: charts and maps in one look.

mod axis;
mod draw;
mod frame;
mod look;
mod path;
mod plot;

use core::fmt;

pub use self::axis::Axis;
pub use self::look::{Colour, Mark, Stroke};
pub use self::plot::{Plot, Point};

/// Rows of plots under a title. Displayed, it is an SVG document, 960 px wide.
///
/// Axes have names with units, legends are outside of the data, the same kind of line has the same
/// stroke in every figure.
///
/// # Examples
/// ```
/// use machine_sim::{Axis, Figure, Plot, Stroke};
///
/// let speed = [[0.0, 0.0], [0.5, 20.0], [2.0, 20.0], [2.5, 0.0]];
/// let chart = Plot::chart(Axis::new("time in s"), Axis::new("speed in mm/s").including(0.0))
///     .line("tool", Stroke::ACTUAL, speed)
///     .line("limit", Stroke::LIMIT, [[0.0, 25.0], [2.5, 25.0]]);
/// let svg = Figure::new("A move").with_row([chart]).to_string();
/// assert!(svg.starts_with("<svg") && svg.contains("speed in mm/s"));
/// ```
#[derive(Debug, Clone)]
pub struct Figure {
    title: String,
    notes: Vec<String>,
    rows: Vec<Vec<Plot>>,
}

impl Figure {
    /// A figure under a title.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            notes: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// The same with a line of text below the title.
    #[must_use]
    pub fn with_note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// The same with plots side by side, below those before.
    #[must_use]
    pub fn with_row(mut self, plots: impl IntoIterator<Item = Plot>) -> Self {
        self.rows.push(plots.into_iter().collect());
        self
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{}",
            draw::document(&self.title, &self.notes, &self.rows)
        )
    }
}
