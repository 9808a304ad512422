//! The two arms that have proofs by hand, as machines.

use machine_kin::{Axis, Elbow, Machine, Number, Refusal};

const FREE: core::ops::RangeInclusive<f64> = f64::NEG_INFINITY..=f64::INFINITY;

/// Two links in a plane, their base at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TwoLinks {
    pub(crate) upper: f64,
    pub(crate) fore: f64,
    /// x, y, and the rotation.
    pub(crate) base: [f64; 3],
}

impl Machine<2> for TwoLinks {
    type Branch = Elbow;

    fn axes(&self) -> [Axis; 2] {
        [Axis::angle("shoulder", FREE), Axis::angle("elbow", FREE)]
    }

    fn inverse<T: Number>(&self, [x, y]: [T; 2], elbow: Elbow) -> Result<[T; 2], Refusal> {
        const REACH: &str = "the arm is too short or too long";
        let Self { upper, fore, base } = *self;
        let (x, y) = (x - base[0], y - base[1]);
        let square = x.squared() + y.squared();
        let (stretched, folded) = (upper + fore, upper - fore);
        let area = (T::from(stretched * stretched) - square).root(REACH)?
            * (square - folded * folded).root(REACH)?
            / 2.0;
        let along = (square - (upper * upper + fore * fore)) / 2.0;
        let area = if elbow == Elbow::Right { area } else { -area };
        let k = along + upper * upper;
        let shoulder = T::atan2(y * k - x * area, x * k + y * area, REACH)? - base[2];
        Ok([shoulder, T::atan2(area, along, REACH)?])
    }
}

/// A rotary Delta whose angles are zero straight down and outward positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RotaryDelta {
    /// Base radius less that of the platform.
    pub(crate) radius: f64,
    pub(crate) upper: f64,
    pub(crate) lower: f64,
    /// Of the angles.
    pub(crate) zero: f64,
}

impl Machine<3> for RotaryDelta {
    type Branch = ();

    fn axes(&self) -> [Axis; 3] {
        ["arm 1", "arm 2", "arm 3"].map(|name| Axis::angle(name, FREE))
    }

    fn inverse<T: Number>(&self, [x, y, z]: [T; 3], (): ()) -> Result<[T; 3], Refusal> {
        const REACH: &str = "the rod is too short or too long";
        let arm = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let out = x * cos + y * sin - self.radius;
            let side = y * cos - x * sin;
            let square = out.squared() + z.squared();
            let (upper, lower) = (self.upper, self.lower);
            let k = (square + side.squared() + (upper * upper - lower * lower)) / (2.0 * upper);
            let h = (square - k.squared()).root(REACH)?;
            Ok(T::atan2(out * k - z * h, -(z * k + out * h), REACH)? - self.zero)
        };
        Ok([arm(30.0)?, arm(150.0)?, arm(270.0)?])
    }
}
