//! SCARA: two links, a height and a wrist.

use core::ops::RangeInclusive;

use crate::machines::{Elbow, GeometryError, check_lengths};
use crate::{Axis, Machine, Number, Refusal};

/// A SCARA with z and wrist: shoulder, elbow, height, wrist. For the two links alone
/// [`scara-kin`](https://docs.rs/scara-kin) is faster.
///
/// The tool is x, y, z, and its heading as the way of a point at the radius `rim` of the wrist, so
/// that all are lengths, and a tolerance counts for that point as well:
///
/// ```text
/// k = l₁ + l₂ cos elbow   h = l₂ sin elbow   shoulder = atan2(y k - x h, x k + y h)
/// cos elbow = (x² + y² - l₁² - l₂²) / 2l₁l₂  wrist = heading / rim - shoulder - elbow
/// ```
///
/// An elbow to the right of the line from base to tool has an angle above 0, as in `scara-kin`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scara {
    links: [f64; 2],
    rim: f64,
    ranges: [[f64; 2]; 4],
}

impl Scara {
    /// From the lengths of both links and the radius at which the wrist's heading counts as a
    /// length; no axis has an end.
    ///
    /// # Errors
    /// [`GeometryError`] of a length that is not above 0.
    pub fn new(upper: f64, fore: f64, rim: f64) -> Result<Self, GeometryError> {
        check_lengths([("upper arm", upper), ("forearm", fore), ("rim", rim)])?;
        Ok(Self {
            links: [upper, fore],
            rim,
            ranges: [[f64::NEG_INFINITY, f64::INFINITY]; 4],
        })
    }

    /// With the ranges of shoulder and elbow in radians, height, and wrist in radians.
    #[must_use]
    pub fn with_ranges(mut self, ranges: [RangeInclusive<f64>; 4]) -> Self {
        self.ranges = ranges.map(|range| [*range.start(), *range.end()]);
        self
    }
}

impl Machine<4> for Scara {
    type Branch = Elbow;

    fn axes(&self) -> [Axis; 4] {
        let [shoulder, elbow, height, wrist] = self.ranges.map(|[min, max]| min..=max);
        [
            Axis::angle("shoulder", shoulder),
            Axis::angle("elbow", elbow),
            Axis::linear("height", height),
            Axis::angle("wrist", wrist),
        ]
    }

    fn inverse<T: Number>(
        &self,
        [x, y, z, heading]: [T; 4],
        elbow: Elbow,
    ) -> Result<[T; 4], Refusal> {
        const REACH: &str = "the arm is too short or too long";
        let [upper, fore] = self.links;
        let square = x.squared() + y.squared();
        let (stretched, folded) = (upper + fore, upper - fore);
        let area = (T::from(stretched * stretched) - square).root(REACH)?
            * (square - folded * folded).root(REACH)?
            / 2.0;
        let along = (square - (upper * upper + fore * fore)) / 2.0;
        let area = match elbow {
            Elbow::Right => area,
            Elbow::Left => -area,
        };
        // Both times the upper arm: k and h, and cosine and sine of the elbow times both links.
        let (k, h) = (along + upper * upper, area);
        let bend = T::atan2(area, along, REACH)?;
        let shoulder = T::atan2(y * k - x * h, x * k + y * h, REACH)?;
        Ok([shoulder, bend, z, heading / self.rim - shoulder - bend])
    }
}
