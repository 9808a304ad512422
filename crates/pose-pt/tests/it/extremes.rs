//! What is no number, and numbers at the ends of their type: an error that names them, a result
//! that is no number either, or the right one.

mod calls;
mod paths;
#[cfg(feature = "path-timing")]
mod pvt;

use calls::{Call, Inputs, Outcome};
use pose_pt::nalgebra::{Matrix3, RealField, UnitQuaternion, Vector3};
use pose_pt::{Convention, PosePath, PoseVector, Trig, slerp, to_matrix};

/// Of numbers that a tiny one is added to: what cancels in a fit or a plan.
const ROUNDING: f64 = 1e-5;

impl<T: RealField + Trig> Call<T> {
    /// The outcome with one of the numbers replaced.
    fn with(&self, place: usize, value: T) -> Outcome<T> {
        let mut numbers = self.good.clone();
        numbers[place] = value;
        let mut inputs = Inputs::new(&numbers);
        let outcome = (self.run)(&mut inputs);
        if let Err(message) = &outcome {
            assert!(message.len() < 200, "{}: {message}", self.name);
        } else {
            assert!(inputs.is_empty(), "{} takes fewer numbers", self.name);
        }
        outcome
    }
}

/// All calls in f64.
fn double() -> Vec<Call<f64>> {
    let mut calls = calls::all();
    calls.extend(paths::all());
    #[cfg(feature = "path-timing")]
    calls.extend(pvt::all());
    calls
}

fn is_finite<T: RealField + Trig>(numbers: &[T]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}

/// Whether each number is the same but for rounding.
fn are_close<T: RealField + Trig>(a: &[T], b: &[T]) -> bool {
    let rounding: T = T::from_subset(&ROUNDING);
    let size = b.iter().fold(T::one(), |size, b| size.max(b.abs()));
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|(a, b)| (*a - *b).abs() <= size * rounding)
}

fn check_not_finite<T: RealField + Trig>(calls: &[Call<T>], bad: [T; 3]) {
    for call in calls {
        for place in 0..call.good.len() {
            for bad in bad {
                if let Ok(numbers) = call.with(place, bad) {
                    let silent = is_finite(&numbers);
                    assert!(!silent, "{}, number {place}: {bad}: {numbers:?}", call.name);
                }
            }
        }
    }
}

fn check_good<T: RealField + Trig>(calls: &[Call<T>]) {
    for call in calls {
        let numbers = call.with(0, call.good[0]);
        let good = numbers.as_ref().is_ok_and(|numbers| is_finite(numbers));
        assert!(good, "{}: {numbers:?}", call.name);
    }
}

#[test]
fn what_is_no_number_is_no_answer() {
    let (double, single) = (double(), calls::all::<f32>());
    check_good(&double);
    check_good(&single);
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    check_not_finite(&double, bad);
    check_not_finite(&single, [f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
}

/// A number that is far below all others is refused, or does what zero does.
fn check_tiny<T: RealField + Trig>(calls: &[Call<T>], tiny: &[T]) {
    for call in calls {
        for place in 0..call.good.len() {
            let zero = call.with(place, T::zero());
            for tiny in tiny {
                let Ok(numbers) = call.with(place, *tiny) else {
                    continue;
                };
                let like_zero = zero.as_ref().is_ok_and(|zero| are_close(&numbers, zero));
                assert!(
                    like_zero,
                    "{}, number {place}: {tiny}: {numbers:?} {zero:?}",
                    call.name
                );
            }
        }
    }
}

#[test]
fn tiny_numbers_do_what_zero_does() {
    let tiny = [5e-324, 1e-310, 1e-300, 1e-161];
    check_tiny(&double(), &tiny);
    check_tiny(&calls::all::<f32>(), &[1e-45, 1e-40, 1e-37, 1e-25]);
}

/// A number that is far above all others is refused, or overflows, or changes what it is itself
/// by its own factor and nothing else.
fn check_huge<T: RealField + Trig>(calls: &[Call<T>], large: T, huge: T) {
    // Sines of huge angles, and quaternions that are no rotations, see below.
    let other = ["PoseVector::to_*", "slerp", "PosePath of vectors"];
    let factor = huge / large;
    let rounding: T = T::from_subset(&1e-3);
    for call in calls.iter().filter(|call| !other.contains(&call.name)) {
        for place in 0..call.good.len() {
            let Ok(numbers) = call.with(place, huge) else {
                continue;
            };
            if !is_finite(&numbers) {
                continue;
            }
            let before = call.with(place, large).unwrap();
            let is_right = |(found, before): (&T, &T)| {
                let off = |wanted: T| (*found - wanted).abs() <= rounding * wanted.abs();
                off(*before) || off(*before * factor)
            };
            let are_right = numbers.iter().zip(&before).all(is_right);
            assert!(are_right, "{}, number {place}: {numbers:?}", call.name);
        }
    }
}

#[test]
fn huge_numbers_are_refused_or_taken_as_they_are() {
    for (large, huge) in [(1e40, 1e300), (-1e40, -1e300)] {
        check_huge(&double(), large, huge);
    }
    for (large, huge) in [(1e8, 1e37), (-1e8, -1e37)] {
        check_huge(&calls::all::<f32>(), large, huge);
    }
}

#[test]
fn huge_angles_are_reduced_or_refused() {
    // As many turns as there are.
    let vector = PoseVector::new(0.0, 0.0, 0.0, 0.0, 0.0, 1e300);
    let rotation = vector.to_rotation(Convention::ExtrinsicXyz);
    let (sin, cos) = (libm::sin(1e300), libm::cos(1e300));
    let wanted = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
    assert!((rotation.matrix() - wanted).amax() < 1e-15);
    let by_quaternion = to_matrix(&vector.to_quaternion(Convention::ExtrinsicXyz));
    assert!((by_quaternion.matrix() - wanted).amax() < 1e-15);
    // The angle is rounded, but there is no rotation without length.
    let (a, b) = (
        UnitQuaternion::identity(),
        UnitQuaternion::new(Vector3::z()),
    );
    for t in [-1e150, -1e9, 1e9, 1e150] {
        assert!((slerp(&a, &b, t).norm() - 1.0_f64).abs() < 1e-15, "{t}");
    }
    // An angle next to one that is rounded to more than a turn.
    let pose = PoseVector::new(1.0, 2.0, 3.0, 0.1, 0.2, 0.3).to_isometry(Convention::IntrinsicXyz);
    let near = |gamma| {
        let previous = PoseVector::new(0.0, 0.0, 0.0, 0.0, 0.0, gamma);
        let found = PoseVector::from_isometry_near(&pose, Convention::IntrinsicXyz, &previous);
        found.vector
    };
    let off = near(1e7)
        .to_isometry(Convention::IntrinsicXyz)
        .rotation
        .angle_to(&pose.rotation);
    assert!(off < 1e7 * f64::EPSILON, "{off}");
    assert!(near(1e8).gamma.is_nan() && near(1e300).gamma.is_nan());
    let vectors = [vector; 2];
    let path = PosePath::of_vectors(&vectors, Convention::ExtrinsicXyz).unwrap_err();
    assert_eq!(
        path.to_string(),
        "angle 1e300 of pose 0 is not within ±6.71089e7 rad"
    );
}

/// Places of what is a length, among the numbers of a platform, of two poses and of two
/// segmentations.
fn is_length(place: usize) -> bool {
    match place {
        0..90 => !(6..15).contains(&(place % 30)),
        93..=96 | 100..=103 | 105 => false,
        _ => true,
    }
}

/// The lengths in another unit: refused, or right to the last digit.
fn check_unit<T: RealField + Trig>(call: &Call<T>, unit: T, is_in_range: bool) {
    let is_fit = call.name == "rigid_fit";
    let numbers = call.good.iter().enumerate();
    let scaled: Vec<T> = numbers
        .map(|(place, x)| {
            if is_fit || is_length(place) {
                *x * unit
            } else {
                *x
            }
        })
        .collect();
    let outcome = (call.run)(&mut Inputs::new(&scaled));
    let name = call.name;
    let Ok(found) = outcome else {
        assert!(!is_in_range, "{name}, {unit}: {outcome:?}");
        return;
    };
    let wanted = (call.run)(&mut Inputs::new(&call.good)).unwrap();
    assert_eq!(found.len(), wanted.len());
    for (found, wanted) in found.iter().zip(&wanted) {
        let mut units = [T::one(), unit, unit * unit].into_iter();
        let is_right = units.any(|unit| *wanted * unit == *found);
        assert!(is_right, "{name}, {unit}: {found}, {wanted}");
    }
}

fn check_units<T: RealField + Trig>(calls: &[Call<T>], exponents: [i32; 2], range: [i32; 2]) {
    let names = ["Platform of poses", "rigid_fit", "PtTable", "PVT"];
    for call in calls.iter().filter(|call| names.contains(&call.name)) {
        for exponent in (exponents[0]..exponents[1]).step_by(5) {
            let unit = T::from_subset(&2_f64.powi(exponent));
            let is_in_range = (range[0]..=range[1]).contains(&exponent);
            check_unit(call, unit, is_in_range);
        }
    }
}

/// A body of any size, with its way and all limits: right from one end of the range to the other,
/// by no digit wrong beyond.
#[test]
fn a_body_of_any_size_is_right_or_refused() {
    check_units(&double(), [-1070, 1020], [-160, 160]);
    check_units(&calls::all::<f32>(), [-148, 126], [-24, 24]);
}
