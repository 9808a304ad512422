//! Moves of a body.

use pose_pt::nalgebra::Isometry3;
use pose_pt::{Convention, Interpolation};
use proptest::prelude::*;

use super::platform::pose;

pub(crate) const ALL: [Interpolation; 4] = [
    Interpolation::Straight,
    Interpolation::Screw,
    Interpolation::Vector(Convention::ExtrinsicXyz),
    Interpolation::Vector(Convention::IntrinsicXyz),
];

pub(crate) fn from_rest(translation: [f64; 3], turn: [f64; 3]) -> [Isometry3<f64>; 2] {
    [pose([0.0; 3], [0.0; 3]), pose(translation, turn)]
}

prop_compose! {
    pub(crate) fn poses()(translation in prop::array::uniform3(-40.0..40.0), turn in prop::array::uniform3(-0.2..0.2),
        to in prop::array::uniform3(-40.0..40.0), to_turn in prop::array::uniform3(-0.2..0.2))
        -> [Isometry3<f64>; 2] {
        [pose(translation, turn), pose(to, to_turn)]
    }
}
