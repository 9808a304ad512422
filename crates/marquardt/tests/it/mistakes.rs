//! Ends that are no fit.

use marquardt::NotConverged;

use crate::model::{Curve, Fit};

fn run(curve: Curve<1>, x: &[f64], y: &[f64]) -> NotConverged {
    let start = [1.0];
    Fit { curve, x, y, start }.run().unwrap_err()
}

#[test]
fn what_cannot_be_computed_at_the_start_has_no_rms() {
    let error = run(|x, [b]| ((b - x).sqrt(), [1.0]), &[2.0], &[1.0]);
    assert!(error.iterations == 0 && error.rms.is_nan());
    assert_eq!(
        error.to_string(),
        "not converged after 0 iterations, rms NaN"
    );
}

/// b to the power of -1/20 is nearer to zero the larger b is: each iteration is worth its time.
#[test]
fn what_shrinks_for_ever_ends_with_what_was_reached() {
    const SPAN: f64 = 1000.0;
    let curve: Curve<1> = |x, [b]| {
        if x == 0.0 {
            (b.powf(-0.05), [-0.05 * b.powf(-1.05)])
        } else {
            (SPAN, [0.0])
        }
    };
    let error = run(curve, &[0.0, 1.0], &[0.0, SPAN]);
    assert_eq!(error.iterations, 200);
    assert!((1e-6..1e-4).contains(&error.rms), "{error}");
}

/// A span of nothing, numbers that are none, squares beyond the largest number.
#[test]
fn nothing_is_fitted_to_no_number() {
    for (span, x, y) in [(0.0, 1.0, 1.0), (1.0, 1.0, f64::NAN), (1.0, 1e300, 0.0)] {
        let fit = Fit {
            curve: |x, [b]| (b * x, [x]),
            x: &[x],
            y: &[y],
            start: [1.0],
        };
        let error = marquardt::fit(&fit, span, [1.0]).unwrap_err();
        assert!(error.iterations == 0 && error.rms.is_nan(), "{error}");
    }
}
