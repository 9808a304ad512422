//! Sine and cosine of any angle, written once for both precisions.

/// Makes `sin_cos` of one precision from the constants of the module that calls it.
macro_rules! sin_cos {
    ($float:ident, $bits:ident) => {
        /// An angle less whole quarter turns: `x = quarters · π/2 + angle - excess`
        /// with `angle` at most a little above π/4 either way and `excess` about its last place.
        #[derive(Clone, Copy)]
        struct Reduced {
            /// Whole quarter turns modulo four, in the two lowest bits.
            quarters: $bits,
            angle: $float,
            excess: $float,
        }

        /// Whether [`reduce`] is exact enough for `x`; false for NaN.
        #[inline(always)]
        fn is_common_angle(x: $float) -> bool {
            x.abs() <= COMMON_ANGLE
        }

        /// Reduction by Cody and Waite: subtracts n · π/2 in four parts, the first two without any
        /// rounding, the third with its rounding error kept.
        #[inline(always)]
        fn reduce(x: $float) -> Reduced {
            // The sum's lowest bits are the nearest whole number, in two's complement.
            let shifted = x * core::$float::consts::FRAC_2_PI + SHIFT;
            let n = shifted - SHIFT;
            let exact = (x - n * QUARTER[0]) - n * QUARTER[1];
            let third = n * QUARTER[2];
            let angle = exact - third;
            Reduced {
                quarters: shifted.to_bits(),
                angle,
                excess: ((angle - exact) + third) + n * QUARTER[3],
            }
        }

        /// Sine and cosine of a reduced angle.
        ///
        /// ```text
        /// sin(t - e) ≈ t - (e (1 - t²/2) - t³ S(t²))
        /// cos(t - e) ≈ 1 - t²/2 + (t⁴ C(t²) + t e)
        /// ```
        #[inline(always)]
        fn evaluate(reduced: Reduced) -> ($float, $float) {
            let Reduced {
                quarters,
                angle,
                excess,
            } = reduced;
            let z = angle * angle;
            let half = 0.5 * z;
            let near = 1.0 - half;
            // The difference keeps the sign of a zero, as the sum would not.
            let sin = angle - (excess * near - (angle * z) * sine_polynomial(z));
            // What `near` lost when it was rounded is added again.
            let cos =
                near + (((1.0 - near) - half) + ((z * z) * cosine_polynomial(z) + angle * excess));
            turn(sin, cos, quarters)
        }

        /// Adds whole quarter turns: an exchange and two signs, by bits, for lanes without
        /// branches.
        #[inline(always)]
        fn turn(sin: $float, cos: $float, quarters: $bits) -> ($float, $float) {
            if !HAS_VECTORS {
                return turn_alone(sin, cos, quarters);
            }
            const TO_SIGN: u32 = $bits::BITS - 2;
            let exchange = (quarters & 1).wrapping_neg();
            let (sin, cos) = (sin.to_bits(), cos.to_bits());
            let difference = (sin ^ cos) & exchange;
            let sin_sign = (quarters & 2) << TO_SIGN;
            let cos_sign = (quarters.wrapping_add(1) & 2) << TO_SIGN;
            (
                $float::from_bits(sin ^ difference ^ sin_sign),
                $float::from_bits(cos ^ difference ^ cos_sign),
            )
        }

        /// The same for processors that skip single instructions.
        #[inline(always)]
        fn turn_alone(sin: $float, cos: $float, quarters: $bits) -> ($float, $float) {
            let (sin, cos) = if quarters & 1 == 0 {
                (sin, cos)
            } else {
                (cos, sin)
            };
            let with_sign = |x: $float, turns: $bits| if turns & 2 == 0 { x } else { -x };
            (
                with_sign(sin, quarters),
                with_sign(cos, quarters.wrapping_add(1)),
            )
        }

        #[inline]
        pub(crate) fn sin_cos(x: $float) -> ($float, $float) {
            if HAS_VECTORS {
                evaluate(any_reduced(x))
            } else {
                sin_cos_alone(x)
            }
        }

        /// One copy of it: memory is dear where there are no vectors, and next to vectors it is
        /// rare.
        #[inline(never)]
        fn sin_cos_alone(x: $float) -> ($float, $float) {
            evaluate(any_reduced(x))
        }

        #[inline(always)]
        fn any_reduced(x: $float) -> Reduced {
            if is_common_angle(x) {
                reduce(x)
            } else {
                reduce_large(x)
            }
        }

        #[inline]
        pub(crate) fn sin_cos_lanes<const L: usize>(x: [$float; L]) -> ([$float; L], [$float; L]) {
            let (mut sin, mut cos) = ([0.0; L], [0.0; L]);
            let lanes = sin.iter_mut().zip(&mut cos).zip(x);
            if HAS_VECTORS && x.iter().fold(true, |all, &x| all & is_common_angle(x)) {
                for ((sin, cos), x) in lanes {
                    (*sin, *cos) = evaluate(reduce(x));
                }
            } else {
                for ((sin, cos), x) in lanes {
                    (*sin, *cos) = sin_cos_alone(x);
                }
            }
            (sin, cos)
        }
    };
}

pub(crate) use sin_cos;
