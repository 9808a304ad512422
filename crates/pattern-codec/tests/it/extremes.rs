//! Every function with anything: 0, the largest and smallest numbers, what overflows. The answer is
//! right, against its definition in 128 bits, or an error. What parses bytes and texts has its own
//! tests, and fuzzing.

use pattern_codec::dance::{Data, DataHeader, ProgramMemory, Threshold, Timing};
use pattern_codec::engraving::{
    Axis, AxisCodes, Builder, Fast, JointPulses, PerAxis, Record, Slow, Statistics,
};
use proptest::prelude::*;
use test_support::{any_i32, any_u16, any_u32, any_u64};

use crate::common::{axes, joints, per_axis};

fn any_joint_pulses() -> impl Strategy<Value = JointPulses> {
    [any_i32(), any_i32(), any_i32()].prop_map(|[a, b, c]| joints(a, b, c))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn periods_and_thresholds(tick_us in any_u32(), frame_ticks in any_u32(), threshold in any_u16()) {
        let timing = Timing::new(tick_us, frame_ticks);
        prop_assert_eq!(timing.is_ok(), tick_us > 0 && frame_ticks > 0);
        if let Ok(timing) = timing {
            prop_assert_eq!(timing.frame_us(), u64::from(tick_us) * u64::from(frame_ticks));
        }
        prop_assert_eq!(Threshold::new(threshold).is_ok(), threshold >= 128);
    }

    #[test]
    fn memories(data in any_u64(), code in any_u64(), bytes in any_u64()) {
        let fits = u128::from(data) + u128::from(code) <= u128::from(bytes);
        let fit = ProgramMemory { bytes }.fit(data, code);
        prop_assert_eq!(fit.fits(), fits);
        prop_assert_eq!(fit.to_string().contains(" left"), fits);
    }

    #[test]
    fn records_of_any_motion(axis in axes(), start in any_i32(), pulses in any_i32(), joints in any_joint_pulses()) {
        let fast = Fast::new(axis, pulses);
        prop_assert_eq!(fast.is_ok(), pulses.unsigned_abs() <= 65_535);
        let slow = Slow::new(joints);
        let most = [joints.elbow, joints.shoulder, joints.disc].map(i32::unsigned_abs);
        prop_assert_eq!(slow.is_ok(), most.iter().all(|pulses| *pulses <= 30));
        let mut position = PerAxis::default();
        *position.get_mut(axis) = start;
        let mut builder = Builder::at(position);
        let sum = start.checked_add(pulses);
        match builder.fast(axis, pulses) {
            Ok(records) => {
                prop_assert_eq!(records.size_hint().0, pulses.unsigned_abs().div_ceil(65_535) as usize);
                prop_assert_eq!(Some(*builder.position().get(axis)), sum);
                prop_assert_eq!(records.map(|record| i64::from(*record.pulses().get(axis))).sum::<i64>(), i64::from(pulses));
            }
            Err(_) => {
                prop_assert_eq!(sum, None);
                prop_assert_eq!(builder.position(), position);
            }
        }
        let before = builder;
        match builder.slow(joints) {
            Ok(records) => {
                let count: usize = most.into_iter().max().unwrap().div_ceil(30).try_into().unwrap();
                prop_assert_eq!(records.size_hint(), (count, Some(count)));
                for record in records.take(30) {
                    let Record::Slow(slow) = record else { panic!("a cutting motion is slow") };
                    prop_assert!(Slow::new(slow.pulses()).is_ok());
                }
            }
            Err(_) => prop_assert_eq!(builder, before),
        }
        let home = builder.home(Axis::ALL).unwrap();
        prop_assert!(home.size_hint().0 <= 4 * 32_769);
        prop_assert_eq!(builder, Builder::new());
    }

    #[test]
    fn statistics_do_not_wrap(counts in [any_u64(), any_u64()], pulses in -65_535..=65_535_i32) {
        let mut statistics = Statistics::default();
        [statistics.fast_records, statistics.fast_periods] = counts;
        statistics.add(Fast::new(Axis::Vertical, pulses).unwrap().into());
        let [records, periods] = counts.map(u128::from);
        let most = u128::from(u64::MAX);
        let records = (records + 1).min(most);
        let periods = (periods + u128::from(pulses.unsigned_abs())).min(most);
        prop_assert_eq!(u128::from(statistics.records()), records);
        prop_assert_eq!(u128::from(statistics.bytes()), (3 * records).min(most));
        prop_assert_eq!(u128::from(statistics.fast_periods), periods);
    }

    #[test]
    fn codes_and_names(codes: [u8; 4], name in "[a-zA-Z0-9_ é]{0,40}") {
        let all = AxisCodes::new(per_axis(codes));
        prop_assert_eq!(all.is_ok(), (0..4).all(|code| codes.contains(&code)));
        let mut text = String::new();
        let header = DataHeader { name: &name, ..DataHeader::DEFAULT };
        if header.write([[1_i8, -1]], &mut text).is_ok() {
            let data = Data::<2>::read(&text).unwrap();
            prop_assert_eq!(data.name(), name);
            prop_assert!(data.frames().eq([[1, -1]]));
        }
    }
}
