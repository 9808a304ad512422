//! The platform file: as written, and what its numbers become.

use anyhow::{Context as _, Result, ensure};
use handwheel::WheelQuantiser;
use nalgebra::{Matrix3, Point3, Vector3};
use pose_pt::{Blend, Interpolation, Locator, LocatorAxis};
use serde::Deserialize;

use crate::panel::PanelSettings;
use crate::pose::{CONVENTION, Pose};

/// The platform file, as written.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    locator: Vec<LocatorSettings>,
    body: BodySettings,
    path: PathSettings,
    wheel: WheelSettings,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct LocatorSettings {
    anchor_mm: Numbers<3>,
    origin_mm: Numbers<3>,
    axes: Option<Exactly<Numbers<3>, 3>>,
    min_mm: Numbers<3>,
    max_mm: Numbers<3>,
    speed_mm_s: Numbers<3>,
    acceleration_mm_s2: Numbers<3>,
    jerk_mm_s3: Option<Numbers<3>>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct BodySettings {
    outline_mm: Vec<Numbers<3>>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct PathSettings {
    from: Numbers<6>,
    to: Numbers<6>,
    interpolation: InterpolationName,
    #[serde(alias = "strain_mm")]
    max_distance_error_mm: Finite,
    #[serde(default)]
    via: Vec<ViaSettings>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct ViaSettings {
    pose: Numbers<6>,
    distance_mm: Finite,
    rotation_deg: Finite,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum InterpolationName {
    Straight,
    Screw,
    Vector,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct WheelSettings {
    full_counts: u32,
    bins: u16,
    full_jog_mm_s: Finite,
}

/// A number that is one.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
struct Finite(f64);

impl TryFrom<f64> for Finite {
    type Error = String;

    fn try_from(value: f64) -> Result<Self, String> {
        let finite = value.is_finite().then_some(Self(value));
        finite.ok_or_else(|| format!("{value} is not a finite number"))
    }
}

/// N values and no more: an array of serde leaves what is after it unread.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(try_from = "Vec<T>", bound(deserialize = "T: Deserialize<'de>"))]
struct Exactly<T, const N: usize>([T; N]);

type Numbers<const N: usize> = Exactly<Finite, N>;

impl<T, const N: usize> TryFrom<Vec<T>> for Exactly<T, N> {
    type Error = String;

    fn try_from(values: Vec<T>) -> Result<Self, String> {
        let count = values.len();
        let values = values.try_into().map(Self);
        values.map_err(|_| format!("{count} values, {N} are needed"))
    }
}

impl<const N: usize> Numbers<N> {
    fn values(&self) -> [f64; N] {
        self.0.map(|Finite(value)| value)
    }
}

/// Largest length and angle that the pendant can set: as many digits as it shows.
const MAX_UM: u32 = 2_000_000_000;
const MAX_UDEG: u32 = 99_999_990;
/// Counts of full speed, at most: what the operator turns beyond them still fits a sample.
const MAX_COUNTS: u32 = 1_000_000_000;
/// Steps of one wheel count at x1.
pub(crate) const STEP_UM: u32 = 1;
pub(crate) const STEP_UDEG: u32 = 10;

impl Settings {
    /// Where the body is, and where it goes.
    pub(crate) fn poses(&self) -> [Pose; 2] {
        [self.path.from.values(), self.path.to.values()]
    }

    /// The poses between, and how near to each the body passes.
    pub(crate) fn via(&self) -> impl ExactSizeIterator<Item = (Pose, Blend)> {
        self.path.via.iter().map(|via| {
            let (Finite(distance), Finite(deg)) = (via.distance_mm, via.rotation_deg);
            let blend = Blend {
                distance,
                rotation_rad: deg.to_radians(),
            };
            (via.pose.values(), blend)
        })
    }

    /// What the distance of two locators may depart by from that of their anchors.
    pub(crate) const fn max_distance_error_mm(&self) -> f64 {
        self.path.max_distance_error_mm.0
    }

    pub(crate) fn locators(&self) -> Vec<Locator> {
        let locators = self.locator.iter();
        locators.map(LocatorSettings::locator).collect()
    }

    pub(crate) const fn interpolation(&self) -> Interpolation {
        match self.path.interpolation {
            InterpolationName::Straight => Interpolation::Straight,
            InterpolationName::Screw => Interpolation::Screw,
            InterpolationName::Vector => Interpolation::Vector(CONVENTION),
        }
    }

    /// The body's outline in its own frame.
    pub(crate) fn outline(&self) -> Vec<Point3<f64>> {
        let outline = self.body.outline_mm.iter();
        outline.map(|point| Point3::from(point.values())).collect()
    }

    pub(crate) fn panel(&self) -> Result<PanelSettings> {
        let wheel = &self.wheel;
        let Finite(full_jog_mm_s) = wheel.full_jog_mm_s;
        let speeds = self
            .locator
            .iter()
            .flat_map(|locator| locator.speed_mm_s.values());
        let slowest = speeds.fold(f64::INFINITY, f64::min);
        ensure!(
            full_jog_mm_s <= slowest,
            "[wheel]: full_jog_mm_s = {full_jog_mm_s} is above the rated speed of an axis, {slowest}"
        );
        let um_s = full_jog_mm_s * 1000.0;
        ensure!(
            (1.0..=f64::from(i32::MAX)).contains(&um_s),
            "[wheel]: full_jog_mm_s = {full_jog_mm_s} is not within 0.001..=2147483.647"
        );
        ensure!(
            wheel.full_counts <= MAX_COUNTS,
            "[wheel]: full_counts = {} is above {MAX_COUNTS}",
            wheel.full_counts
        );
        let quantiser = WheelQuantiser::new(wheel.full_counts, wheel.bins).context("[wheel]")?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked"
        )]
        let full_jog_um_s = um_s.round() as u32;
        Ok(PanelSettings {
            full_jog_um_s,
            step_um: STEP_UM,
            step_udeg: STEP_UDEG,
            max_um: MAX_UM,
            max_udeg: MAX_UDEG,
            ..PanelSettings::new(quantiser)
        })
    }
}

impl LocatorSettings {
    fn locator(&self) -> Locator {
        let limits = [0, 1, 2].map(|axis: usize| {
            let of = |numbers: &Numbers<3>| numbers.values().get(axis).copied().unwrap_or_default();
            LocatorAxis {
                min: of(&self.min_mm),
                max: of(&self.max_mm),
                speed: of(&self.speed_mm_s),
                acceleration: of(&self.acceleration_mm_s2),
                jerk: self.jerk_mm_s3.as_ref().map(of),
            }
        });
        let point = |numbers: &Numbers<3>| Point3::from(numbers.values());
        let (anchor, origin) = (point(&self.anchor_mm), point(&self.origin_mm));
        let locator = Locator::new(anchor, origin, limits);
        match self.axes {
            Some(Exactly(axes)) => {
                let columns = axes.map(|axis| Vector3::from(axis.values()));
                locator.with_axes(Matrix3::from_columns(&columns))
            }
            None => locator,
        }
    }
}
