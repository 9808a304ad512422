//! Rows as bytes: what comes back, what is refused, and how many bytes a step they take.
#![expect(clippy::cast_precision_loss, reason = "compared within a stated bound")]

use proptest::prelude::*;
use pvt_steps::{
    AxisSegments, PvtKnot, PvtRow, Rate, RowBits, RowBytesError, RowCodec, StepDirTiming,
};

use crate::common::arm;

const COARSE: RowBits = RowBits {
    position: 20,
    velocity: 44,
};

fn encoded<const N: usize>(codec: &mut RowCodec<N>, row: &PvtRow<N>) -> Vec<u8> {
    let mut bytes = Vec::new();
    codec.encode(row, |byte| bytes.push(byte));
    bytes
}

#[test]
fn bytes_by_hand() {
    let knot = |position, velocity| PvtKnot { position, velocity };
    let bits = RowBits {
        position: 8,
        velocity: 10,
    };
    // 2^-10 steps a tick; 3 steps; 1000 ticks: 1000 / 2048 of a step are expected, 125 / 256.
    let row = PvtRow {
        ticks: 1000,
        knots: [knot(3 << 32, 1 << 46)],
    };
    let mut codec = RowCodec::new([knot(0, 0)], bits);
    // 2000 = 0b1111_1010000; 2 · 1; 2 · (768 - 125) = 1286 = 0b1010_0000110.
    assert_eq!(encoded(&mut codec, &row), [0xD0, 0x0F, 2, 0x86, 0x0A]);
    // The same again, 6 steps and 125 / 256 further: 1000 / 1024 of a step are expected.
    let again = PvtRow {
        ticks: 1000,
        knots: [knot((3 << 32) + (250 << 24), 1 << 46)],
    };
    assert_eq!(encoded(&mut codec, &again), [0, 1, 0]);
}

fn rows() -> impl Strategy<Value = Vec<PvtRow<2>>> {
    let knot = |bits| {
        (0..64_u32, any::<i64>(), 0..64_u32, any::<i64>()).prop_map(
            move |(a, position, b, velocity)| {
                let [a, b] = [a, b].map(|shift: u32| shift.max(bits));
                PvtKnot {
                    position: position >> a,
                    velocity: velocity >> b,
                }
            },
        )
    };
    let row = (any::<u32>(), 0..32_u32, knot(0), knot(0)).prop_map(|(ticks, shift, x, y)| PvtRow {
        ticks: ticks >> shift,
        knots: [x, y],
    });
    prop::collection::vec(row, 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_rows_come_back(rows in rows()) {
        let start = [PvtKnot::at_rest(7), PvtKnot::at_rest(-7)];
        let mut sender = RowCodec::new(start, RowBits::EXACT);
        let mut receiver = sender.clone();
        for row in rows {
            let bytes = encoded(&mut sender, &row);
            prop_assert!(bytes.len() <= 45);
            prop_assert_eq!(receiver.decode(&bytes), Ok((row, [].as_slice())));
            prop_assert_eq!(&receiver, &sender);
        }
    }

    #[test]
    fn coarse_rows_are_off_by_half_a_unit_and_do_not_drift(
        rows in rows(),
        position in 0..=40_u32,
        velocity in 0..=60_u32,
    ) {
        let bits = RowBits { position, velocity };
        let start = [PvtKnot::default(); 2];
        let (mut sender, mut receiver) = (RowCodec::new(start, bits), RowCodec::new(start, bits));
        let half = |bits: u32, all: u32| (1_u64 << all.saturating_sub(bits)) / 2;
        for row in rows {
            let bytes = encoded(&mut sender, &row);
            let (made, rest) = receiver.decode(&bytes).unwrap();
            prop_assert!(rest.is_empty() && made.ticks == row.ticks);
            for (made, knot) in made.knots.iter().zip(row.knots) {
                // The last unit below 2^63 is rounded down.
                let most = |n: i64, half: u64| if n.unsigned_abs() >> 62 > 0 { 2 * half } else { half };
                let off = made.position.abs_diff(knot.position);
                prop_assert!(off <= most(knot.position, half(position, 32)));
                let off = made.velocity.abs_diff(knot.velocity);
                prop_assert!(off <= most(knot.velocity, half(velocity, 56)));
            }
        }
    }

    #[test]
    fn any_bytes_are_a_row_with_this_spelling_or_none(
        bytes in prop::collection::vec(any::<u8>(), 0..80),
        position in 0..=32_u32,
        velocity in 0..=56_u32,
    ) {
        let start = [PvtKnot::at_rest(1); 2];
        let mut receiver = RowCodec::new(start, RowBits { position, velocity });
        let mut sender = receiver.clone();
        let mut left = bytes.as_slice();
        loop {
            let before = receiver.clone();
            match receiver.decode(left) {
                Ok((row, rest)) => {
                    let spelling = encoded(&mut sender, &row);
                    prop_assert_eq!(spelling.as_slice(), &left[..left.len() - rest.len()]);
                    left = rest;
                }
                Err(_) => {
                    prop_assert_eq!(receiver, before);
                    break;
                }
            }
        }
    }
}

#[test]
fn refusals_name_place_and_value() {
    let new = || RowCodec::new([PvtKnot::default()], COARSE);
    let error = |bytes: &[u8]| new().decode(bytes).unwrap_err();
    assert_eq!(
        error(&[2, 0x80]),
        RowBytesError::Truncated { len: 2 },
        "within a number"
    );
    assert_eq!(error(&[2, 2]).to_string(), "2 bytes end within a row");
    assert_eq!(
        error(&[2, 0x80, 0, 0]).to_string(),
        "the number that ends with byte 2 is too long"
    );
    assert_eq!(
        error(&[1, 0, 0]).to_string(),
        "a row of -1 ticks, not 0 to 2^32 - 1"
    );
    // 2^51 units of 2^-20 steps.
    let far = [0, 0, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x08];
    assert_eq!(
        error(&far).to_string(),
        "axis 0: a position or a velocity past 63 bits"
    );
}

/// Three rows in each ramp, ten between.
fn times_s() -> Vec<f64> {
    let steady = arm::END_S - 2.0 * arm::RAMP_S;
    let ramp = [1.0, 2.0, 3.0].map(|k| arm::RAMP_S * k / 3.0);
    let middle = (1..10_u32).map(|k| arm::RAMP_S + steady * f64::from(k) / 10.0);
    let last = ramp.map(|s| arm::END_S - arm::RAMP_S + s);
    let turn = [arm::END_S - arm::RAMP_S];
    ramp.into_iter()
        .chain(middle)
        .chain(turn)
        .chain(last)
        .collect()
}

/// Bytes and steps of the line, exact and rounded.
fn line_of_an_arm(tick_hz: u32, steps_per_turn: f64, bits: RowBits) -> (usize, u64) {
    let (start, rows) = arm::line(tick_hz, steps_per_turn, &times_s());
    let least = StepDirTiming::DRV8825.min_intervals(Rate::from_hz(tick_hz).unwrap());
    let mut sender = RowCodec::new(start, bits);
    let mut receiver = sender.clone();
    let mut axes = start.map(|knot| AxisSegments::new(knot, least));
    let (mut bytes, mut steps) = (0, 0);
    for row in rows {
        let wire = encoded(&mut sender, &row);
        bytes += wire.len();
        let (row, _) = receiver.decode(&wire).unwrap();
        for (axis, knot) in axes.iter_mut().zip(row.knots) {
            axis.push(row.ticks, knot).unwrap();
            steps += axis.map(|segment| u64::from(segment.count())).sum::<u64>();
        }
    }
    (bytes, steps)
}

/// The goal: 0.3 bytes a step within one tick of 12 MHz, at fine and at coarse resolution.
#[test]
fn a_line_of_an_arm_takes_less_than_a_third_of_a_byte_a_step() {
    for steps_per_turn in [3200.0, 32_000.0] {
        for bits in [RowBits::EXACT, COARSE] {
            let (bytes, steps) = line_of_an_arm(12_000_000, steps_per_turn, bits);
            let a_step = bytes as f64 / steps as f64;
            println!("{steps_per_turn} steps a turn, {bits:?}: {bytes} bytes for {steps} steps");
            assert!(bits == RowBits::EXACT || a_step <= 0.3, "{a_step}");
        }
    }
}
