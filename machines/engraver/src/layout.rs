//! Where a drawing is engraved, and its strokes in their order.

use kurbo::BezPath;
use nalgebra::Point2;

use crate::drawing::{Drawing, flatten};
use crate::machine::Machine;
use crate::order::{Stroke, nearest_first};
use crate::placement::Placement;
use crate::plan_settings::PlanSettings;

/// A drawing on the machine.
pub(crate) struct Layout {
    pub(crate) placement: Placement,
    /// In mm, in the order of the file.
    pub(crate) outlines: Vec<BezPath>,
    /// In the order in which they are engraved; their lines are within a quarter of the tolerance
    /// of the outlines.
    pub(crate) strokes: Vec<Stroke>,
}

impl Layout {
    /// Places a drawing, and orders its strokes from where the tool starts.
    pub(crate) fn new(
        machine: &Machine,
        drawing: &Drawing,
        settings: &PlanSettings,
        start: Point2<f64>,
    ) -> Self {
        let placement = settings.placement;
        let placement = placement.unwrap_or_else(|| machine.bed.fit(drawing.bounds()));
        let outlines = drawing.placed(placement);
        let strokes = (1..).zip(&outlines).map(|(number, outline)| Stroke {
            number,
            is_reversed: false,
            points: flatten(outline, settings.tolerance.mm() / 4.0),
        });
        let strokes = strokes.collect();
        Self {
            placement,
            strokes: if settings.keep_order {
                strokes
            } else {
                nearest_first(strokes, start)
            },
            outlines,
        }
    }
}
