//! Whole numbers of every size, most of them at an end of one: 0, beside powers of two, the
//! largest.

use proptest::prelude::*;

macro_rules! any_size {
    ($name:ident, $number:ty) => {
        /// Numbers of every size, most of them at an end of one.
        pub fn $name() -> impl Strategy<Value = $number> {
            let off = || (0..=2_u8).prop_map(<$number>::from);
            let near_power =
                (0..<$number>::BITS, off()).prop_map(|(bits, off)| (1 << bits) + off - 1);
            let end = off().prop_map(|off| <$number>::MAX - off);
            let sized =
                (any::<$number>(), 0..<$number>::BITS).prop_map(|(number, bits)| number >> bits);
            prop_oneof![Just(0), near_power, end, sized]
        }
    };
}

any_size!(any_u16, u16);
any_size!(any_u32, u32);
any_size!(any_u64, u64);

/// The same with signs.
pub fn any_i32() -> impl Strategy<Value = i32> {
    prop_oneof![
        any_u32().prop_map(u32::cast_signed),
        any_u32().prop_map(|number| number.cast_signed().wrapping_neg()),
    ]
}
