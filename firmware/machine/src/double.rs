//! The product of two doubles on a processor that multiplies 32 bits by 32 to the lower 32.
//!
//! A Cortex-M0+ has no instructions for `f64`, and what a compiler brings for it multiplies with 64
//! bits by 64, four times. From the telegram of a Delta's line to the first edge of the Pico that is
//! 0.04 s of 0.24, in emulation (`firmware/emulate/run`).

/// Bits of a double: sign, 11 of exponent, 52 of fraction.
const FRACTION_BITS: u32 = 52;
const FRACTION: u64 = (1 << FRACTION_BITS) - 1;
const SIGN: u64 = 1 << 63;
const LARGEST_EXPONENT: u32 = 0x7FF;
/// What an exponent is larger by than that of the number.
const BIAS: u32 = 1023;

/// Fractions are multiplied at the top of 64 bits.
const SPARE: u32 = 63 - FRACTION_BITS;
/// What is rounded off, and half of the last place.
const ROUNDED_OFF: u64 = (1 << SPARE) - 1;
const HALF: u64 = 1 << (SPARE - 1);

/// The product of two doubles, rounded to nearest and to even: that of IEEE 754, bit for bit.
///
/// `other` has the product where one of the factors or the product is not normal: zero, infinite,
/// next to that, or not a number.
#[must_use]
#[inline]
pub fn product(a: f64, b: f64, other: impl FnOnce(f64, f64) -> f64) -> f64 {
    let (x, y) = (a.to_bits(), b.to_bits());
    let (p, q) = (exponent(x), exponent(y));
    if !is_normal(p) || !is_normal(q) {
        return other(a, b);
    }
    let [mut high, mut low] = wide_product(fraction(x), fraction(y));
    let mut exponent = (p + q).wrapping_sub(BIAS - 1);
    if high < SIGN {
        (high, low) = ((high << 1) | (low >> 63), low << 1);
        exponent = exponent.wrapping_sub(1);
    }
    if !is_normal(exponent) {
        return other(a, b);
    }
    let (digits, rest) = (high >> SPARE, high & ROUNDED_OFF);
    let is_more = rest > HALF || (rest == HALF && (low != 0 || digits & 1 == 1));
    // One more of the exponent where all digits of the fraction are 1.
    let size = (u64::from(exponent - 1) << FRACTION_BITS) + digits + u64::from(is_more);
    f64::from_bits(((x ^ y) & SIGN) | size)
}

#[inline(always)]
const fn exponent(bits: u64) -> u32 {
    (bits >> FRACTION_BITS) as u32 & LARGEST_EXPONENT
}

#[inline(always)]
const fn is_normal(exponent: u32) -> bool {
    exponent.wrapping_sub(1) < LARGEST_EXPONENT - 1
}

/// At the top of its bits.
#[inline(always)]
const fn fraction(bits: u64) -> u64 {
    ((bits & FRACTION) | (FRACTION + 1)) << SPARE
}

/// The upper and the lower half of a product of 64 bits by 64.
#[inline(always)]
fn wide_product(a: u64, b: u64) -> [u64; 2] {
    let [a0, a1, b0, b1] = [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32];
    let (low, high) = (full_product(a0, b0), full_product(a1, b1));
    let (one, other) = (full_product(a0, b1), full_product(a1, b0));
    let lower = |whole: u64| u64::from(whole as u32);
    let middle = (low >> 32) + lower(one) + lower(other);
    let high = high + (one >> 32) + (other >> 32) + (middle >> 32);
    [high, (middle << 32) | lower(low)]
}

/// All of a product of 32 bits by 32, from those of their halves.
#[inline(always)]
const fn full_product(a: u32, b: u32) -> u64 {
    let (a0, a1, b0, b1) = (a & 0xFFFF, a >> 16, b & 0xFFFF, b >> 16);
    // Of both that are in the middle, which are one bit more than there is.
    let (middle, carry) = (a0 * b1).overflowing_add(a1 * b0);
    let middle = ((carry as u64) << 48) | ((middle as u64) << 16);
    ((((a1 * b1) as u64) << 32) | (a0 * b0) as u64) + middle
}
