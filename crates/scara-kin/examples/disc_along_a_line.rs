//! A grinding disc along a line: both joints and the disc, and the same path with its points in
//! single precision, for a microcontroller.
//!
//! `cargo run -p scara-kin --features path-timing --example disc_along_a_line`

use core::error::Error;

use path_timing::{Curve, Path};
use scara_kin::{Arm, Elbow};

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Arm::new(132.0, 132.0)?; // mm
    let line = arm.path(Curve::line([-80.0, 100.0], [80.0, 100.0])?, Elbow::Right)?;
    let disc = line.with_disc(0.0)?; // which stands at 0 rad
    let coarse = line.in_f32()?;
    println!("{} mm", disc.arm_path().curve().length());
    for s in [0.0, 40.0, 80.0, 120.0, 160.0] {
        let [shoulder, elbow, tool_angle] = disc.point(s)?.position;
        let (single, double) = (coarse.point(s)?, coarse.exact().point(s)?);
        let [a, b] = [single, double].map(|at| at.position);
        let apart = (a[0] - b[0]).hypot(a[1] - b[1]);
        println!(
            "{s:5.1} mm: {shoulder:.4} {elbow:.4} {tool_angle:.4} rad; in f32 {apart:.1e} rad apart"
        );
    }
    Ok(())
}
