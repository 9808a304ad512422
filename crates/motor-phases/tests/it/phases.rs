//! Phase sequences and the latches on a bus that hold them.

use motor_phases::{
    BusError, BusWrite, LatchWrites, Latches, Phases, Placement, Polarity, Stepping, Wiring,
    WiringError,
};
use proptest::prelude::*;

/// Bytes from the start on, one step at a time.
fn sequence(stepping: Stepping, wiring: Wiring, step: i32) -> Vec<u8> {
    let phases = Phases::new(stepping, wiring).unwrap();
    let mut phase = phases.start();
    let mut bytes = vec![phases.byte(phase)];
    loop {
        phase = phases.advance(phase, step);
        if phase == phases.start() {
            return bytes;
        }
        bytes.push(phases.byte(phase));
    }
}

const UNIPOLAR: Wiring = Wiring::UNIPOLAR;

#[test]
fn the_published_sequences() {
    let [wave, full, half] = [Stepping::Wave, Stepping::Full, Stepping::Half]
        .map(|stepping| sequence(stepping, UNIPOLAR, 1));
    assert_eq!(wave, [1, 2, 4, 8]);
    assert_eq!(full, [3, 6, 12, 9]);
    assert_eq!(half, [1, 3, 2, 6, 4, 12, 8, 9]);
    assert_eq!(
        sequence(Stepping::Half, UNIPOLAR, -1),
        [1, 9, 8, 12, 4, 6, 2, 3]
    );
    assert_eq!(sequence(Stepping::Full, UNIPOLAR, -1), [3, 9, 12, 6]);
}

#[test]
fn memory_is_what_the_readme_says() {
    assert_eq!(size_of::<Phases>(), 11);
}

#[test]
fn polarity_order_and_placement() {
    let low = Wiring {
        polarity: Polarity::ActiveLow,
        ..UNIPOLAR
    };
    assert_eq!(sequence(Stepping::Wave, low, 1), [14, 13, 11, 7]);
    assert_eq!(
        sequence(Stepping::Wave, UNIPOLAR.reversed(), 1),
        [8, 4, 2, 1]
    );
    let [high, doubled] = [Placement::High, Placement::Doubled].map(|placement| Wiring {
        placement,
        ..UNIPOLAR
    });
    assert_eq!(sequence(Stepping::Full, high, 1), [0x30, 0x60, 0xC0, 0x90]);
    assert_eq!(
        sequence(Stepping::Full, doubled, 1),
        [0x33, 0x66, 0xCC, 0x99]
    );
    let all = Wiring {
        placement: Placement::Doubled,
        ..low.reversed()
    };
    assert_eq!(sequence(Stepping::Wave, all, 1), [0x77, 0xBB, 0xDD, 0xEE]);
    assert_eq!(Phases::new(Stepping::Wave, all).unwrap().off_byte(), 0xFF);
}

#[test]
fn a_bipolar_motor_never_has_both_inputs_of_a_bridge_on() {
    for stepping in [Stepping::Wave, Stepping::Full, Stepping::Half] {
        for nibble in sequence(stepping, Wiring::BIPOLAR, 1) {
            assert!(nibble & 3 != 3 && nibble & 12 != 12, "{nibble:#x}");
        }
    }
    // A+, then A+ B+, B+, B+ A-, ...
    assert_eq!(
        sequence(Stepping::Half, Wiring::BIPOLAR, 1),
        [1, 5, 4, 6, 2, 10, 8, 9]
    );
}

#[test]
fn a_change_of_direction_starts_from_the_phase_at_hand() {
    let phases = Phases::new(Stepping::Half, UNIPOLAR).unwrap();
    let mut phase = phases.advance(phases.start(), 3);
    assert_eq!(phases.byte(phase), 6);
    let mut bytes = Vec::new();
    for step in [1, -1, -1, 0, -1, 1_i8] {
        phase = phases.advance(phase, step);
        bytes.push(phases.byte(phase));
    }
    assert_eq!(bytes, [4, 6, 2, 2, 3, 2]);
}

#[test]
fn wrong_wirings_name_winding_and_bit() {
    let bits = |bits| Phases::new(Stepping::Half, Wiring { bits, ..UNIPOLAR });
    let error = bits([0, 1, 4, 3]).unwrap_err();
    assert_eq!(error, WiringError::NoSuchBit { winding: 2, bit: 4 });
    assert_eq!(
        error.to_string(),
        "winding 2 at bit 4 of a nibble; the last is 3"
    );
    let error = bits([0, 1, 2, 1]).unwrap_err();
    let shared = WiringError::SharedBit {
        first: 1,
        second: 3,
        bit: 1,
    };
    assert_eq!(error, shared);
    assert_eq!(error.to_string(), "windings 1 and 3 both at bit 1");
    assert!(bits([3, 0, 2, 1]).is_ok());
}

#[test]
fn the_writes_of_a_bus() {
    let write = |data, strobe| BusWrite { data, strobe };
    let mut writes = LatchWrites::new([None, Some(9), None, Some(6), None]);
    for (left, expected) in (1..=6).rev().zip([
        write(9, None),
        write(9, Some(1)),
        write(9, None),
        write(6, None),
        write(6, Some(3)),
        write(6, None),
    ]) {
        assert_eq!(writes.len(), left);
        assert_eq!(writes.next(), Some(expected));
    }
    assert_eq!(writes.size_hint(), (0, Some(0)));
    assert!(writes.next().is_none() && writes.next().is_none());
    assert_eq!(LatchWrites::new([None; 8]).len(), 0);
}

#[test]
fn data_under_a_high_strobe_is_told() {
    let write = |data, strobe| BusWrite { data, strobe };
    let spoiled = |latch| {
        Err(BusError::DataUnderStrobe {
            latch,
            before: 3,
            after: 4,
        })
    };
    let mut latches = Latches::<2>::default();
    // With the rise of the strobe, under it, with its fall.
    latches.write(write(3, None)).unwrap();
    assert_eq!(latches.write(write(4, Some(0))), spoiled(0));
    assert_eq!(latches.outputs(), [0, 0]);
    latches.write(write(3, Some(1))).unwrap();
    assert_eq!(latches.write(write(4, Some(1))), spoiled(1));
    assert_eq!(latches.write(write(4, None)), spoiled(1));
    latches.write(write(3, None)).unwrap();
    latches.write(write(4, None)).unwrap();
    assert_eq!(latches.outputs(), [0, 3]);
    let error = latches.write(write(4, Some(2))).unwrap_err();
    assert_eq!(error.to_string(), "strobe 2 of 2 latches");
}

fn wirings() -> impl Strategy<Value = Wiring> {
    let bits = Just([0_u8, 1, 2, 3]).prop_shuffle();
    let polarity = prop_oneof![Just(Polarity::ActiveHigh), Just(Polarity::ActiveLow)];
    let placement = prop_oneof![
        Just(Placement::Low),
        Just(Placement::High),
        Just(Placement::Doubled)
    ];
    (bits, polarity, placement).prop_map(|(bits, polarity, placement)| Wiring {
        bits,
        polarity,
        placement,
    })
}

fn steppings() -> impl Strategy<Value = Stepping> {
    prop_oneof![
        Just(Stepping::Wave),
        Just(Stepping::Full),
        Just(Stepping::Half)
    ]
}

proptest! {
    #[test]
    fn neighbouring_phases_differ_by_one_winding_that_comes_and_one_that_goes(
        stepping in steppings(),
        wiring in wirings(),
        steps in any::<i32>(),
    ) {
        let phases = Phases::new(stepping, wiring).unwrap();
        let phase = phases.advance(phases.start(), steps);
        let next = phases.advance(phase, 1);
        prop_assert_eq!(phases.advance(next, -1), phase);
        prop_assert_eq!(phases.phase_of(phases.byte(phase)), Some(phase));
        prop_assert_eq!(phases.phase_of(phases.off_byte()), None);
        let changed = (phases.nibble(phase) ^ phases.nibble(next)).count_ones();
        prop_assert_eq!(changed, if stepping == Stepping::Half { 1 } else { 2 });
        // Half or full turns of all 32 bits of steps come back to the start.
        prop_assert_eq!(phases.advance(phases.advance(phases.start(), i32::MAX), i32::MIN),
            phases.advance(phases.start(), -1));
    }

    #[test]
    fn the_writes_bring_every_byte_to_its_latch_and_no_other(
        rounds in prop::collection::vec(any::<[Option<u8>; 8]>(), 1..20),
    ) {
        let mut latches = Latches::<8>::new();
        for bytes in rounds {
            let before = latches.outputs();
            let writes = LatchWrites::new(bytes);
            prop_assert_eq!(writes.len(), writes.clone().count());
            for write in writes {
                latches.write(write).unwrap();
            }
            let expected: Vec<u8> = before.iter().zip(bytes).map(|(&b, n)| n.unwrap_or(b)).collect();
            prop_assert_eq!(latches.outputs().to_vec(), expected);
        }
    }
}
