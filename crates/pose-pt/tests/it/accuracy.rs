//! The documented accuracy, against arithmetic of 1e-30, by a search that goes from bad cases to
//! worse ones. `ACCURACY_CASES` makes it longer, `ACCURACY_SEED` another one:
//!
//! ```sh
//! ACCURACY_CASES=10000000 cargo test --release -p pose-pt --test it accuracy:: -- --nocapture
//! ```

mod figures;
mod search;

use figures::{
    angle_between_close, angles_at_their_lever, distances_kept, fit_rotation, matrix_of_angles,
    matrix_rebuilt, matrix_through_quaternion, positions_and_axes, slerp_between,
};
use search::search;

#[test]
fn angles_to_matrices_and_back() {
    search("matrix of angles", 2.0, matrix_of_angles);
    search(
        "matrix through a quaternion",
        6.0,
        matrix_through_quaternion,
    );
    search("matrix rebuilt", 9.0, matrix_rebuilt);
    search("angles at their lever", 6.0, angles_at_their_lever);
}

#[test]
fn rotations_between_rotations() {
    search("slerp", 8.0, slerp_between);
    search("angle between close rotations", 5.0, angle_between_close);
}

#[test]
fn positions_of_a_body() {
    search("positions and axes", 6.0, positions_and_axes);
    search("distances", 10.0, distances_kept);
}

#[test]
fn rotations_of_fits() {
    search("rotation of a fit", 12.0, fit_rotation);
}
