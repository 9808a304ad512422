//! Vectors of any dimension.

use crate::number::sqrt;

/// Componentwise.
fn zip<const D: usize>(a: &[f64; D], b: &[f64; D], f: impl Fn(f64, f64) -> f64) -> [f64; D] {
    let mut result = *a;
    for (a, b) in result.iter_mut().zip(b) {
        *a = f(*a, *b);
    }
    result
}

/// a - b
pub(super) fn difference<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    zip(a, b, |a, b| a - b)
}

/// a + k b
pub(super) fn along<const D: usize>(a: &[f64; D], k: f64, b: &[f64; D]) -> [f64; D] {
    zip(a, b, |a, b| a + k * b)
}

/// k a
pub(super) fn scaled<const D: usize>(a: &[f64; D], k: f64) -> [f64; D] {
    a.map(|a| k * a)
}

pub(super) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(super) fn norm<const D: usize>(a: &[f64; D]) -> f64 {
    sqrt(dot(a, a))
}

pub(super) fn all_finite<const D: usize>(a: &[f64; D]) -> bool {
    a.iter().all(|a| a.is_finite())
}
