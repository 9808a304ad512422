//! Every function with anything: 0, the largest and smallest numbers. The answer is right, or an
//! error.

use motor_phases::{
    Accumulation, BusWrite, Latches, Phases, Placement, Polarity, Rate, SpeedLaw, Stepping, Wiring,
};
use proptest::prelude::*;
use test_support::any_i32;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn accumulators(threshold: u16, speed: i8, rate in (1..=u32::MAX, 1..=u32::MAX)) {
        let rate = Rate::new(rate.0, rate.1).unwrap();
        for law in [SpeedLaw::Reset, SpeedLaw::CarryMagnitude, SpeedLaw::CarrySigned] {
            let accumulation = Accumulation::new(law, threshold, rate);
            prop_assert_eq!(accumulation.is_ok(), (128..=32_639).contains(&threshold));
            let Ok(accumulation) = accumulation else { continue };
            for speed in [speed, i8::MIN] {
                let mean = accumulation.steps_per_tick(speed);
                let hz = mean * f64::from(rate.numerator()) / f64::from(rate.denominator());
                #[expect(clippy::cast_precision_loss, reason = "compared to 12 digits")]
                let millihertz = accumulation.millihertz(speed) as f64;
                prop_assert!((millihertz - 1000.0 * hz).abs() <= 0.5 + 1e-12 * hz.abs() * 1000.0);
            }
        }
    }

    #[test]
    fn phases_and_latches(
        bits: [u8; 4],
        steps in any_i32(),
        byte: u8,
        writes in prop::collection::vec((any::<u8>(), prop::option::of(any::<usize>())), 0..9),
    ) {
        for bits in [bits, bits.map(|bit| bit & 3)] {
            let wiring = Wiring {
                bits,
                polarity: Polarity::ActiveLow,
                placement: Placement::Doubled,
            };
            let each_once = (0..4).all(|bit| bits.contains(&bit));
            let phases = Phases::new(Stepping::Half, wiring);
            prop_assert_eq!(phases.is_ok(), each_once);
            prop_assert_eq!(Phases::new(Stepping::Half, wiring.reversed()).is_ok(), each_once);
            if let Ok(phases) = phases {
                let phase = phases.advance(phases.start(), steps);
                prop_assert_eq!(i32::from(phase.half_step()), steps.rem_euclid(8));
                prop_assert_eq!(phases.phase_of(phases.byte(phase)), Some(phase));
                let found = phases.phase_of(byte).map(|phase| phases.byte(phase));
                prop_assert!(found.is_none_or(|found| found == byte));
            }
        }
        let mut latches = Latches::<3>::new();
        for (data, strobe) in writes {
            let before = latches.clone();
            match latches.write(BusWrite { data, strobe }) {
                Ok(()) => prop_assert!(strobe.is_none_or(|latch| latches.outputs()[latch] == data)),
                Err(_) => prop_assert_eq!(&before, &latches),
            }
        }
    }
}
