//! Fixed-point numbers with 64 fraction bits in a `u128`.

/// Fraction bits.
pub(super) const FRACTION: u32 = 64;

/// Whole part.
pub(super) const fn whole(q: u128) -> u64 {
    (q >> FRACTION) as u64
}

/// The nearest whole number, halves up.
pub(super) const fn nearest(q: u128) -> u64 {
    // q < 2^127 for all numbers of a plan.
    whole(q.wrapping_add(1 << (FRACTION - 1)))
}

/// Whole part, rounded up.
pub(super) const fn whole_up(q: u128) -> u64 {
    // q < 2^127 for all numbers of a plan.
    whole(q.wrapping_add(u64::MAX as u128))
}

/// A whole number.
pub(super) const fn of_whole(n: u64) -> u128 {
    (n as u128) << FRACTION
}

/// `numerator / denominator` rounded down; `None` when the whole part passes 63 bits or the
/// denominator is 0 or passes 127 bits.
pub(super) fn ratio(numerator: u128, denominator: u128) -> Option<u128> {
    if denominator >> 127 != 0 {
        return None;
    }
    let mut q = numerator.checked_div(denominator)?;
    let mut remainder = numerator.checked_rem(denominator)?;
    if q >> 63 != 0 {
        return None;
    }
    // Long division, bit by bit: remainder < denominator < 2^127, so that it doubles in range.
    for _ in 0..FRACTION {
        remainder <<= 1;
        let bit = remainder >= denominator;
        if bit {
            remainder = remainder.wrapping_sub(denominator);
        }
        q = (q << 1) | u128::from(bit);
    }
    Some(q)
}
