//! What several modules use.

use pattern_codec::engraving::{
    Axis, AxisCodes, ByteOrder, Fast, Format, JointPulses, PerAxis, Record, Slow, Strictness,
};
use proptest::prelude::*;

pub(crate) fn joints(elbow: i32, shoulder: i32, disc: i32) -> JointPulses {
    JointPulses {
        elbow,
        shoulder,
        disc,
    }
}

pub(crate) fn per_axis<T>([elbow, shoulder, disc, vertical]: [T; 4]) -> PerAxis<T> {
    PerAxis {
        elbow,
        shoulder,
        disc,
        vertical,
    }
}

pub(crate) fn fast(axis: Axis, pulses: i32) -> Record {
    Fast::new(axis, pulses).unwrap().into()
}

pub(crate) fn slow(elbow: i32, shoulder: i32, disc: i32) -> Record {
    Slow::new(joints(elbow, shoulder, disc)).unwrap().into()
}

pub(crate) fn axes() -> impl Strategy<Value = Axis> {
    prop::sample::select(&Axis::ALL[..])
}

pub(crate) fn formats() -> impl Strategy<Value = Format> {
    let codes = Just([0_u8, 1, 2, 3]).prop_shuffle();
    (codes, any::<bool>(), any::<bool>()).prop_map(|(codes, little, lenient)| {
        let order = [ByteOrder::BigEndian, ByteOrder::LittleEndian][usize::from(little)];
        let strictness = [Strictness::Strict, Strictness::Lenient][usize::from(lenient)];
        Format::new()
            .with_axis_codes(AxisCodes::new(per_axis(codes)).unwrap())
            .with_byte_order(order)
            .with_strictness(strictness)
    })
}

pub(crate) fn joint_pulses(most: i32) -> impl Strategy<Value = JointPulses> {
    let one = move || -most..=most;
    (one(), one(), one()).prop_map(|(elbow, shoulder, disc)| joints(elbow, shoulder, disc))
}

pub(crate) fn records() -> impl Strategy<Value = Record> {
    prop_oneof![
        (axes(), -65_535..=65_535).prop_map(|(axis, pulses)| fast(axis, pulses)),
        joint_pulses(30).prop_map(|pulses| Slow::new(pulses).unwrap().into()),
    ]
}
