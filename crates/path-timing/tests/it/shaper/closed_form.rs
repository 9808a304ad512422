//! Shapers against the closed forms of what they leave of a vibration.

use path_timing::{Impulse, Mode, Shaper, ShaperError};

type Make = fn(Mode) -> Result<Shaper, ShaperError>;

/// Each shaper with the residual at its frequency without damping, and how far off the frequency
/// may be for a residual of 5 %.
pub(super) const SHAPERS: [(&str, Make, f64, f64); 6] = [
    ("ZV", Shaper::zv, 0.0, 0.03),
    ("MZV", Shaper::mzv, 0.0, 0.045),
    ("ZVD", Shaper::zvd, 0.0, 0.14),
    ("EI", Shaper::ei, 0.05, 0.20),
    ("2HUMP", Shaper::two_hump, 0.0, 0.36),
    ("3HUMP", Shaper::three_hump, 0.05, 0.48),
];

/// Of the closed forms.
const ROUNDING: f64 = 1e-12;

#[test]
fn residuals_are_those_of_the_literature() {
    for (name, make, at_frequency, width) in SHAPERS {
        for damping in [0.0, 0.01, 0.1] {
            let mode = Mode { hz: 37.0, damping };
            let shaper = make(mode).unwrap();
            let residual = shaper.residual(mode);
            // Damping makes what is left smaller, never larger.
            assert!(residual <= at_frequency + ROUNDING, "{name}: {residual}");
            for percent in -100..=100 {
                let hz = 37.0 * (1.0 + width * f64::from(percent) / 100.0);
                let residual = shaper.residual(Mode { hz, damping });
                assert!(residual <= 0.0505, "{name} at {hz} Hz: {residual}");
            }
        }
        let undamped = |hz| Mode { hz, damping: 0.0 };
        let shaper = make(undamped(37.0)).unwrap();
        assert!((shaper.residual(undamped(37.0)) - at_frequency).abs() < ROUNDING);
        let beyond = shaper.residual(undamped(37.0 * (1.015 + width)));
        assert!(beyond > 0.05, "{name}: {beyond}");
    }
}

#[test]
fn impulses_rise_and_have_the_sum_1() {
    for (name, make, ..) in SHAPERS {
        for (hz, damping) in [(5.0, 0.0), (40.0, 0.05), (120.0, 0.9)] {
            let shaper = make(Mode { hz, damping }).unwrap();
            let impulses = shaper.impulses();
            let sum: f64 = impulses.iter().map(|impulse| impulse.amplitude).sum();
            assert!((sum - 1.0).abs() < ROUNDING, "{name}");
            assert!(
                impulses
                    .windows(2)
                    .all(|pair| pair[0].time_s < pair[1].time_s)
            );
            assert!(impulses[0].time_s == 0.0 && impulses.iter().all(|i| i.amplitude > 0.0));
        }
    }
    // ZV of an undamped mode: halves, half a period apart; s² is a sixteenth of the period squared.
    let zv = Shaper::zv(Mode {
        hz: 50.0,
        damping: 0.0,
    })
    .unwrap();
    let [first, second] = zv.impulses() else {
        unreachable!()
    };
    assert_eq!((first.amplitude, second.amplitude), (0.5, 0.5));
    assert!((second.time_s - 0.01).abs() < ROUNDING && (zv.delay_s() - 0.005).abs() < ROUNDING);
    assert!((zv.departure(-2.0) - 0.02_f64.powi(2) / 16.0).abs() < ROUNDING);
    assert_eq!(Shaper::none().impulses().len(), 1);
    assert_eq!(
        (Shaper::none().delay_s(), Shaper::none().departure(1e9)),
        (0.0, 0.0)
    );
}

#[test]
fn a_shaper_for_two_modes_stills_both() {
    let modes = [30.0, 71.0].map(|hz| Mode { hz, damping: 0.03 });
    let [one, other] = modes.map(|mode| Shaper::zv(mode).unwrap());
    let mut impulses: Vec<_> = one
        .impulses()
        .iter()
        .flat_map(|a| {
            other.impulses().iter().map(|b| Impulse {
                time_s: a.time_s + b.time_s,
                amplitude: a.amplitude * b.amplitude,
            })
        })
        .collect();
    impulses.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    let both = Shaper::from_impulses(&impulses).unwrap();
    for mode in modes {
        assert!(both.residual(mode) < ROUNDING);
    }
}

#[test]
fn what_is_no_shaper_is_refused() {
    let refused = |hz, damping| Shaper::ei(Mode { hz, damping }).unwrap_err().to_string();
    assert_eq!(
        refused(0.0, 0.1),
        "a mode's frequency of 0 is not within 1e-50..=1e50"
    );
    assert_eq!(
        refused(40.0, 1.0),
        "a mode's damping of 1 is not within 0..=0.9"
    );
    assert_eq!(
        refused(40.0, f64::NAN),
        "a mode's damping of NaN is not within 0..=0.9"
    );
    assert!(
        Shaper::none()
            .residual(Mode {
                hz: -1.0,
                damping: 0.0
            })
            .is_nan()
    );
    let impulses = |impulses: &[(f64, f64)]| {
        let impulses: Vec<_> = impulses
            .iter()
            .map(|&(time_s, amplitude)| Impulse { time_s, amplitude })
            .collect();
        Shaper::from_impulses(&impulses).map_err(|error| error.to_string())
    };
    assert_eq!(
        impulses(&[]).unwrap_err(),
        "0 impulses are not within 1..=8"
    );
    assert_eq!(
        impulses(&[(0.0, 1.0), (0.01, -0.1)]).unwrap_err(),
        "impulse 1: an amplitude of -0.1 is not above 0"
    );
    assert_eq!(
        impulses(&[(0.0, 1.0), (0.0, 0.1)]).unwrap_err(),
        "impulse 1: a time of 0 s does not rise from 0 on"
    );
    assert!(impulses(&[(-1e-9, 1.0)]).is_err() && impulses(&[(f64::NAN, 1.0)]).is_err());
    assert!(impulses(&[(0.0, 1.0); 9]).is_err());
}
