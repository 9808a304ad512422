//! The judge of shaping: oscillators that are driven by the edges of a motor, and nothing else.

use core::f64::consts::TAU;

use path_timing::{AxisLimits, Curve, Knot, Mode, Row, Shaper, Table};
use pvt_steps::{Direction, MinIntervals, PvtQuantiser, PvtSteps, Rate, StepScale};

use super::closed_form::SHAPERS;
use super::rows::shaped;

const TICK_HZ: u32 = 72_000_000;
const ACCELERATION: f64 = 5000.0;

/// A mass on a spring whose other end steps.
///
/// ```text
/// x" + 2ζω x' + ω² (x - u) = 0      between steps the exact decaying turn of (x - u, x')
/// ```
struct Oscillator {
    omega: f64,
    damping: f64,
    /// x - u, and the velocity.
    state: [f64; 2],
    ticks: u64,
}

impl Oscillator {
    fn new(mode: Mode) -> Self {
        Self {
            omega: TAU * mode.hz,
            damping: mode.damping,
            state: [0.0; 2],
            ticks: 0,
        }
    }

    fn damped(&self) -> f64 {
        self.omega * (1.0 - self.damping * self.damping).sqrt()
    }

    fn go_to(&mut self, ticks: u64) {
        let ticks_since = u32::try_from(ticks - self.ticks).unwrap();
        let time_s = f64::from(ticks_since) / f64::from(TICK_HZ);
        let (decay, damped) = (self.damping * self.omega, self.damped());
        let [y, v] = self.state;
        let (sin, cos) = (damped * time_s).sin_cos();
        let size = (-decay * time_s).exp();
        let lead = (v + decay * y) / damped;
        let y1 = size * (y * cos + lead * sin);
        let v1 = size * (lead * cos - y * sin) * damped - decay * y1;
        (self.state, self.ticks) = ([y1, v1], ticks);
    }

    fn amplitude(&self) -> f64 {
        let [y, v] = self.state;
        y.hypot((v + self.damping * self.omega * y) / self.damped())
    }
}

/// The vibration that is left when the last edge is over, in mm.
fn left(rows: &[Row<[f64; 2]>], mode: Mode, steps_per_mm: f64) -> f64 {
    let tick_rate = Rate::from_hz(TICK_HZ).unwrap();
    let scale = StepScale::new(steps_per_mm).unwrap();
    let mut quantiser = PvtQuantiser::new(tick_rate, [scale; 2], [0.0; 2]).unwrap();
    let any = MinIntervals {
        step_ticks: 1,
        reversal_ticks: 1,
    };
    let mut steps = PvtSteps::new(quantiser.knots(), any);
    let mut oscillator = Oscillator::new(mode);
    let mut count = 0;
    for row in &rows[1..] {
        let row = quantiser
            .row(row.time_s, row.position, row.velocity)
            .unwrap();
        steps.push(&row).unwrap();
        for step in &mut steps {
            oscillator.go_to(step.ticks);
            let sign = if step.direction == Direction::Positive {
                1
            } else {
                -1
            };
            oscillator.state[0] -= f64::from(sign) / steps_per_mm;
            count += sign;
        }
    }
    oscillator.go_to(steps.end_ticks());
    let end = rows[rows.len() - 1].position[0];
    assert!((f64::from(count) - end * steps_per_mm).abs() <= 1.0);
    oscillator.amplitude()
}

/// The largest vibration that short and long moves leave at an actual mode, where each is shaped
/// for the mode that is known; with and without the shaper.
fn worst(
    known: Mode,
    actual: Mode,
    make: Option<fn(Mode) -> Result<Shaper, path_timing::ShaperError>>,
) -> f64 {
    let period_s = 1.0 / known.hz;
    let axis = AxisLimits {
        speed: 1e4,
        acceleration: ACCELERATION,
        jerk: None,
    };
    // From a tenth of a micrometre at 120 Hz on, a step is a small part of what is left.
    let steps_per_mm = 4.0 * known.hz * known.hz;
    let moves = [0.45, 0.55, 1.4].map(|periods| {
        let half_s: f64 = periods * period_s;
        let line = Curve::line([0.0; 2], [ACCELERATION * half_s * half_s, 0.0]).unwrap();
        let mut knots = [Knot::default(); 61];
        let table = Table::plan([line], [axis; 2], |_| 60, &mut knots).unwrap();
        let shaper = make.map_or(Shaper::none(), |make| make(known).unwrap());
        left(&shaped(table.rows(), [shaper; 2]), actual, steps_per_mm)
    });
    moves.into_iter().fold(0.0, f64::max)
}

/// What quantised steps add: a part of a step, of some thousands.
const STEPS: f64 = 2e-3;

#[test]
fn edges_of_a_shaped_motion_leave_no_mode_ringing() {
    for hz in [5.0, 12.0, 40.0, 120.0] {
        let known = Mode { hz, damping: 0.05 };
        let unshaped = worst(known, known, None);
        for (name, make, at_frequency, _) in SHAPERS {
            let part = worst(known, known, Some(make)) / unshaped;
            println!("{hz} Hz, {name}: {unshaped:.5} mm unshaped, {part:.5} left");
            assert!(part <= at_frequency + STEPS, "{name} at {hz} Hz: {part}");
        }
        let mut most = 0.0_f64;
        for percent in [-15.0, -10.0, -5.0, 5.0, 10.0, 15.0] {
            let actual = Mode {
                hz: hz * (1.0 + percent / 100.0),
                ..known
            };
            most = most.max(worst(known, actual, Some(Shaper::ei)) / worst(known, actual, None));
        }
        println!("{hz} Hz, EI within 15 %: {most:.5} left");
        assert!(most <= 0.05, "{hz} Hz: {most}");
    }
}
