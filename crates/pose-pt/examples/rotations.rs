//! A turn in the forms that instruments and programs have: matrix, angles, quaternion, rotation
//! vector.
//!
//! `cargo run -p pose-pt --example rotations`

use core::error::Error;

use pose_pt::nalgebra::{Isometry3, Matrix3, Vector3};
use pose_pt::{
    Convention, PoseVector, Resolved, from_matrix, from_rotation_vector, rotation_vector,
    rotation_vector_between, slerp, to_matrix,
};

fn main() -> Result<(), Box<dyn Error>> {
    // A matrix that was printed with four digits is a rotation but for 1e-4.
    let printed = Matrix3::new(0.9553, -0.2955, 0.0, 0.2955, 0.9553, 0.0, 0.0, 0.0, 1.0);
    let start = from_matrix(&printed, 1e-3)?;
    println!(
        "{:.6} about {:.3?}",
        start.angle(),
        rotation_vector(&start).as_slice()
    );
    println!("{:.6}", to_matrix(&start).matrix());

    // The angles of a panel, and back; `locked` where two of the axes are one.
    let end = PoseVector::new(0.0, 0.0, 0.0, 0.1, 0.2, 1.3).to_quaternion(Convention::ExtrinsicXyz);
    let resolved: Resolved = PoseVector::from_isometry(
        &Isometry3::from_parts(Vector3::zeros().into(), end),
        Convention::ExtrinsicXyz,
    );
    println!("{:?}, locked: {}", resolved.vector, resolved.locked);

    // From one to the other at a constant rate about one axis of the world.
    let turn = rotation_vector_between(&start, &end);
    println!(
        "{:.4} rad about {:.3?}",
        turn.norm(),
        turn.normalize().as_slice()
    );
    for tenth in [0, 5, 10] {
        let t = f64::from(tenth) / 10.0;
        let by_vector = from_rotation_vector(&(turn * t)) * start;
        let between = slerp(&start, &end, t);
        println!("{t}: {:.1e} rad apart", between.angle_to(&by_vector));
    }
    Ok(())
}
