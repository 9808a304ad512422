//! A random body on random locators, its way, limits and unit; now and then a number that is none.

use pose_pt::nalgebra::{Isometry3, Matrix3, Point3, UnitQuaternion, Vector3};
use pose_pt::{Convention, Interpolation, Locator, LocatorAxis, Platform, Segmentation};

use crate::support::table::Cut;
use test_support::Random;

pub(crate) struct Draw(Random);

impl Draw {
    pub(crate) const fn new(random: Random) -> Self {
        Self(random)
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.share()
    }

    /// 10^low to 10^high.
    pub(crate) fn size(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.within(low, high))
    }

    pub(crate) fn one_in(&mut self, cases: u64) -> bool {
        self.0.bits().is_multiple_of(cases)
    }

    /// 1 to `max`, as many small numbers as large ones.
    pub(crate) fn count(&mut self, max: f64) -> u32 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small positive number"
        )]
        let count = self.size(0.0, max.log10()) as u32;
        count
    }

    fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from([(); 3].map(|()| self.within(-size, size)))
    }

    /// A number that no machine has.
    fn poison(&mut self) -> f64 {
        let all = [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            1e300,
            -1e300,
            1e-310,
            5e-324,
            0.0,
            -1.0,
            1e80,
            1e-80,
        ];
        all[usize::try_from(self.0.bits() % 11).unwrap()]
    }
}

/// All that a table is planned from.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub(crate) locators: [Locator; 3],
    pub(crate) poses: Vec<Isometry3<f64>>,
    pub(crate) kind: Interpolation,
    pub(crate) segmentation: Segmentation,
    pub(crate) cut: Cut,
}

const KINDS: [Interpolation; 4] = [
    Interpolation::Straight,
    Interpolation::Screw,
    Interpolation::Vector(Convention::ExtrinsicXyz),
    Interpolation::Vector(Convention::IntrinsicXyz),
];

impl Scene {
    pub(crate) fn new(draw: &mut Draw) -> Self {
        // One in eight far beyond any machine.
        let reach = if draw.one_in(8) { 60.0 } else { 6.0 };
        let unit = draw.size(-reach, reach);
        let mut locators = locators(draw, unit, reach);
        let poses = poses(draw, unit);
        tighten(draw, &mut locators, &poses);
        let (segmentation, cut) = cuts(draw, unit);
        let kind = KINDS[usize::try_from(draw.0.bits() % 4).unwrap()];
        let mut scene = Self {
            locators,
            poses,
            kind,
            segmentation,
            cut,
        };
        if draw.one_in(12) {
            scene.poison(draw);
        }
        scene
    }

    /// The distance error that is allowed.
    pub(crate) fn allowed(&self) -> Option<f64> {
        match self.cut {
            Cut::Within(allowed) => Some(allowed),
            Cut::Into(_) => None,
        }
    }

    /// Replaces one number.
    fn poison(&mut self, draw: &mut Draw) {
        let value = draw.poison();
        let locator = &mut self.locators[usize::try_from(draw.0.bits() % 3).unwrap()];
        let axis = usize::try_from(draw.0.bits() % 3).unwrap();
        let limits = &mut locator.limits[axis];
        match draw.0.bits() % 10 {
            0 => locator.anchor[axis] = value,
            1 => locator.origin[axis] = value,
            2 => locator.axes[(axis, 1)] = value,
            3 => limits.min = value,
            4 => limits.max = value,
            5 => limits.speed = value,
            6 => limits.acceleration = value,
            7 => limits.jerk = Some(value),
            8 => self.poses[1].translation.vector[axis] = value,
            _ => {
                self.segmentation = Segmentation::max_distance_error(value);
                self.cut = Cut::Within(value);
            }
        }
    }
}

fn locators(draw: &mut Draw, unit: f64, reach: f64) -> [Locator<f64>; 3] {
    let thin = draw.size(-3.0, 0.0);
    let off = unit * draw.size(-3.0, 2.0);
    let is_skewed = draw.one_in(2);
    // Speeds and accelerations from a thousandth to a thousand units, or from any time scale.
    let time = draw.size(-reach / 2.0, reach / 2.0);
    let has_jerk = draw.one_in(3);
    [(); 3].map(|()| {
        let anchor = draw
            .vector(unit)
            .component_mul(&Vector3::new(1.0, thin, thin));
        let origin = if draw.one_in(2) {
            anchor
        } else {
            draw.vector(off)
        };
        let axes = if is_skewed {
            Matrix3::from_fn(|row, column| {
                f64::from(u8::from(row == column)) + draw.within(-0.2, 0.2)
            })
        } else {
            Matrix3::identity()
        };
        let limits = [(); 3].map(|()| {
            let far = 1e4 * (unit + off);
            let speed = unit / time * draw.size(-1.0, 1.0);
            let acceleration = unit / (time * time) * draw.size(-2.0, 2.0);
            let with_jerk = has_jerk && !draw.one_in(4);
            LocatorAxis {
                min: -far,
                max: far,
                speed,
                acceleration,
                jerk: with_jerk.then(|| unit / (time * time * time) * draw.size(-3.0, 3.0)),
            }
        });
        Locator::new(Point3::from(anchor), Point3::from(origin), limits).with_axes(axes)
    })
}

fn poses(draw: &mut Draw, unit: f64) -> Vec<Isometry3<f64>> {
    let (slide, turn) = (unit * draw.size(-9.0, 1.0), 3.0 * draw.size(-9.0, 0.0));
    let (start, start_turn) = (draw.vector(unit), draw.vector(2.0));
    let mut pose = Isometry3::from_parts(start.into(), UnitQuaternion::new(start_turn));
    let mut poses = vec![pose];
    for _ in 0..draw.count(3.9) {
        if draw.one_in(10) {
            // Nothing moves.
        } else {
            let by = UnitQuaternion::new(draw.vector(turn) * f64::from(u8::from(!draw.one_in(5))));
            let vector = pose.translation.vector + draw.vector(slide);
            pose = Isometry3::from_parts(vector.into(), by * pose.rotation);
        }
        poses.push(pose);
    }
    poses
}

/// One in six: strokes that end where the way does, or a little before.
fn tighten(draw: &mut Draw, locators: &mut [Locator<f64>; 3], poses: &[Isometry3<f64>]) {
    let Ok(platform) = Platform::new(*locators) else {
        return;
    };
    if !draw.one_in(6) {
        return;
    }
    let ends: Vec<_> = poses.iter().map(|pose| platform.axes(pose)).collect();
    let room = draw.within(-0.001, 0.05);
    for (number, locator) in locators.iter_mut().enumerate() {
        for (axis, limits) in locator.limits.iter_mut().enumerate() {
            let places = ends.iter().map(|axes| axes[number][axis]);
            let low = places.clone().fold(f64::MAX, f64::min);
            let high = places.fold(f64::MIN, f64::max);
            let by = (high - low) * room;
            if by > 0.0 || (high - low) > 4.0 * by.abs() {
                (limits.min, limits.max) = (low - by, high + by);
            }
        }
    }
}

/// How finely positions are cut, and cubics.
fn cuts(draw: &mut Draw, unit: f64) -> (Segmentation, Cut) {
    let at_least = draw.count(100.0);
    match draw.0.bits() % 4 {
        0 => {
            let distance_error = unit * draw.size(-12.0, 0.0);
            let segmentation = Segmentation::max_distance_error(distance_error);
            let cut = Cut::Within(distance_error);
            (segmentation.at_least(at_least), cut)
        }
        1 => {
            let (slide, turn) = (unit * draw.size(-3.0, 1.0), draw.size(-2.0, 1.0));
            (Segmentation::steps(slide, turn), Cut::Into(at_least))
        }
        _ => {
            let segments = draw.count(130.0);
            (Segmentation::segments(segments), Cut::Into(segments))
        }
    }
}
