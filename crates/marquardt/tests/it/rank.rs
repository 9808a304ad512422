//! What the measurements do not determine.

use marquardt::Calibration;

use crate::model::Fit;

const X: [f64; 5] = [0.0, 1.0, 2.0, 3.0, 4.0];
/// Of a straight line y = 1 + 2x and of some noise.
const Y: [f64; 5] = [1.1, 2.9, 5.2, 6.8, 9.0];

/// Of numbers of size 1 after some rotations.
const ROUNDING: f64 = 1e-13;

/// Of parameters of size 1 where the last decrease was of 1e-9 of the sum: √1e-9 of a deviation of
/// 0.1, and less.
const LAST: f64 = 1e-6;

/// y = b1 + b2 + b3 x, and b4 is in nothing: the first two are one sum.
fn sum_and_slope(x: f64, [b1, b2, b3, _]: [f64; 4]) -> (f64, [f64; 4]) {
    (b1 + b2 + b3 * x, [1.0, 1.0, x, 0.0])
}

#[test]
fn a_sum_of_two_parameters_and_one_without_influence() {
    let fit = Fit {
        curve: sum_and_slope,
        x: &X,
        y: &Y,
        start: [0.5, 1.5, 3.0, 7.0],
    };
    let (b, found) = fit.run().unwrap();
    // By hand: Σx = 10, Σx² = 30, Σy = 25, Σxy = 69.7; slope 19.7/10, mean 5.
    assert!((b[0] + b[1] - 1.06).abs() < LAST, "{b:?}");
    assert!((b[2] - 1.97).abs() < LAST, "{b:?}");
    // What nothing determines stays; what only a sum does is shared by the damping.
    assert!((b[3] - 7.0).abs() < ROUNDING);
    assert_eq!(found.rank(), 2);
    assert!(found.conditioning() < ROUNDING);
    let null: Vec<_> = found.null_space().collect();
    assert_eq!(null.len(), 2);
    for [c1, c2, c3, _] in &null {
        assert!((c1 + c2).abs() < ROUNDING && c3.abs() < ROUNDING);
    }
    assert!(null.iter().any(|change| change[0].abs() > 0.1));
    assert!(null.iter().any(|change| change[3].abs() > 0.1));
    // Residuals 0.04, -0.13, 0.2, -0.17, 0.06; 1 of 5 degrees of freedom, as for all four. Slope:
    // over √10.
    let deviations = found.deviations();
    assert_eq!([0, 1, 3].map(|i| deviations[i]), [None; 3]);
    let slope = (0.091_f64 / 10.0).sqrt();
    assert!((deviations[2].unwrap() - slope).abs() < LAST);

    let calibration = Calibration::new("line", ["offset", "shift", "slope", "idle"], found);
    let undetermined: Vec<_> = calibration.undetermined().collect();
    assert_eq!(undetermined, ["offset", "shift", "idle"]);
    assert_eq!(*calibration.machine(), "line");
    assert_eq!(calibration.parameters()[2], "slope");
    assert_eq!(calibration.rank(), 2);
}

/// y = b1 + b2 x
fn line(x: f64, [b1, b2]: [f64; 2]) -> (f64, [f64; 2]) {
    (b1 + b2 * x, [1.0, x])
}

#[test]
fn a_line_by_hand() {
    let fit = Fit {
        curve: line,
        x: &X,
        y: &Y,
        start: [10.0, -3.0],
    };
    let (b, found) = fit.run().unwrap();
    assert!((b[0] - 1.06).abs() < LAST && (b[1] - 1.97).abs() < LAST);
    // 0.091 is the sum of squares, 3 are the degrees of freedom: variance / Σ(x - 2)², and of b1
    // times Σx²/5.
    let variance = 0.091_f64 / 3.0;
    let [offset, slope] = found.deviations().map(Option::unwrap);
    assert!((slope - (variance / 10.0).sqrt()).abs() < LAST);
    assert!((offset - (variance * 30.0 / 50.0).sqrt()).abs() < LAST);
    // The cosine of the columns' angle is 10/√150: singular values √(1 ± cos).
    let cos = 10.0 / 150.0_f64.sqrt();
    let conditioning = ((1.0 - cos) / (1.0 + cos)).sqrt();
    assert!((found.conditioning() - conditioning).abs() < ROUNDING);
    assert_eq!(found.null_space().count(), 0);
}

#[test]
fn the_units_of_parameters_and_of_what_is_measured_change_no_digit_that_counts() {
    let of = |unit: f64, start: [f64; 2]| {
        let y = Y.map(|y| y * unit);
        let (curve, x, y) = (line as _, &X[..], &y[..]);
        let (b, found) = Fit { curve, x, y, start }.run().unwrap();
        let [offset, slope] = found.deviations().map(Option::unwrap);
        [b[0], b[1], offset, slope, found.rms(), found.largest()].map(|value| value / unit)
    };
    let [here, there] = [of(1.0, [10.0, -3.0]), of(1e-6, [1e-3, 2e-9])];
    for (here, there) in here.into_iter().zip(there) {
        assert!((here / there - 1.0).abs() < LAST, "{here} {there}");
    }
}

/// Fewer measurements than parameters: met exactly, and the rest stays open.
#[test]
fn one_measurement_determines_one_combination() {
    let fit = Fit {
        curve: line,
        x: &[2.0],
        y: &[5.0],
        start: [1.0, 1.0],
    };
    let (b, found) = fit.run().unwrap();
    assert!((b[0] + 2.0 * b[1] - 5.0).abs() < ROUNDING);
    assert_eq!((found.rank(), found.deviations()), (1, [None; 2]));
    let [c1, c2] = found.null_space().next().unwrap();
    assert!((c1 + 2.0 * c2).abs() < ROUNDING && c1.abs() > 0.1);
}

#[test]
fn no_measurement_determines_nothing() {
    let fit = Fit {
        curve: line,
        x: &[],
        y: &[],
        start: [1.0, 1.0],
    };
    let (b, found) = fit.run().unwrap();
    assert_eq!((b, found.rank()), ([1.0, 1.0], 0));
    assert_eq!((found.rms(), found.conditioning()), (0.0, 0.0));
}
