//! Synthetic logs: two modes, noise, times that are not even.

use core::fmt::Write as _;

use machine_sim::Random;

use super::*;

/// A number of the sequence, within 0..1 in steps of a thousandth.
fn part(random: &mut Random) -> f64 {
    let (mut low, mut width) = (0.0, 1.0);
    for _ in 0..20 {
        width *= 0.5;
        if random.happens(0.5) {
            low += width;
        }
    }
    low
}

/// Of variance 1.
fn noise(random: &mut Random) -> f64 {
    (0..12).map(|_| part(random)).sum::<f64>() - 6.0
}

struct Log {
    modes: [(Mode, f64); 2],
    noise: f64,
    readings: u32,
}

impl Log {
    /// As firmware writes it: 3,200 readings a second, each up to a tenth of that too late, a
    /// constant for gravity.
    fn text(&self, random: &mut Random) -> String {
        let mut text = "#time,accel_x,accel_y,accel_z\n".to_owned();
        let phases = [part(random), part(random)];
        for place in 0..self.readings {
            let time = (f64::from(place) + 0.1 * part(random)) / 3200.0;
            let rings = self.modes.iter().zip(phases).map(|((mode, size), phase)| {
                let omega = TAU * mode.hz;
                let swung = omega * (1.0 - mode.damping.powi(2)).sqrt() * time + TAU * phase;
                size * (-mode.damping * omega * time).exp() * swung.sin()
            });
            let value = 300.0 + rings.sum::<f64>() + self.noise * noise(random);
            writeln!(text, "{:.6},{value:.3},0,9806.65", 17.25 + time).unwrap();
        }
        text
    }
}

/// The bounds: the frequency within 1 %, the damping within 20 %. `-- --nocapture` prints
/// the worst that was seen.
#[test]
fn two_modes_are_found_in_noise() {
    let mut random = Random::new(27);
    let [mut worst_hz, mut worst_damping] = [0.0_f64; 2];
    for _ in 0..40 {
        let first = 15.0 + 60.0 * part(&mut random);
        let second = first * (1.3 + 1.2 * part(&mut random));
        let mut damping = || 0.02 + 0.08 * part(&mut random);
        let dampings = [damping(), damping()];
        let log = Log {
            modes: [
                (
                    Mode {
                        hz: first,
                        damping: dampings[0],
                    },
                    2000.0,
                ),
                (
                    Mode {
                        hz: second,
                        damping: dampings[1],
                    },
                    1000.0 + 2000.0 * part(&mut random),
                ),
            ],
            noise: 100.0,
            readings: 3200,
        };
        let text = log.text(&mut random);
        let mut found = RingDown::parse(&text, "accel_x", 0.0..)
            .unwrap()
            .modes()
            .unwrap();
        found.sort_by(|a, b| a.mode.hz.total_cmp(&b.mode.hz));
        assert_eq!(found.len(), 2, "{found:?} of {:?}", log.modes);
        for (it, (mode, _)) in found.iter().zip(log.modes) {
            worst_hz = worst_hz.max((it.mode.hz / mode.hz - 1.0).abs());
            worst_damping = worst_damping.max((it.mode.damping / mode.damping - 1.0).abs());
            assert!((it.mode.hz - mode.hz).abs() < 5.0 * it.deviation.hz);
            assert!((it.mode.damping - mode.damping).abs() < 5.0 * it.deviation.damping);
        }
    }
    println!(
        "frequency within {:.3} %, damping within {:.1} %",
        100.0 * worst_hz,
        100.0 * worst_damping
    );
    assert!(worst_hz < 0.01 && worst_damping < 0.2);
}

/// The best shaper of a log with one mode leaves what it promises.
#[test]
fn the_best_shaper_leaves_little_and_smooths_least() {
    let mode = Mode {
        hz: 42.0,
        damping: 0.05,
    };
    let log = Log {
        modes: [(mode, 2500.0), (mode, 0.0)],
        noise: 50.0,
        readings: 2560,
    };
    let text = log.text(&mut Random::new(3));
    let found = RingDown::parse(&text, "ACCEL_X", 0.0..0.7)
        .unwrap()
        .modes()
        .unwrap();
    assert_eq!(found.len(), 1);
    let choices = crate::Choice::all(&found, 5000.0).unwrap();
    let (best, rest) = choices.split_first().unwrap();
    assert!(best.residual() <= 0.05, "{best}");
    assert!(
        rest.iter()
            .all(|it| it.residual() > 0.05 || it.departure_mm() >= best.departure_mm())
    );
    // The quickest, one that is left of 10 % off.
    assert!(
        rest.iter()
            .any(|it| it.name().starts_with("ZV ") && it.residual() > 0.1)
    );
    let svg = crate::picture(
        &RingDown::parse(&text, "accel_x", 0.0..).unwrap(),
        &found,
        &choices,
    );
    assert!(svg.unwrap().to_string().contains("42."));
}

#[test]
fn what_is_no_ring_down_is_refused() {
    let said = |text: &str, column| {
        let modes = RingDown::parse(text, column, 0.0..).and_then(|it| it.modes());
        format!("{:#}", modes.unwrap_err())
    };
    let quiet = Log {
        modes: [(
            Mode {
                hz: 40.0,
                damping: 0.1,
            },
            0.0,
        ); 2],
        noise: 100.0,
        readings: 3200,
    };
    let quiet = quiet.text(&mut Random::new(5));
    assert_eq!(
        said(&quiet, "accel_x"),
        "nothing rings in these readings, or it does not die away"
    );
    assert_eq!(
        said(&quiet, "accel_y"),
        "nothing rings in these readings, or it does not die away"
    );
    assert_eq!(
        said("time,a\n0,1\n0.1,2\n", "a"),
        "2 readings are too few: 64 at least"
    );
    assert_eq!(
        said("time,a\n0,1\n0,2\n", "a"),
        "line 3: time 0 is not after 0"
    );
    assert_eq!(said("time,a\n", "a"), "0 readings are too few: 64 at least");
}
