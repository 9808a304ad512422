//! Reduction of angles of any size by π/2 in integers, written once for both precisions.

/// Makes `reduce_large` of one precision from the constants of the module that calls it: words as
/// wide as the float, products twice as wide.
macro_rules! reduce_large {
    ($float:ident, $word:ident, $double:ident, $signed:ident) => {
        const BIAS: i32 = $float::MAX_EXP - 1;

        /// Reduction by Payne and Hanek, for |x| >= 1: of 2/π only those bits are multiplied that
        /// neither make whole turns nor are too small to matter. NaN for what is not finite.
        ///
        /// Out of line: few machines turn so far.
        #[cold]
        #[inline(never)]
        fn reduce_large(x: $float) -> Reduced {
            if !x.is_finite() {
                return Reduced {
                    quarters: 0,
                    angle: $float::NAN,
                    excess: 0.0,
                };
            }
            let (quarters, rest) = quarter_turns(x.abs());
            let (angle, tail) = radians(rest);
            if x.is_sign_negative() {
                Reduced {
                    quarters: quarters.wrapping_neg(),
                    angle: -angle,
                    excess: tail,
                }
            } else {
                Reduced {
                    quarters,
                    angle,
                    excess: -tail,
                }
            }
        }

        /// x · 2/π to the nearest whole number modulo four, and the rest as a fraction of the word
        /// pair's range.
        ///
        /// Three words of 2/π leave, after the closest that any float comes to a multiple of π/2,
        /// more bits than a word holds.
        #[expect(
            clippy::indexing_slicing,
            reason = "the largest exponent needs the last word"
        )]
        fn quarter_turns(x: $float) -> ($word, $signed) {
            const BITS: u32 = $word::BITS;
            const FRACTION: u32 = $float::MANTISSA_DIGITS - 1;
            const BEFORE_FIRST_BIT: usize = (BIAS as u32 + FRACTION + 2 - BITS) as usize;
            let wide = |word: $word| $double::from(word);

            // x = significand · 2^(exponent - BIAS - FRACTION), and the bits of 2/π before `place`
            // make multiples of four quarter turns. A word of zeros stands before them.
            let significand = (x.to_bits() & ((1 << FRACTION) - 1)) | 1 << FRACTION;
            let place = ((x.to_bits() >> FRACTION) as usize).saturating_sub(BEFORE_FIRST_BIT);
            let (index, shift) = (place / BITS as usize, place % BITS as usize);
            // The remainder never differs, and shows the compiler that no index is too large.
            let at = |number: usize| wide(TWO_OVER_PI[(index + number) % TWO_OVER_PI.len()]);
            let word =
                |number: usize| ((at(number) << BITS | at(number + 1)) << shift >> BITS) as $word;

            // Two bits before the point.
            let product = (wide(significand.wrapping_mul(word(0))) << BITS)
                .wrapping_add(wide(significand) * wide(word(1)))
                .wrapping_add((wide(significand) * wide(word(2))) >> BITS);
            let half = 1 << (2 * BITS - 3);
            let quarters = (product.wrapping_add(half) >> (2 * BITS - 2)) as $word;
            (quarters, (product << 2).cast_signed())
        }

        /// A fraction of a quarter turn as an angle: its highest bits, and the next.
        #[expect(
            clippy::cast_precision_loss,
            clippy::cast_possible_wrap,
            reason = "the first has no more bits than the float, the second need not be exact"
        )]
        fn radians(rest: $signed) -> ($float, $float) {
            const BITS: u32 = $word::BITS;
            const BELOW: $word = (1 << (BITS - $float::MANTISSA_DIGITS)) - 1;
            let size = rest.unsigned_abs();
            let zeros = size.leading_zeros();
            let angle = $double::from((size.wrapping_shl(zeros) >> BITS) as $word)
                * $double::from(HALF_PI_WORD);
            let high = (angle >> BITS) as $word & !BELOW;
            let low = angle - ($double::from(high) << BITS);
            let unit = power_of_two(1 - zeros as i32 - 2 * BITS as i32);
            let unit = if rest < 0 { -unit } else { unit };
            let high = high as $float * power_of_two(BITS as i32);
            (high * unit, low as $float * unit)
        }

        /// 2 to a power that gives a normal number.
        #[expect(clippy::cast_sign_loss, reason = "not below the least exponent")]
        const fn power_of_two(exponent: i32) -> $float {
            $float::from_bits(((BIAS + exponent) as $word) << ($float::MANTISSA_DIGITS - 1))
        }
    };
}

pub(crate) use reduce_large;
