//! One look for all figures: fonts, colours, strokes.

/// Dark grey, for text and frames.
pub(super) const INK: &str = "#333333";
pub(super) const GRID: &str = "#e4e4e4";
pub(super) const FONT: &str = "system-ui, Helvetica, Arial, sans-serif";

/// A colour as `#rrggbb`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colour([u8; 3]);

impl Colour {
    /// A colour from its red, green and blue.
    #[must_use]
    pub const fn rgb(red: u8, green: u8, blue: u8) -> Self {
        Self([red, green, blue])
    }

    pub(super) fn css(self) -> String {
        let [red, green, blue] = self.0;
        format!("#{red:02x}{green:02x}{blue:02x}")
    }

    /// Colours that are told apart on white, also by most colour-blind people (Okabe and Ito, 2008,
    /// darkened); they begin again after eight.
    #[must_use]
    pub fn series(index: usize) -> Self {
        const SERIES: [Colour; 8] = [
            Colour::rgb(0, 90, 160),
            Colour::rgb(200, 80, 0),
            Colour::rgb(0, 125, 90),
            Colour::rgb(165, 55, 125),
            Colour::rgb(90, 90, 90),
            Colour::rgb(150, 110, 0),
            Colour::rgb(70, 150, 210),
            Colour::rgb(120, 20, 20),
        ];
        let [first, ..] = SERIES;
        SERIES.get(index % SERIES.len()).copied().unwrap_or(first)
    }

    /// A colour for a fraction within 0..=1, from dark blue over red to orange (plasma, without its
    /// yellow, which is not seen on white).
    pub(super) fn of_scale(fraction: f64) -> Self {
        const STOPS: [[f64; 3]; 9] = [
            [13.0, 8.0, 135.0],
            [65.0, 4.0, 157.0],
            [106.0, 0.0, 168.0],
            [143.0, 13.0, 164.0],
            [177.0, 42.0, 144.0],
            [204.0, 71.0, 120.0],
            [225.0, 100.0, 98.0],
            [242.0, 132.0, 75.0],
            [252.0, 166.0, 54.0],
        ];
        let at = fraction.clamp(0.0, 1.0) * 8.0;
        let below = at.floor().min(7.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::indexing_slicing,
            reason = "0..=7 of 9 stops"
        )]
        let (low, high) = (STOPS[below as usize], STOPS[below as usize + 1]);
        let mut rgb = [0; 3];
        for ((part, low), high) in rgb.iter_mut().zip(low).zip(high) {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "between two numbers within 0..=255"
            )]
            let between = (low + (high - low) * (at - below)).round() as u8;
            *part = between;
        }
        Self(rgb)
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    pub(super) colour: Colour,
    pub(super) width_px: f64,
    pub(super) is_dashed: bool,
}

impl Stroke {
    /// What was asked for: wide and light, below everything else.
    pub const COMMANDED: Self = Self::solid(Colour::rgb(184, 213, 240), 5.0);
    /// What a machine did.
    pub const ACTUAL: Self = Self::solid(Colour::rgb(140, 29, 24), 1.4);
    /// What it would have done otherwise.
    pub const OTHER: Self = Self::solid(Colour::rgb(224, 138, 0), 1.4);
    /// A rapid move, with the tool lifted.
    pub const RAPID: Self = Self::dashed(Colour::rgb(140, 140, 140), 0.9);
    /// A limit or bound.
    pub const LIMIT: Self = Self::dashed(Colour::rgb(90, 90, 90), 1.2);
    /// The outline of a part of the machine.
    pub const MACHINE: Self = Self::solid(Colour::rgb(90, 90, 90), 1.6);

    /// A solid line.
    #[must_use]
    pub const fn solid(colour: Colour, width_px: f64) -> Self {
        Self {
            colour,
            width_px,
            is_dashed: false,
        }
    }

    /// A dashed line.
    #[must_use]
    pub const fn dashed(colour: Colour, width_px: f64) -> Self {
        Self {
            colour,
            width_px,
            is_dashed: true,
        }
    }

    /// A solid line in one of the [`Colour::series`].
    #[must_use]
    pub fn series(index: usize) -> Self {
        Self::solid(Colour::series(index), 1.4)
    }
}

/// A sign at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Mark {
    /// A filled dot.
    Dot,
    /// A ring around something.
    Ring,
    /// A ring with a dot, where a path begins.
    Start,
}
