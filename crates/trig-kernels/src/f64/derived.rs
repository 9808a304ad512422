//! Written by `derive/derive.py`, which says how. Do not edit.

#![expect(clippy::approx_constant, reason = "cut off where sums are exact")]
/// S of `sin t = t + t³ S(t²)`, off by at most 2^-57.88 of it for
/// arguments up to 0.7854.
pub(super) const SINE: [f64; 6] = [
    -0.1666666666666663,
    0.008333333333321922,
    -0.0001984126982946314,
    2.755731358434956e-6,
    -2.5050742706964374e-8,
    1.5895968926533212e-10,
];
/// C of `cos t = 1 - t²/2 + t⁴ C(t²)`, off by at most 2^-63.93 of it for
/// arguments up to 0.7854.
pub(super) const COSINE: [f64; 6] = [
    0.041666666666666595,
    -0.001388888888887335,
    2.4801587289010143e-5,
    -2.7557314219757646e-7,
    2.0875705792317384e-9,
    -1.135877040247406e-11,
];
/// A of `atan q = q + q³ A(q²)`, off by at most 2^-55.74 of it for
/// arguments up to 0.33333.
pub(super) const ARCTAN: [f64; 9] = [
    -0.3333333333333143,
    0.1999999999930708,
    -0.14285714198829413,
    0.1111110575821953,
    -0.09090721908639396,
    0.07688332863900002,
    -0.06614161301599135,
    0.05456185064324048,
    -0.03257495242362821,
];
/// A of `atan t = t + t³ A(t²)`, off by at most 2^-54.66 of it for
/// arguments up to 0.41421.
pub(super) const HALF_ARCTAN: [f64; 10] = [
    -0.3333333333333015,
    0.19999999999088947,
    -0.14285714195260782,
    0.11111106653571524,
    -0.09090782412189023,
    0.07690068297353399,
    -0.06641121165706218,
    0.05692538850257109,
    -0.0435909480574319,
    0.021259838302943472,
];

/// 2^26 quarter turns: up to here the products of [`QUARTER`] are exact.
pub(super) const COMMON_ANGLE: f64 = 105414357.06657825;
/// π/2 in four parts; the products of the first three with 2^26 are exact.
pub(super) const QUARTER: [f64; 4] = [
    1.570796251296997,       // 6588397 · 2^-22
    7.549789948768648e-8,    // 42501539 · 2^-49
    6.123234014771656e-17,   // 74025357 · 2^-80
    -1.9034889620193266e-25, // the rest
];
/// π/2 to a multiple of 2^-51, so that sums with [`TWICE_ATAN_HALF`] are exact.
pub(super) const HALF_PI: f64 = 1.5707963267948966;
/// What [`HALF_PI`] lacks, as a part of it.
pub(super) const HALF_PI_TAIL: f64 = 3.8981718325193755e-17;
/// 2 atan 1/2, its half a multiple of 2^-51.
pub(super) const TWICE_ATAN_HALF: f64 = 0.9272952180016123;
/// What [`TWICE_ATAN_HALF`] lacks.
pub(super) const TWICE_ATAN_HALF_TAIL: f64 = -6.562474755659228e-17;

/// π/2 · 2^63
pub(super) const HALF_PI_WORD: u64 = 0xC90F_DAA2_2168_C235;
/// The bits of 2/π after a word of zeros.
pub(super) const TWO_OVER_PI: [u64; 20] = [
    0,
    0xA2F9_836E_4E44_1529,
    0xFC27_57D1_F534_DDC0,
    0xDB62_9599_3C43_9041,
    0xFE51_63AB_DEBB_C561,
    0xB724_6E3A_424D_D2E0,
    0x0649_2EEA_09D1_921C,
    0xFE1D_EB1C_B129_A73E,
    0xE882_35F5_2EBB_4484,
    0xE99C_7026_B45F_7E41,
    0x3991_D639_8353_39F4,
    0x9C84_5F8B_BDF9_283B,
    0x1FF8_97FF_DE05_980F,
    0xEF2F_118B_5A0A_6D1F,
    0x6D36_7ECF_27CB_09B7,
    0x4F46_3F66_9E5F_EA2D,
    0x7527_BAC7_EBE5_F17B,
    0x3D07_39F7_8A52_92EA,
    0x6BFB_5FB1_1F8D_5D08,
    0x5603_3046_FC7B_6BAB,
];
