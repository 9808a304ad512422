//! The angle of a vector whose length is known, by its half: without the exact remainder and the
//! folds that [`atan2`](crate::atan2) needs.

/// Makes `atan2_of_length` of one precision from what the module that calls it has.
macro_rules! known_length {
    ($float:ident, $bits:ident) => {
        /// A vector by its length, its second side without sign.
        #[derive(Clone, Copy)]
        struct Unit {
            /// y/N
            sine: $float,
            /// |x|/N
            cosine: $float,
            /// (1 + sine² + cosine²)/2
            length: $float,
        }

        #[inline(always)]
        fn unit(y: $float, x: $float, inverse_length: $float) -> Unit {
            let sine = y * inverse_length;
            let cosine = (x * inverse_length).abs();
            Unit {
                sine,
                cosine,
                length: 0.5 + 0.5 * (sine * sine + cosine * cosine),
            }
        }

        /// Whether the length is what was said: what is left out is then below rounding. Not if it
        /// is not a number.
        #[inline(always)]
        fn is_known(length: $float) -> bool {
            let [min, max] = [1.0 - KNOWN, 1.0 + KNOWN];
            length.to_bits().wrapping_sub($float::to_bits(min))
                <= $float::to_bits(max) - $float::to_bits(min)
        }

        /// With the sign of y.
        #[inline(always)]
        fn angle_of_unit(y: $float, x: $float, unit: Unit) -> $float {
            let size = size_of_angle(unit, x.is_sign_negative());
            $float::from_bits(size.to_bits() | (y.to_bits() & SIGN))
        }

        #[inline]
        pub(crate) fn atan2_of_length(y: $float, x: $float, inverse_length: $float) -> $float {
            if HAS_VECTORS {
                let unit = unit(y, x, inverse_length);
                if is_known(unit.length) {
                    angle_of_unit(y, x, unit)
                } else {
                    atan2_alone(y, x)
                }
            } else {
                of_length_alone(y, x, inverse_length)
            }
        }

        /// One copy of it: memory is dear where there are no vectors, and next to vectors it is
        /// rare.
        #[inline(never)]
        fn of_length_alone(y: $float, x: $float, inverse_length: $float) -> $float {
            let unit = unit(y, x, inverse_length);
            if is_known(unit.length) {
                angle_of_unit(y, x, unit)
            } else {
                atan2_alone(y, x)
            }
        }

        #[inline]
        pub(crate) fn atan2_of_length_lanes<const L: usize>(
            y: [$float; L],
            x: [$float; L],
            inverse_length: [$float; L],
        ) -> [$float; L] {
            let mut result = [0.0; L];
            let lanes = y.iter().zip(x).zip(inverse_length);
            let known = lanes.map(|((&y, x), inverse)| is_known(unit(y, x, inverse).length));
            let are_known = HAS_VECTORS && known.fold(true, |all, one| all & one);
            let lanes = result.iter_mut().zip(y).zip(x).zip(inverse_length);
            if are_known {
                for (((result, y), x), inverse) in lanes {
                    *result = angle_of_unit(y, x, unit(y, x, inverse));
                }
            } else {
                for (((result, y), x), inverse) in lanes {
                    *result = of_length_alone(y, x, inverse);
                }
            }
            result
        }
    };
}

pub(crate) use known_length;
