//! Where the tool of a two-link arm is, in f32: one pose, then eight in vector instructions.
#![expect(clippy::print_stdout, reason = "that is what an example is for")]

use trig_kernels::{atan2, sin_cos, sin_cos_lanes};

/// Both links, mm.
const LINK: f32 = 132.0;

fn main() {
    let (shoulder, elbow) = (0.3_f32, 1.2);
    let (sin1, cos1) = sin_cos(shoulder);
    let (sin2, cos2) = sin_cos(shoulder + elbow);
    let (x, y) = (LINK * (cos1 + cos2), LINK * (sin1 + sin2));
    println!(
        "tool at ({x:.4}, {y:.4}) mm, seen at {:.6} rad",
        atan2(y, x)
    );

    // Eight shoulders at once; the bits are those of one by one.
    let shoulders = [0.0_f32, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75];
    let (sin1, cos1) = sin_cos_lanes(shoulders);
    let (sin2, cos2) = sin_cos_lanes(shoulders.map(|shoulder| shoulder + elbow));
    let upper = cos1.into_iter().zip(sin1);
    let fore = cos2.into_iter().zip(sin2);
    for (shoulder, (upper, fore)) in shoulders.into_iter().zip(upper.zip(fore)) {
        let (x, y) = (LINK * (upper.0 + fore.0), LINK * (upper.1 + fore.1));
        println!("shoulder {shoulder:.2}: ({x:9.4}, {y:9.4})");
    }
}
