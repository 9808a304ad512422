//! The angle of a vector, written once for both precisions.

/// Makes `atan2` of one precision from the constants of the module that calls it.
macro_rules! atan2 {
    ($float:ident, $bits:ident) => {
        /// A vector without its signs: its smaller and its larger side, and which of them is y.
        #[derive(Clone, Copy)]
        struct Sides {
            steep: bool,
            small: $float,
            large: $float,
        }

        #[inline(always)]
        fn sides(y: $float, x: $float) -> Sides {
            let (x, y) = (x.abs(), y.abs());
            let steep = is_less(x, y);
            let (small, large) = if steep { (x, y) } else { (y, x) };
            Sides {
                steep,
                small,
                large,
            }
        }

        /// Whether no step of [`angle`] overflows or loses bits to underflow; false for NaN and for
        /// two zeros.
        #[inline(always)]
        fn are_common(small: $float, large: $float) -> bool {
            is_common_large(large) & is_common_small(small)
        }

        /// The leading half of the significand: the product of two such is exact.
        #[inline(always)]
        fn head(x: $float) -> $float {
            $float::from_bits(x.to_bits() & HEAD)
        }

        /// The angle of a vector whose sides are common, with the signs of y and x.
        ///
        /// ```text
        /// a = small, b = large, c = 1/2 if a > b/4, otherwise 0
        /// q = (a - c b) / (b + c a)              |q| <= 1/3, the numerator is exact
        /// atan(a/b) = atan(c) + q + q³ A(q²)
        /// ```
        ///
        /// A quotient that is rounded once would cost up to a whole unit of the last place. So it
        /// is made of its leading half, and what that leaves of the exact division. The octant is
        /// a multiple of π/2 and a sign, which goes into a and c.
        #[inline(always)]
        fn angle(
            y: $float,
            x: $float,
            Sides {
                steep,
                small,
                large,
            }: Sides,
        ) -> $float {
            const SIGN: $bits = 1 << ($bits::BITS - 1);
            // The difference of two sizes' bits is negative where the second is larger.
            let steep_bits = x.abs().to_bits().wrapping_sub(y.abs().to_bits());
            let sign = (x.to_bits() ^ steep_bits) & SIGN;
            let with_sign = |v: $float| $float::from_bits(v.to_bits() ^ sign);
            let a = with_sign(small);
            let c = with_sign(if is_less(0.25 * large, small) {
                0.5
            } else {
                0.0
            });

            let numerator = a - c * large;
            let ca = c * a;
            let denominator = large + ca;
            let reciprocal = 1.0 / denominator;
            let q = numerator * reciprocal;
            let q_head = head(q);
            let d_head = head(denominator);
            let d_tail = (large - d_head) + ca;
            let rest = (numerator - q_head * d_head) - q_head * d_tail;
            let z = q * q;
            let tail = q * (z * arctan_polynomial(z)) + rest * reciprocal;

            let base = if steep {
                HALF_PI
            } else if x.is_sign_negative() {
                2.0 * HALF_PI
            } else {
                0.0
            };
            let center = base + c * TWICE_ATAN_HALF;
            let center_tail = base * HALF_PI_TAIL + c * TWICE_ATAN_HALF_TAIL;
            // With what the sum's rounding cuts off.
            let sum = center + q_head;
            let cut = (center - sum) + q_head;
            let size = sum + (cut + (tail + center_tail));
            $float::from_bits(size.to_bits() ^ (y.to_bits() & SIGN))
        }

        #[inline]
        pub(crate) fn atan2(y: $float, x: $float) -> $float {
            let Sides {
                steep,
                small,
                large,
            } = sides(y, x);
            let (small, large) = if are_common(small, large) {
                (small, large)
            } else {
                made_common(small, large)
            };
            angle(
                y,
                x,
                Sides {
                    steep,
                    small,
                    large,
                },
            )
        }

        #[inline]
        pub(crate) fn atan2_lanes<const L: usize>(y: [$float; L], x: [$float; L]) -> [$float; L] {
            let mut result = [0.0; L];
            let common = y.iter().zip(x).map(|(&y, x)| {
                let Sides { small, large, .. } = sides(y, x);
                are_common(small, large)
            });
            let lanes = result.iter_mut().zip(y).zip(x);
            if common.fold(true, |all, one| all & one) {
                for ((result, y), x) in lanes {
                    *result = angle(y, x, sides(y, x));
                }
            } else {
                for ((result, y), x) in lanes {
                    *result = self::atan2(y, x);
                }
            }
            result
        }

        /// Common sides of the same angle; NaN if one of them is.
        ///
        /// Out of line: zeros, infinities, NaN, and lengths that no machine has.
        #[cold]
        #[inline(never)]
        fn made_common(small: $float, large: $float) -> ($float, $float) {
            let quotient = small / large;
            if small.is_nan() || large.is_nan() {
                ($float::NAN, $float::NAN)
            } else if large == 0.0 {
                (0.0, 1.0)
            } else if small.is_infinite() {
                (1.0, 1.0)
            } else if quotient < TINY_QUOTIENT {
                // Its arc tangent is itself, and none of it is lost when it is divided by 1.
                (quotient, 1.0)
            } else {
                let [down, up] = SCALES;
                let scale = if large > 1.0 { down } else { up };
                (small * scale, large * scale)
            }
        }
    };
}

pub(crate) use atan2;
