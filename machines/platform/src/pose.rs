//! A pose as people write it.

use anyhow::{Result, anyhow, ensure};
use pose_pt::{Convention, PoseVector};

use crate::panel::PoseChange;

/// Of all pose vectors.
pub(crate) const CONVENTION: Convention = Convention::ExtrinsicXyz;

/// `x y z alpha beta gamma` in mm and degrees.
pub type Pose = [f64; 6];

/// Reads six numbers, apart by spaces or commas.
///
/// # Errors
/// Another count of numbers, or one that is not finite.
pub fn parse_pose(text: &str) -> Result<Pose> {
    let words = text.split(|c: char| c.is_whitespace() || c == ',');
    let numbers = words
        .filter(|word| !word.is_empty())
        .map(|word| {
            let number = word.parse::<f64>();
            number.map_err(|_| anyhow!("{word:?} is no number"))
        })
        .collect::<Result<Vec<_>>>()?;
    ensure!(
        numbers.iter().all(|number| number.is_finite()),
        "a number is not finite"
    );
    let count = numbers.len();
    Pose::try_from(numbers).map_err(|_| anyhow!("{count} numbers, six are needed"))
}

/// The pose vector in mm and radians.
pub(crate) fn vector([x, y, z, alpha, beta, gamma]: Pose) -> PoseVector {
    let [alpha, beta, gamma] = [alpha, beta, gamma].map(f64::to_radians);
    PoseVector::new(x, y, z, alpha, beta, gamma)
}

/// The pose with a change added.
pub(crate) fn changed(pose: Pose, change: &PoseChange) -> Pose {
    let lengths = change.translation_um.map(|um| f64::from(um) / 1e3);
    let angles = change.rotation_udeg.map(|udeg| f64::from(udeg) / 1e6);
    let mut changed = pose;
    for (value, change) in changed.iter_mut().zip(lengths.into_iter().chain(angles)) {
        *value += change;
    }
    changed
}
