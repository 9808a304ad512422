//! Builder, splitting, homing and statistics on the public interface.

use pattern_codec::engraving::{Axis, Builder, Format, JointPulses, PerAxis, Record, Statistics};

use crate::common::{joints, per_axis};

const LIFT_FIRST: [Axis; 4] = [Axis::Vertical, Axis::Disc, Axis::Elbow, Axis::Shoulder];

fn pulses(records: impl Iterator<Item = Record>, axis: Axis) -> Vec<i32> {
    records.map(|record| *record.pulses().get(axis)).collect()
}

#[test]
fn a_long_fast_motion_is_full_records_and_the_rest() {
    let mut builder = Builder::new();
    let records = builder.fast(Axis::Shoulder, -150_000).unwrap();
    assert_eq!(records.size_hint(), (3, Some(3)));
    assert_eq!(pulses(records, Axis::Shoulder), [-65_535, -65_535, -18_930]);
    assert_eq!(builder.position().shoulder, -150_000);
    // From the least position to zero, the longest way home.
    let mut builder = Builder::at(PerAxis {
        shoulder: i32::MIN,
        ..PerAxis::default()
    });
    let home = builder.home(LIFT_FIRST).unwrap();
    assert_eq!(home.size_hint().0, 32_769);
    let sum: i64 = pulses(home, Axis::Shoulder)
        .into_iter()
        .map(i64::from)
        .sum();
    assert_eq!(sum, 1 << 31);
}

#[test]
fn a_slow_split_keeps_the_ratio_in_every_part() {
    let mut builder = Builder::new();
    let records = builder.slow(joints(100, -50, 1)).unwrap();
    assert_eq!(records.size_hint(), (4, Some(4)));
    assert_eq!(pulses(records.clone(), Axis::Elbow), [25, 25, 25, 25]);
    assert_eq!(
        pulses(records.clone(), Axis::Shoulder),
        [-13, -12, -13, -12]
    );
    assert_eq!(pulses(records, Axis::Disc), [0, 1, 0, 0]);
}

#[test]
fn motions_without_pulses_have_no_records() {
    let mut builder = Builder::new();
    assert_eq!(builder.fast(Axis::Elbow, 0).unwrap().count(), 0);
    assert_eq!(builder.slow(JointPulses::default()).unwrap().count(), 0);
    assert_eq!(builder.home(LIFT_FIRST).unwrap().count(), 0);
}

#[test]
fn homing_undoes_every_pulse_in_the_given_order() {
    let mut builder = Builder::new();
    let mut all: Vec<_> = builder.fast(Axis::Vertical, -300).unwrap().collect();
    let cut = joints(45, -7, 12);
    all.extend(builder.slow(cut).unwrap());
    let home: Vec<_> = builder.home(LIFT_FIRST).unwrap().collect();
    let moved = home.iter().map(|record| {
        let Record::Fast(fast) = record else {
            panic!("homing is rapid")
        };
        (fast.axis(), fast.pulses())
    });
    assert!(moved.eq([
        (Axis::Vertical, 300),
        (Axis::Disc, -12),
        (Axis::Elbow, -45),
        (Axis::Shoulder, 7),
    ]));
    assert_eq!(builder.position(), PerAxis::default());

    let mut arm = Builder::new();
    for record in all.into_iter().chain(home) {
        arm.track(record).unwrap();
    }
    assert_eq!(arm.position(), PerAxis::default());
}

#[test]
fn a_homing_order_names_every_axis_once() {
    let mut builder = Builder::at(PerAxis {
        elbow: 3,
        ..PerAxis::default()
    });
    let order = [Axis::Vertical, Axis::Disc, Axis::Shoulder, Axis::Disc];
    let error = builder.home(order).unwrap_err();
    assert_eq!(error.to_string(), "disc comes twice in the homing order");
    assert_eq!(builder.position().elbow, 3);
}

#[test]
fn a_position_beyond_32_bits_is_an_error_and_changes_nothing() {
    let start = per_axis([5, i32::MAX - 1, -5, i32::MIN]);
    let mut builder = Builder::at(start);
    let cut = joints(1, 2, 3);
    let error = builder.slow(cut).unwrap_err();
    let numbers = (error.axis, error.position, error.pulses);
    assert_eq!(numbers, (Axis::Shoulder, i32::MAX - 1, 2));
    let error = builder.fast(Axis::Vertical, -1).unwrap_err();
    let numbers = (error.axis, error.position, error.pulses);
    assert_eq!(numbers, (Axis::Vertical, i32::MIN, -1));
    let record = Builder::new().slow(cut).unwrap().next().unwrap();
    assert!(builder.track(record).is_err());
    assert_eq!(builder.position(), start);
}

#[test]
fn statistics_count_records_pulses_and_time() {
    let mut builder = Builder::new();
    let mut records: Vec<_> = builder.fast(Axis::Vertical, -70_000).unwrap().collect();
    let cut = joints(-20, 30, 5);
    records.extend(builder.slow(cut).unwrap());
    records.push(Format::new().decode([0, 0, 0]).unwrap());
    records.push(Format::new().decode([0x1F, 0, 0]).unwrap());
    let statistics: Statistics = records.into_iter().collect();
    assert_eq!(statistics.fast_records, 3);
    assert_eq!(statistics.slow_records, 2);
    assert_eq!(statistics.idle_records, 2);
    assert_eq!((statistics.records(), statistics.bytes()), (5, 15));
    assert_eq!(statistics.pulses, per_axis([20, 30, 5, 70_000]));
    assert_eq!(statistics.fast_periods, 70_000);
    // 5 of the disc, then 30 of the faster arm.
    assert_eq!(statistics.slow_periods, 5 + 30);
}
