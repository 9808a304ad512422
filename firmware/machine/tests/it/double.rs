//! The product of two doubles, bit for bit that of this machine.

use board_machine::product;

/// Numbers by Marsaglia's xorshift: all bits random, or of digits so few that halves of the last
/// place are met.
struct Numbers(u64);

impl Numbers {
    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn next(&mut self) -> f64 {
        let bits = self.bits();
        let (digits, kept) = (self.bits(), self.bits() % 52);
        let few = digits & !(u64::MAX >> (12 + kept)) | 1023 << 52;
        f64::from_bits(match bits % 4 {
            0 => bits >> 1 | digits << 63,
            // Sizes of places and times.
            1 => digits >> 12 | (1013 + bits / 4 % 20) << 52,
            2 => few & u64::MAX >> 12 | (bits / 4 % 2047) << 52,
            _ => few & u64::MAX >> 12 | (1013 + bits / 4 % 20) << 52,
        })
    }
}

#[test]
fn a_product_has_the_bits_of_ieee_754() {
    const PRODUCTS: u32 = 3_000_000;
    let mut numbers = Numbers(1);
    let mut others = 0;
    for _ in 0..PRODUCTS {
        let (a, b) = (numbers.next(), numbers.next());
        let mut is_other = false;
        let found = product(a, b, |a, b| {
            is_other = true;
            a * b
        });
        let is_same = found.to_bits() == (a * b).to_bits() || found.is_nan() && (a * b).is_nan();
        assert!(is_same, "{a:e} times {b:e}: {found:e}");
        if is_other {
            others += 1;
            // Next to the smallest, rounding may make a normal one.
            let size = (a * b).abs();
            let are_normal = a.is_normal() && b.is_normal() && size > f64::MIN_POSITIVE;
            assert!(!are_normal || size.is_infinite(), "{a:e} times {b:e}");
        }
    }
    assert!(others > PRODUCTS / 100 && others < PRODUCTS / 2, "{others}");
}

#[test]
fn edges_of_a_product() {
    let numbers = [
        0.0,
        f64::MIN_POSITIVE,
        f64::from_bits(1),
        f64::MIN_POSITIVE * (1.0 - f64::EPSILON),
        1.0 - f64::EPSILON / 2.0,
        1.0,
        1.0 + f64::EPSILON,
        1.5,
        2.0_f64.sqrt(),
        4.0 - f64::EPSILON * 2.0,
        f64::MAX,
        f64::MAX / 2.0,
        f64::MIN_POSITIVE.sqrt(),
        f64::MAX.sqrt(),
        f64::INFINITY,
        f64::NAN,
    ];
    for a in numbers {
        for b in numbers {
            for (a, b) in [(a, b), (-a, b), (a, -b), (-a, -b)] {
                let (found, exact) = (product(a, b, |a, b| a * b), a * b);
                let is_same =
                    found.to_bits() == exact.to_bits() || found.is_nan() && exact.is_nan();
                assert!(is_same, "{a:e} times {b:e}: {found:e}");
            }
        }
    }
}
