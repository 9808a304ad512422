//! What the kernels make of many numbers, as one number each: to compare targets. Without `std`, so
//! that a firmware can include it.

use trig_kernels::{
    atan2, atan2_lanes, atan2_of_length, atan2_of_length_lanes, sin_cos, sin_cos_lanes, sqrt,
};

/// Fowler, Noll and Vo's hash, 64 bits.
#[derive(Clone, Copy)]
struct Hash(u64);

impl Hash {
    fn add(&mut self, bits: u64) {
        self.0 = (self.0 ^ bits).wrapping_mul(0x0100_0000_01B3);
    }

    /// All NaN count as one: neither sign nor payload is promised.
    fn add_f32(&mut self, x: f32) {
        self.add(if x.is_nan() { 1 } else { x.to_bits().into() });
    }

    fn add_f64(&mut self, x: f64) {
        self.add(if x.is_nan() { 1 } else { x.to_bits() });
    }
}

/// Hashes of `sin_cos`, `atan2` and lanes of both, in f32 and in f64: of any bits, and of lengths
/// and angles as machines have them.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "numbers that look random are made of some of the bits"
)]
pub(crate) fn hashes() -> [u64; 2] {
    let (mut single, mut double) = (Hash(0xCBF2_9CE4_8422_2325), Hash(0xCBF2_9CE4_8422_2325));
    let mut state = 0x0139_408D_CBBF_7A44_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    for round in 0..3000 {
        let [a, b] = [next(), next()];
        let any = |bits: u64| (f64::from_bits(bits), f32::from_bits((bits >> 32) as u32));
        let length = |bits: u64| {
            let x = (bits >> 40) as f32 / 32_768.0 - 256.0;
            (f64::from(x) + f64::from(bits as u32) * 1e-15, x)
        };
        let ((x, x_single), (y, y_single)) = if round % 2 == 0 {
            (any(a), any(b))
        } else {
            (length(a), length(b))
        };

        let (sin, cos) = sin_cos(x);
        let (sines, _) = sin_cos_lanes([x, y, -x]);
        let angles = atan2_lanes([y, x, y], [x, y, -x]);
        let all = [[sin, cos, atan2(y, x)], sines, angles];
        all.as_flattened().iter().for_each(|&x| double.add_f64(x));
        let per = sqrt(x * x + y * y).recip();
        double.add_f64(atan2_of_length(y, x, per));
        let lanes = atan2_of_length_lanes([y, x, -y], [x, -y, y], [per, per, x]);
        lanes.iter().for_each(|&x| double.add_f64(x));

        let (x, y) = (x_single, y_single);
        let (sin, cos) = sin_cos(x);
        let (sines, _) = sin_cos_lanes([x, y, -x]);
        let angles = atan2_lanes([y, x, y], [x, y, -x]);
        let all = [[sin, cos, atan2(y, x)], sines, angles];
        all.as_flattened().iter().for_each(|&x| single.add_f32(x));
        let per = sqrt(x * x + y * y).recip();
        single.add_f32(atan2_of_length(y, x, per));
        let lanes = atan2_of_length_lanes([y, x, -y], [x, -y, y], [per, per, x]);
        lanes.iter().for_each(|&x| single.add_f32(x));
    }
    [single.0, double.0]
}
