//! Segments: their bytes, what is refused, and those that reach across rows.

use proptest::prelude::*;
use pvt_steps::{
    AxisSegments, JoinedSegments, MinIntervals, PvtKnot, Rate, Segment, SegmentError,
    SegmentPlayer, StepDirTiming,
};

use crate::common::{
    arm,
    rows::{STEP, STEP_A_TICK, knot},
};

const LEAST: MinIntervals = MinIntervals {
    step_ticks: 10,
    reversal_ticks: 20,
};

fn encoded(segment: &Segment) -> Vec<u8> {
    segment.encode(&mut [0; Segment::MAX_ENCODED_LEN]).to_vec()
}

/// Ticks after the step before the segment.
fn ticks(segment: &Segment) -> Vec<u64> {
    let mut player = SegmentPlayer::new();
    let mut ticks = player.load(segment);
    let mut all = vec![ticks];
    for interval in player {
        ticks += u64::from(interval);
        all.push(ticks);
    }
    all
}

#[test]
fn bytes_by_hand() {
    // A step of a negative axis after 300 ticks: 300 = 0b10_0101100.
    let bytes = [0b1000_0000, 0b1010_1100, 0b10];
    let (segment, rest) = Segment::decode(&bytes).unwrap();
    assert_eq!((ticks(&segment), rest), (vec![300], [].as_slice()));
    assert_eq!(encoded(&segment), bytes);

    // 70 steps: count - 1 = 69 = 2 · 32 + 5, c = 3. A step every 100 ticks, the first after 50 and
    // half a tick: an interval of 100 · 2^13 = 819,200 = 0b110010_0000000_0000000.
    let bytes = [0b0010_0101, 2, 0x80, 50, 0x80, 0x80, 0b11_0010];
    let (segment, _) = Segment::decode(&bytes).unwrap();
    assert_eq!(
        ticks(&segment),
        (0..70).map(|k| 50 + 100 * k).collect::<Vec<u64>>()
    );
    assert_eq!((segment.count(), segment.span_ticks()), (70, 6900));
    assert_eq!(encoded(&segment), bytes);

    // Four steps, c = 8, interval 10, second difference 4, third -1: -1 · 2^8 is 511 in the order
    // 0, -1, 1, -2, ...
    let mut bytes = vec![0b0110_0011, 0, 0, 5];
    bytes.extend([0x80, 0x14]); // 10 · 2^8 = 20 · 2^7
    bytes.extend([0x80, 0x10]); // 2 · 4 · 2^8 = 16 · 2^7
    bytes.extend([0xFF, 0x03]); // 511 = 3 · 2^7 + 127
    bytes.push(0xAA);
    let (segment, rest) = Segment::decode(&bytes).unwrap();
    // Intervals 10, 14, 17.
    assert_eq!(
        (ticks(&segment), rest),
        (vec![5, 15, 29, 46], [0xAA].as_slice())
    );
    assert_eq!(encoded(&segment), bytes[..10]);
}

#[test]
fn what_is_no_segment_says_why() {
    use SegmentError as E;
    let count = |count, differences| E::Count { count, differences };
    for (bytes, wanted) in [
        (&[][..], E::Truncated { len: 0 }),
        (&[0x25, 2, 0x80], E::Truncated { len: 3 }),
        (&[0, 0x80], E::Truncated { len: 2 }),
        // 0 in two bytes.
        (&[0, 0x80, 0], E::Number { at: 2 }),
        // Two steps without a difference, one with, 1025.
        (&[1, 5], count(2, 0)),
        (&[0x20, 0, 0, 5, 1], count(1, 1)),
        (&[0x20, 32, 0, 5, 1], count(1025, 1)),
        (&[0x20, 255, 0, 5, 1], count(8161, 1)),
        (
            &[0x43, 0, 0, 5, 0x80, 0x14, 0],
            E::ZeroDifference { differences: 2 },
        ),
        // Intervals of 127/128 and 2^31 + 1/128 ticks, and 10, 0.
        (&[0x21, 0, 0, 5, 0x7F], E::Interval { step: 1 }),
        (
            &[0x21, 0, 0, 5, 0x81, 0x80, 0x80, 0x80, 0x80, 8],
            E::Interval { step: 1 },
        ),
        (
            &[0x42, 0, 0, 5, 0x80, 0x14, 0xFF, 0x27],
            E::Interval { step: 2 },
        ),
        // Three steps, 2^31 ticks apart: 2^31 · 2^8 is 2^39.
        (
            &[0x22, 0, 0, 5, 0x80, 0x80, 0x80, 0x80, 0x80, 0x10],
            E::Span { step: 2 },
        ),
    ] {
        assert_eq!(Segment::decode(bytes), Err(wanted), "{bytes:02X?}");
    }
    assert!(Segment::decode(&[0x21, 0, 0, 5, 0x80, 1]).is_ok());
    // A tenth byte with more than the last bit; an eleventh.
    let long = |last| [&[0][..], &[0xFF; 9], &[last]].concat();
    assert_eq!(Segment::decode(&long(2)), Err(E::Number { at: 10 }));
    assert_eq!(Segment::decode(&long(0x81)), Err(E::Truncated { len: 11 }));
    assert!(Segment::decode(&long(1)).is_ok());
    assert_eq!(
        E::Interval { step: 2 }.to_string(),
        "step 2 comes less than 1 or more than 2^31 ticks after the one before it"
    );
}

/// Rows of an accelerating, turning, resting axis.
fn rows() -> Vec<(u32, PvtKnot)> {
    let v = STEP_A_TICK / 100;
    let mut rows: Vec<_> = (1..=40_i64)
        .map(|n| (1000, knot(n * n * STEP / 8, n * v / 40)))
        .collect();
    rows.push((60_000, knot(500 * STEP, 0)));
    rows.extend((1..=40_i64).map(|n| (1000, knot((500 * 8 - n * n) * STEP / 8, -n * v / 40))));
    rows.push((40_000, knot(0, 0)));
    rows
}

#[test]
fn joined_segments_make_the_same_steps_within_two_ticks() {
    let mut axis = AxisSegments::new(knot(0, 0), LEAST);
    let mut joined = JoinedSegments::new(knot(0, 0), LEAST);
    let (mut one, mut other) = (Vec::new(), Vec::new());
    let (mut few, mut many) = (0, 0);
    let mut last = [0, 0];
    let add = |segment: &Segment, made: &mut Vec<_>, last: &mut u64| {
        for ticks in ticks(segment) {
            made.push((*last + ticks, segment.direction()));
        }
        *last = made.last().map_or(0, |step: &(u64, _)| step.0);
    };
    for (ticks, knot) in rows() {
        axis.push(ticks, knot).unwrap();
        joined.push(ticks, knot).unwrap();
        for segment in axis.by_ref() {
            many += 1;
            add(&segment, &mut one, &mut last[0]);
        }
        for segment in joined.by_ref() {
            few += 1;
            add(&segment, &mut other, &mut last[1]);
        }
    }
    joined.finish();
    for segment in joined {
        few += 1;
        add(&segment, &mut other, &mut last[1]);
    }
    assert_eq!(one.len(), 1000);
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(&other) {
        assert!(a.1 == b.1 && a.0.abs_diff(b.0) < 2, "{a:?}, {b:?}");
    }
    assert!(few * 4 < many, "{few} of {many}");
}

#[test]
fn joined_segments_ask_for_rows_one_by_one() {
    let v = STEP_A_TICK / 100;
    let mut joined = JoinedSegments::new(knot(0, v), LEAST);
    joined.push(1000, knot(10 * STEP, v)).unwrap();
    assert!(joined.push(1000, knot(20 * STEP, v)).is_err());
    // All 10 steps wait.
    assert_eq!(joined.next(), None);
    joined.push(1000, knot(20 * STEP, v)).unwrap();
    assert_eq!(joined.next(), None);
    joined.finish();
    let segment = joined.next().unwrap();
    assert_eq!((segment.count(), segment.delay_ticks()), (20, 50));
    assert_eq!(joined.next(), None);
    // After the end it goes on; 1024 steps are a full segment.
    joined.push(110_000, knot(1120 * STEP, v)).unwrap();
    let segment = joined.next().unwrap();
    assert_eq!((segment.count(), segment.delay_ticks()), (1024, 100));
    assert_eq!(joined.next(), None);
    joined.finish();
    assert_eq!(joined.next().map(|segment| segment.count()), Some(76));
}

const fn low_byte(number: u64) -> u8 {
    let [low, ..] = number.to_le_bytes();
    low
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    #[test]
    fn what_decodes_goes_forwards_and_comes_back(
        head in any::<[u8; 3]>(),
        numbers in prop::collection::vec((0..=63_u32, any::<u64>()), 4),
        tail in any::<[u8; 2]>(),
    ) {
        let mut bytes = head.to_vec();
        bytes[1] &= 0x1F;
        for (shift, bits) in numbers {
            let mut number = bits >> shift;
            while number >> 7 > 0 {
                bytes.push(low_byte(number) | 0x80);
                number >>= 7;
            }
            bytes.push(low_byte(number));
        }
        bytes.extend(tail);
        let Ok((segment, rest)) = Segment::decode(&bytes) else {
            return Ok(());
        };
        prop_assert_eq!(encoded(&segment), &bytes[..bytes.len() - rest.len()]);
        let intervals = segment.intervals();
        prop_assert_eq!(intervals.len() + 1, usize::from(segment.count()));
        let mut sum = 0_u64;
        for interval in intervals {
            prop_assert!(interval > 0);
            sum += u64::from(interval);
        }
        prop_assert_eq!(sum, u64::from(segment.span_ticks()));
    }

    #[test]
    fn any_bytes_are_a_segment_or_none(bytes in prop::collection::vec(any::<u8>(), 0..60)) {
        if let Ok((segment, rest)) = Segment::decode(&bytes) {
            prop_assert_eq!(encoded(&segment), &bytes[..bytes.len() - rest.len()]);
        }
    }
}

/// Bytes and steps of both axes for the line at 32,000 steps a turn, by rows of 10 ms.
fn line_of_an_arm(tick_hz: u32) -> (usize, usize) {
    let rows = (arm::END_S / 0.01).ceil();
    let times: Vec<f64> = (1_u32..)
        .map(f64::from)
        .take_while(|row| *row <= rows)
        .map(|row| row * arm::END_S / rows)
        .collect();
    let (start, table) = arm::line(tick_hz, 32_000.0, &times);
    let least = StepDirTiming::DRV8825.min_intervals(Rate::from_hz(tick_hz).unwrap());
    let mut axes = start.map(|knot| JoinedSegments::new(knot, least));
    let (mut bytes, mut steps) = (0, 0);
    let mut take = |axis: &mut JoinedSegments| {
        for segment in axis {
            bytes += encoded(&segment).len();
            steps += usize::from(segment.count());
        }
    };
    for row in table {
        for (axis, knot) in axes.iter_mut().zip(row.knots) {
            axis.push(row.ticks, knot).unwrap();
            take(axis);
        }
    }
    for axis in &mut axes {
        axis.finish();
        take(axis);
    }
    (bytes, steps)
}

/// The goal: 0.3 bytes a step within one tick of 12 MHz.
#[test]
fn a_line_of_an_arm_takes_less_than_a_third_of_a_byte_a_step() {
    for tick_hz in [1_000_000, 12_000_000, 72_000_000, 180_000_000] {
        let (bytes, steps) = line_of_an_arm(tick_hz);
        println!("{tick_hz} Hz: {bytes} bytes for {steps} steps");
        assert!(tick_hz > 12_000_000 || bytes * 10 <= steps * 3);
    }
}
