//! Points, joints and poses that look random, the same on every machine.

use delta_kin::nalgebra::{Point3, Vector3};
use pose_pt::PoseVector;
use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, Joints};

use crate::Real;

/// Numbers that look random.
#[derive(Clone, Debug)]
pub struct Random(u32);

impl Random {
    #[must_use]
    pub fn new() -> Self {
        Self(1)
    }

    /// Evenly between two numbers.
    pub fn between<T: Real>(&mut self, low: f64, high: f64) -> T {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let unit = f64::from(self.0 >> 8) / f64::from(1_u32 << 24);
        T::of(low + (high - low) * unit)
    }

    /// A place that the arm reaches.
    pub fn arm_point<T: Real>(&mut self, arm: &Arm<T>) -> Point2<T> {
        let shoulder = self.between(-3.1, 3.1);
        arm.forward(Joints::new(shoulder, self.between(0.1, 3.0)))
    }

    /// A place in the middle of [`delta`]'s workspace.
    pub fn delta_point<T: Real>(&mut self) -> Point3<T> {
        let [x, y] = [0; 2].map(|_| self.between(-60.0, 60.0));
        Point3::new(x, y, self.between(-300.0, -240.0))
    }

    /// A pose of [`platform`] within a few degrees.
    pub fn pose<T: Real>(&mut self) -> PoseVector<T> {
        let [x, y, z] = [0; 3].map(|_| self.between(-100.0, 100.0));
        let [alpha, beta, gamma] = [0; 3].map(|_| self.between(-0.05, 0.05));
        PoseVector::new(x, y, z, alpha, beta, gamma)
    }

    /// A velocity in any direction.
    pub fn velocity<T: Real>(&mut self) -> Vector3<T> {
        Vector3::from([0; 3].map(|_| self.between(-10.0, 10.0)))
    }
}

impl Default for Random {
    fn default() -> Self {
        Self::new()
    }
}

/// A Delta with upper arms of 120 mm.
///
/// # Panics
/// Never: the lengths are good.
#[must_use]
pub fn delta<T: Real>() -> delta_kin::Delta<T> {
    let [base, platform, upper, lower] = [42.0, 18.0, 120.0, 243.0].map(T::of);
    delta_kin::Delta::new(delta_kin::Dimensions {
        base,
        platform,
        upper,
        lower,
    })
    .expect("the lengths are good")
}

/// A panel of 3 m on three locators.
///
/// # Panics
/// Never: three anchors in a triangle.
#[must_use]
pub fn platform<T: Real>() -> pose_pt::Platform<3, T> {
    let limits = [-300.0, 300.0, 20.0, 100.0].map(T::of);
    let limits = [pose_pt::LocatorAxis {
        min: limits[0],
        max: limits[1],
        speed: limits[2],
        acceleration: limits[3],
        jerk: None,
    }; 3];
    let anchors = [
        [-1500.0, -1000.0, 0.0],
        [1500.0, -1000.0, 50.0],
        [0.0, 1000.0, -20.0],
    ];
    let locators = anchors.map(|anchor| {
        let anchor = anchor.map(T::of).into();
        pose_pt::Locator::new(anchor, anchor, limits)
    });
    pose_pt::Platform::new(locators).expect("a triangle")
}
