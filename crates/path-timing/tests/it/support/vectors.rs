//! Vectors of any dimension.

pub(crate) fn sub<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    core::array::from_fn(|i| a[i] - b[i])
}

pub(crate) fn dot<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    core::array::from_fn::<_, D, _>(|i| a[i] * b[i])
        .iter()
        .sum()
}

pub(crate) fn norm<const D: usize>(a: [f64; D]) -> f64 {
    dot(a, a).sqrt()
}

/// A point, to be compared to the last bit.
pub(crate) fn bits<const D: usize>(a: [f64; D]) -> [u64; D] {
    a.map(f64::to_bits)
}
