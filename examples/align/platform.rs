//! The platform: from its file to checked settings.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};
use nalgebra::{Isometry3, Matrix3, Point3, Vector3};
use pose2pulse::handwheel::{self, WheelQuantiser};
use pose2pulse::pose_pt::{AxisLimits, Convention, Interpolation, Locator, Platform};
use serde::Deserialize;

use crate::run::Pose;

/// The platform file, as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    locator: Vec<LocatorSettings>,
    body: BodySettings,
    pub(crate) path: PathSettings,
    wheel: WheelSettings,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LocatorSettings {
    anchor_mm: [f64; 3],
    origin_mm: [f64; 3],
    axes: Option<[[f64; 3]; 3]>,
    min_mm: [f64; 3],
    max_mm: [f64; 3],
    speed_mm_s: [f64; 3],
    acceleration_mm_s2: [f64; 3],
    jerk_mm_s3: Option<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodySettings {
    outline_mm: Vec<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PathSettings {
    pub(crate) from: Pose,
    pub(crate) to: Pose,
    interpolation: InterpolationName,
    pub(crate) strain_mm: f64,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "snake_case")]
enum InterpolationName {
    Straight,
    Screw,
    Vector,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WheelSettings {
    full_counts: u32,
    bins: u16,
    full_jog_mm_s: f64,
}

/// Largest length and angle that the unit can set: as many digits as it shows.
const MOST_UM: u32 = 2_000_000_000;
const MOST_UDEG: u32 = 99_999_990;
/// Steps of one wheel count at x1.
pub(crate) const STEP_UM: u32 = 1;
pub(crate) const STEP_UDEG: u32 = 10;

impl Settings {
    pub(crate) fn read(file: &Path) -> Result<Self> {
        let place = || file.display().to_string();
        let text = fs::read_to_string(file).with_context(place)?;
        toml::from_str(&text)
            .map_err(|error| {
                let start = error.span().map_or(0, |span| span.start);
                let before = text.get(..start).unwrap_or_default();
                let line = before.matches('\n').count() + 1;
                anyhow!("line {line}: {}", error.message().replace('\n', ", "))
            })
            .with_context(place)
    }

    pub(crate) const fn locators(&self) -> usize {
        self.locator.len()
    }

    /// `N` must be the number of locators.
    pub(crate) fn platform<const N: usize>(&self) -> Result<Platform<N>> {
        let locators: Vec<_> = self.locator.iter().map(LocatorSettings::locator).collect();
        let locators = locators
            .try_into()
            .map_err(|_| anyhow!("the file has no {N} locators"))?;
        Ok(Platform::new(locators)?)
    }

    pub(crate) const fn convention(&self) -> Convention {
        Convention::ExtrinsicXyz
    }

    pub(crate) const fn interpolation(&self) -> Interpolation {
        match self.path.interpolation {
            InterpolationName::Straight => Interpolation::Straight,
            InterpolationName::Screw => Interpolation::Screw,
            InterpolationName::Vector => Interpolation::Vector(self.convention()),
        }
    }

    /// The body's outline in the world.
    pub(crate) fn outline(&self, pose: &Isometry3<f64>) -> Vec<Point3<f64>> {
        let outline = self.body.outline_mm.iter();
        outline.map(|point| pose * Point3::from(*point)).collect()
    }

    pub(crate) fn panel(&self) -> Result<handwheel::Settings> {
        let mut poses = self.path.from.iter().chain(&self.path.to);
        ensure!(poses.all(|it| it.is_finite()), "[path]: not finite");
        let wheel = &self.wheel;
        let speeds = self.locator.iter().flat_map(|locator| locator.speed_mm_s);
        let slowest = speeds.fold(f64::INFINITY, f64::min);
        ensure!(
            wheel.full_jog_mm_s <= slowest,
            "[wheel]: full_jog_mm_s = {} is above the rated speed of an axis, {slowest}",
            wheel.full_jog_mm_s
        );
        let um_s = wheel.full_jog_mm_s * 1000.0;
        ensure!(
            (1.0..=f64::from(i32::MAX)).contains(&um_s),
            "[wheel]: full_jog_mm_s = {} is not within 0.001..=2147483.647",
            wheel.full_jog_mm_s
        );
        let quantiser = WheelQuantiser::new(wheel.full_counts, wheel.bins).context("[wheel]")?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked"
        )]
        let full_jog_um_s = um_s.round() as u32;
        Ok(handwheel::Settings {
            full_jog_um_s,
            step_um: STEP_UM,
            step_udeg: STEP_UDEG,
            most_um: MOST_UM,
            most_udeg: MOST_UDEG,
            ..handwheel::Settings::new(quantiser)
        })
    }
}

impl LocatorSettings {
    fn locator(&self) -> Locator {
        let limits = [0, 1, 2].map(|axis: usize| {
            let of = |values: &[f64; 3]| values.get(axis).copied().unwrap_or_default();
            let limits = AxisLimits::new(
                of(&self.min_mm),
                of(&self.max_mm),
                of(&self.speed_mm_s),
                of(&self.acceleration_mm_s2),
            );
            match &self.jerk_mm_s3 {
                Some(jerk) => limits.with_jerk(of(jerk)),
                None => limits,
            }
        });
        let (anchor, origin) = (Point3::from(self.anchor_mm), Point3::from(self.origin_mm));
        let locator = Locator::new(anchor, origin, limits);
        match self.axes {
            Some(axes) => locator.with_axes(Matrix3::from_columns(&axes.map(Vector3::from))),
            None => locator,
        }
    }
}
