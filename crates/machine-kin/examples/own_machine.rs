//! A machine that is not in the crate, from its README alone: the boom of a camera, which turns,
//! tilts, and has a carriage along it.
//!
//! `cargo run -p machine-kin --example own_machine`

use core::error::Error;

use machine_kin::path_timing::{AxisLimits, Curve};
use machine_kin::{Axis, Machine, MachinePath, Number, Refusal};
use pvt_steps::{Drive, Rate};

/// Its axle is at a height above the floor, in mm.
#[derive(Debug, Clone)]
struct Boom(f64);

impl Machine<3> for Boom {
    type Branch = ();

    fn axes(&self) -> [Axis; 3] {
        [
            Axis::angle("turntable", -6.0..=6.0),
            Axis::angle("tilt", -0.5..=1.2),
            Axis::linear("carriage", 400.0..=1500.0),
        ]
    }

    fn inverse<T: Number>(&self, [x, y, z]: [T; 3], (): ()) -> Result<[T; 3], Refusal> {
        const ABOVE: &str = "the camera is above the turntable";
        let up = z - self.0;
        let out = (x.squared() + y.squared()).root(ABOVE)?;
        let carriage = (out.squared() + up.squared()).root("the camera is at the axle")?;
        Ok([T::atan2(y, x, ABOVE)?, T::atan2(up, out, ABOVE)?, carriage])
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let boom = Boom(900.0);
    let shot = Curve::line([800.0, -300.0, 700.0], [500.0, 600.0, 1300.0])?;
    let path = boom.path(shot, ())?;
    let [turn, way] = [0.5, 300.0].map(|speed| AxisLimits {
        speed,
        acceleration: 2.0 * speed,
        jerk: None,
    });
    let steps_per_unit = [20_000.0, 20_000.0, 80.0];
    let mut drive = Drive::new([turn, turn, way], steps_per_unit, Rate::from_hz(1_000_000)?)?;
    for step in drive.along([path], 0.1, MachinePath::departure) {
        let step = step?;
        println!("{:>9} axis {} {:?}", step.ticks, step.axis, step.direction);
    }
    let over_head = Curve::line([800.0, 0.0, 1500.0], [-800.0, 0.0, 1500.0])?;
    if let Err(refused) = boom.path(over_head, ()) {
        println!("{refused}");
    }
    Ok(())
}
