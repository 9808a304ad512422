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

        /// A word whose highest bit says whether y is larger: the difference of the sizes' bits.
        #[inline(always)]
        fn steep_bits(y: $float, x: $float) -> $bits {
            x.abs().to_bits().wrapping_sub(y.abs().to_bits())
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

        const SIGN: $bits = 1 << ($bits::BITS - 1);

        /// The vector, turned by a multiple of π/2 and mirrored so that its angle is small.
        ///
        /// ```text
        /// a = ±small, b = large, c = ±1/2 if small > b/4, otherwise 0
        /// angle of the vector = center + atan(numerator / (large + addend))
        /// ```
        #[derive(Clone, Copy)]
        struct Folded {
            /// a - c b, which is exact.
            numerator: $float,
            large: $float,
            /// c a
            addend: $float,
            /// The multiple of π/2 and atan c: rounded, and what the rounding cut off.
            center: [$float; 2],
        }

        /// By selects and multiplications, as vectors do it.
        #[inline(always)]
        fn fold_in_lanes(y: $float, x: $float, sides: Sides) -> Folded {
            let Sides {
                steep,
                small,
                large,
            } = sides;
            let sign = (x.to_bits() ^ steep_bits(y, x)) & SIGN;
            let with_sign = |v: $float| $float::from_bits(v.to_bits() ^ sign);
            let a = with_sign(small);
            let c = with_sign(if is_less(0.25 * large, small) {
                0.5
            } else {
                0.0
            });
            Folded {
                numerator: a - c * large,
                large,
                addend: c * a,
                center: center(steep, x.is_sign_negative(), c),
            }
        }

        #[inline(always)]
        const fn center(steep: bool, is_x_negative: bool, c: $float) -> [$float; 2] {
            let base = if steep {
                HALF_PI
            } else if is_x_negative {
                2.0 * HALF_PI
            } else {
                0.0
            };
            [
                base + c * TWICE_ATAN_HALF,
                base * HALF_PI_TAIL + c * TWICE_ATAN_HALF_TAIL,
            ]
        }

        /// [`center`] by the sign of x, whether the vector is steep, and whether c is not 0.
        static CENTERS: [[$float; 2]; 8] = [
            center(false, false, 0.0),
            center(false, true, 0.0),
            center(true, false, 0.0),
            center(true, true, 0.0),
            center(false, false, 0.5),
            center(false, true, -0.5),
            center(true, false, -0.5),
            center(true, true, 0.5),
        ];

        /// The same by a branch and a table, without the multiplications.
        #[inline(always)]
        fn fold_alone(y: $float, x: $float, small: $float, large: $float) -> Folded {
            const ONE_POWER: $bits = 1 << ($float::MANTISSA_DIGITS - 1);
            const TO_LOWEST: u32 = $bits::BITS - 1;
            let part = |v: $float, powers| $float::from_bits(v.to_bits().wrapping_sub(powers));
            let (size, addend, row) = if is_less(part(large, 2 * ONE_POWER), small) {
                let half = part(large, ONE_POWER);
                (small - half, part(small, ONE_POWER), 4)
            } else {
                (small, 0.0, 0)
            };
            let (x, steep) = (x.to_bits(), steep_bits(y, x));
            let index = (steep >> TO_LOWEST) as usize * 2 + (x >> TO_LOWEST) as usize + row;
            Folded {
                numerator: $float::from_bits(size.to_bits() ^ ((x ^ steep) & SIGN)),
                large,
                addend,
                // The remainder never differs, and shows the compiler that the index is not too
                // large.
                center: CENTERS
                    .get(index % CENTERS.len())
                    .copied()
                    .unwrap_or_default(),
            }
        }

        /// The angle of a folded vector, with the sign of y.
        ///
        /// ```text
        /// q = numerator / (large + addend)              |q| <= 1/3
        /// atan q = q + q³ A(q²)
        /// ```
        ///
        /// A quotient that is rounded once would cost up to a whole unit of the last place. So it
        /// is made of its leading half, and what that leaves of the exact division.
        #[inline(always)]
        fn angle(y: $float, folded: Folded) -> $float {
            let Folded {
                numerator,
                large,
                addend,
                center: [center, center_tail],
            } = folded;
            let denominator = large + addend;
            let reciprocal = 1.0 / denominator;
            let q = numerator * reciprocal;
            let q_head = head(q);
            let d_head = head(denominator);
            let d_tail = (large - d_head) + addend;
            let rest = (numerator - q_head * d_head) - q_head * d_tail;
            let z = q * q;
            let tail = q * (z * arctan_polynomial(z)) + rest * reciprocal;

            // With what the sum's rounding cuts off.
            let sum = center + q_head;
            let cut = (center - sum) + q_head;
            let size = sum + (cut + (tail + center_tail));
            $float::from_bits(size.to_bits() ^ (y.to_bits() & SIGN))
        }

        #[inline]
        pub(crate) fn atan2(y: $float, x: $float) -> $float {
            if HAS_VECTORS {
                angle(y, fold_in_lanes(y, x, any_sides(y, x)))
            } else {
                atan2_alone(y, x)
            }
        }

        /// One copy of it: memory is dear where there are no vectors, and next to vectors it is
        /// rare.
        #[inline(never)]
        fn atan2_alone(y: $float, x: $float) -> $float {
            let Sides { small, large, .. } = sides(y, x);
            if are_common(small, large) {
                angle(y, fold_alone(y, x, small, large))
            } else {
                rare_atan2(y, x)
            }
        }

        /// That of a common vector of the same angle.
        #[cold]
        #[inline(never)]
        fn rare_atan2(y: $float, x: $float) -> $float {
            let found = sides(y, x);
            let (small, large) = made_common(found.small, found.large);
            if small.is_nan() {
                return small;
            }
            let is_tiny = large.to_bits() == $float::to_bits(1.0) && small < TINY_QUOTIENT;
            if is_tiny && !found.steep && !x.is_sign_negative() {
                return small.copysign(y);
            }
            let small = if is_tiny { 0.0 } else { small };
            let (y_size, x_size) = if found.steep {
                (large, small)
            } else {
                (small, large)
            };
            atan2_alone(y_size.copysign(y), x_size.copysign(x))
        }

        #[inline(always)]
        fn any_sides(y: $float, x: $float) -> Sides {
            let found = sides(y, x);
            if are_common(found.small, found.large) {
                return found;
            }
            let (small, large) = made_common(found.small, found.large);
            Sides {
                small,
                large,
                ..found
            }
        }

        #[inline]
        pub(crate) fn atan2_lanes<const L: usize>(y: [$float; L], x: [$float; L]) -> [$float; L] {
            let mut result = [0.0; L];
            let common = y.iter().zip(x).map(|(&y, x)| {
                let Sides { small, large, .. } = sides(y, x);
                are_common(small, large)
            });
            let are_common = HAS_VECTORS && common.fold(true, |all, one| all & one);
            let lanes = result.iter_mut().zip(y).zip(x);
            if are_common {
                for ((result, y), x) in lanes {
                    *result = angle(y, fold_in_lanes(y, x, sides(y, x)));
                }
            } else {
                for ((result, y), x) in lanes {
                    *result = atan2_alone(y, x);
                }
            }
            result
        }

        #[cfg(test)]
        #[test]
        fn both_ways_to_fold_are_one() {
            let mut state: $bits = 0x0139_408D;
            for round in 0..300_000 {
                let [y, x] = [(); 2].map(|()| {
                    state = (state.rotate_left(5) ^ 0x9E37_79B9).wrapping_mul(0x85EB_CA6B);
                    let fraction = state >> ($bits::BITS + 1 - $float::MANTISSA_DIGITS);
                    let in_one_two = $float::from_bits($float::to_bits(1.0) | fraction);
                    if round % 2 == 0 {
                        $float::from_bits(state)
                    } else {
                        ((in_one_two - 1.5) * 3000.0).round() / 8.0
                    }
                });
                let alone = atan2_alone(y, x);
                let in_lanes = angle(y, fold_in_lanes(y, x, any_sides(y, x)));
                assert!(
                    alone.to_bits() == in_lanes.to_bits() || (alone.is_nan() && in_lanes.is_nan()),
                    "{y:e} {x:e}: {alone:e} {in_lanes:e}"
                );
            }
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
