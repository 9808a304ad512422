//! A stepping motor with its load, driven by the edges alone: whether it keeps up.

use core::f64::consts::{FRAC_PI_2, PI};

/// Of the integration, in s: 40 and more in a period of 1 kHz.
const SLICE_S: f64 = 25e-6;
/// Full steps from one stable place of the rotor to the next.
const CYCLE: f64 = 4.0;

/// A hybrid stepping motor and what it turns, on a drive of constant current.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::exhaustive_structs, reason = "named fields, from a data sheet")]
pub struct Motor {
    /// Holding torque, in N m.
    pub holding_torque_nm: f64,
    /// Where the torque has fallen to 0.71 of that, in full steps a second.
    pub corner_speed_hz: f64,
    /// Of rotor and load, seen at the rotor, in kg m².
    pub inertia_kg_m2: f64,
    /// Friction that does not depend on the speed, seen at the rotor, in N m.
    pub friction_nm: f64,
    /// Damping of small swings, 1 for the aperiodic case, friction not counted.
    pub damping_ratio: f64,
    /// Full steps of a turn: 200 of 1.8 degrees.
    pub full_steps_per_turn: u32,
    /// Steps of the drive in a full step.
    pub microsteps: u32,
}

impl Motor {
    /// The largest acceleration by its torque at rest, in full steps/s².
    fn acceleration(&self) -> f64 {
        self.full_steps(self.holding_torque_nm)
    }

    /// What a torque makes of the inertia, in full steps/s².
    fn full_steps(&self, torque_nm: f64) -> f64 {
        let rad = 2.0 * PI / f64::from(self.full_steps_per_turn);
        torque_nm / self.inertia_kg_m2 / rad
    }

    /// The torque that it has at a speed, in N m, while its lag is constant: what
    /// [`pull_out_nm`](Self::pull_out_nm) is below.
    fn static_nm(&self, speed_hz: f64) -> f64 {
        let share = speed_hz / self.corner_speed_hz;
        self.holding_torque_nm / (1.0 + share * share).sqrt()
    }

    /// The largest torque in N m that a load may have at a speed in full steps a second, beside the
    /// motor's friction and damping, and turn round at once without the loss of a step: simulated.
    ///
    /// A load that changes at once makes the rotor swing about its new place, so it is less than
    /// the motor has at that speed. Without friction and damping:
    ///
    /// ```text
    /// changes its sign    2 / sqrt(π² + 4) = 0.537 of the torque at the speed
    /// ```
    ///
    /// A rotor that swings already holds less: where the load comes at once, too, and turns round
    /// when that swing is at its farthest, 0.422 of the torque, 79 % of the above.
    ///
    ///
    /// `load_kg_m2` is the inertia of rotor and load, seen at the rotor. 0 where the motor does not
    /// even turn without a load.
    #[must_use]
    pub fn pull_out_nm(&self, speed_hz: f64, load_kg_m2: f64) -> f64 {
        const CUTS: u32 = 12;
        let mut holds = 0.0;
        let mut most = self.static_nm(speed_hz);
        for _ in 0..CUTS {
            let torque = f64::midpoint(holds, most);
            if self.holds(speed_hz, load_kg_m2, torque) {
                holds = torque;
            } else {
                most = torque;
            }
        }
        holds
    }

    /// Whether no step is lost where a load at a speed comes slowly and turns round at once, from
    /// either side.
    fn holds(&self, speed_hz: f64, load_kg_m2: f64, torque_nm: f64) -> bool {
        const RAMP_S: f64 = 0.1;
        const END_S: f64 = 0.15;
        let edge_s = 1.0 / (speed_hz * f64::from(self.microsteps));
        [torque_nm, -torque_nm].into_iter().all(|torque_nm| {
            let mut rotor = Rotor::new(*self);
            rotor.speed = speed_hz;
            let mut edges = (1..).map(|edge| f64::from(edge) * edge_s).peekable();
            while rotor.time_s < END_S && rotor.lost_cycles == 0 {
                let load_nm = if rotor.time_s < RAMP_S {
                    torque_nm * rotor.time_s / RAMP_S
                } else {
                    -torque_nm
                };
                rotor.set_load(load_kg_m2, load_nm);
                let slice_s = rotor.time_s + SLICE_S;
                while let Some(at_s) = edges.next_if(|at_s| *at_s < slice_s) {
                    rotor.step(at_s, 1);
                }
                rotor.turn_until(slice_s);
            }
            rotor.lost_cycles == 0
        })
    }

    /// Frequency of small swings about a stable place, in Hz.
    ///
    /// ```text
    /// f0 = sqrt(A π/2) / 2π,  A = holding torque / inertia, in full steps/s²
    /// ```
    #[must_use]
    pub fn natural_frequency_hz(&self) -> f64 {
        (self.acceleration() * FRAC_PI_2).sqrt() / (2.0 * PI)
    }
}

/// The rotor of a [`Motor`] while the drive steps the field round.
///
/// ```text
/// x'' = A(x') sin((f - x) π/2) - 2 ζ ω0 x' - F sign(x') - L     in full steps
/// A(v) = A / sqrt(1 + (v / corner speed)²),  ω0² = A π/2
/// ```
/// x is the rotor, f the field: the edges so far, in microsteps of equal size. The torque is the
/// greatest at a lag f - x of one full step; at two it changes its sign, and the rotor falls back
/// by four: these steps are lost. L is the load's torque, 0 but by [`set_load`](Self::set_load).
/// Nothing of this is measured on a real motor; it is the usual
/// second-order model of stepping motors, without detent torque and resonances of the load.
///
/// # Examples
/// ```
/// use machine_sim::{Motor, Rotor};
/// let motor = Motor {
///     holding_torque_nm: 0.4,
///     corner_speed_hz: 2000.0,
///     inertia_kg_m2: 1e-5,
///     friction_nm: 0.02,
///     damping_ratio: 0.05,
///     full_steps_per_turn: 200,
///     microsteps: 2,
/// };
/// // From rest to 500 and to 6000 full steps a second at once.
/// let lost = [500.0, 6000.0].map(|hz| {
///     let mut rotor = Rotor::new(motor);
///     for step in 1..=400_u32 {
///         rotor.step(f64::from(step) / (2.0 * hz), 1);
///     }
///     rotor.settle();
///     rotor.lost_steps()
/// });
/// assert_eq!(lost[0], 0);
/// assert!(lost[1] > 300);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Rotor {
    motor: Motor,
    acceleration: f64,
    friction: f64,
    damping: f64,
    load: f64,
    /// The motor's inertia over that of now, by which all accelerations above are multiplied.
    lightness: f64,
    /// Microsteps of the field.
    field: i64,
    /// In full steps, and a second.
    position: f64,
    speed: f64,
    time_s: f64,
    /// Whole cycles that the rotor is behind the field.
    cycles: i64,
    lost_cycles: u64,
    max_lag: f64,
}

impl Rotor {
    /// A rotor that stands where the field is.
    #[must_use]
    pub fn new(motor: Motor) -> Self {
        Self {
            acceleration: motor.acceleration(),
            friction: motor.full_steps(motor.friction_nm),
            damping: 4.0 * PI * motor.damping_ratio * motor.natural_frequency_hz(),
            load: 0.0,
            lightness: 1.0,
            motor,
            field: 0,
            position: 0.0,
            speed: 0.0,
            time_s: 0.0,
            cycles: 0,
            lost_cycles: 0,
            max_lag: 0.0,
        }
    }

    /// A pulse of the drive at a time, not before the last one: up for a number above 0, down for
    /// one below.
    pub fn step(&mut self, time_s: f64, direction: i32) {
        self.turn_until(time_s);
        self.field += i64::from(direction.signum());
    }

    /// What the rotor turns from here on, seen at the rotor: the inertia of rotor and load in kg
    /// m², and a torque against positive turning in N m, beside the motor's friction.
    ///
    /// What an arm's other joints and gravity do to a joint changes with the pose and the speed:
    /// set it at each step.
    pub fn set_load(&mut self, inertia_kg_m2: f64, torque_nm: f64) {
        let lightness = self.motor.inertia_kg_m2 / inertia_kg_m2;
        for number in [
            &mut self.acceleration,
            &mut self.friction,
            &mut self.damping,
        ] {
            *number *= lightness / self.lightness;
        }
        self.lightness = lightness;
        self.load = self.motor.full_steps(torque_nm) * lightness;
    }

    /// The torque that it has for what it turns: that of the field less friction and damping, in N
    /// m.
    #[must_use]
    pub fn torque_nm(&self) -> f64 {
        let driven = self.torque(self.lag()) - self.damping * self.speed;
        let friction = if self.speed == 0.0 {
            (driven - self.load).clamp(-self.friction, self.friction)
        } else {
            self.friction.copysign(self.speed)
        };
        (driven - friction) / self.acceleration * self.motor.holding_torque_nm
    }

    /// Its speed, in rad/s.
    #[must_use]
    pub fn speed_rad_s(&self) -> f64 {
        self.speed * 2.0 * PI / f64::from(self.motor.full_steps_per_turn)
    }

    /// Lets it come to rest.
    pub fn settle(&mut self) {
        const MOST_S: f64 = 2.0;
        self.turn_until(self.time_s + MOST_S);
    }

    /// Pulses that turned the field on without the rotor, either way.
    #[must_use]
    pub fn lost_steps(&self) -> u64 {
        self.lost_cycles * 4 * u64::from(self.motor.microsteps)
    }

    /// The farthest that the rotor was from its place in the field, in full steps; from 2 on it
    /// loses steps.
    #[must_use]
    pub const fn max_lag_full_steps(&self) -> f64 {
        self.max_lag
    }

    /// Lets it turn up to a time in s, without a pulse.
    pub fn turn_until(&mut self, time_s: f64) {
        while self.time_s < time_s {
            let lag = self.lag();
            let torque = self.torque(lag) - self.load;
            if self.speed == 0.0 && torque.abs() <= self.friction {
                self.time_s = time_s;
                break;
            }
            let slice_s = SLICE_S.min(time_s - self.time_s);
            self.time_s += slice_s;
            // Semi-implicit: the speed first, then the place with it.
            let driven = self.speed + (torque - self.damping * self.speed) * slice_s;
            let braked = self.friction * slice_s;
            self.speed = driven - driven.clamp(-braked, braked);
            self.position += self.speed * slice_s;
            self.count_cycles();
        }
    }

    /// Of the rotor behind the field, less the cycles lost, in full steps.
    #[expect(clippy::cast_precision_loss, reason = "far below 2^52 steps")]
    fn lag(&self) -> f64 {
        let field = self.field as f64 / f64::from(self.motor.microsteps);
        field - self.position - self.cycles as f64 * CYCLE
    }

    fn torque(&self, lag: f64) -> f64 {
        // The same bits on every target.
        let share = self.speed / self.motor.corner_speed_hz;
        let (sine, _) = trig_kernels::sin_cos(lag * FRAC_PI_2);
        self.acceleration / (1.0 + share * share).sqrt() * sine
    }

    fn count_cycles(&mut self) {
        let lag = self.lag();
        self.max_lag = self.max_lag.max(lag.abs());
        if lag.abs() > CYCLE / 2.0 {
            self.cycles += if lag > 0.0 { 1 } else { -1 };
            self.lost_cycles += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without friction, so that formulas are exact.
    const FREE: Motor = Motor {
        holding_torque_nm: 0.4,
        corner_speed_hz: 1e9,
        inertia_kg_m2: 1e-5,
        friction_nm: 0.0,
        damping_ratio: 0.0,
        full_steps_per_turn: 200,
        microsteps: 64,
    };
    /// Of the integration, and of microsteps in place of an even field.
    const CLOSE: f64 = 0.02;

    /// Steps at a speed in full steps a second for 0.1 s.
    fn lost_at(motor: Motor, hz: f64) -> u64 {
        let mut rotor = Rotor::new(motor);
        let rate = hz * f64::from(motor.microsteps);
        for step in 1.. {
            let time_s = f64::from(step) / rate;
            if time_s > 0.1 {
                break;
            }
            rotor.step(time_s, 1);
        }
        rotor.lost_steps()
    }

    /// Seen from the field, the rotor starts with v and must not climb over the torque's hill:
    /// v²/2 < A 4/π.
    #[test]
    fn it_starts_with_the_speed_that_energy_allows() {
        let limit = (FREE.acceleration() * 8.0 / PI).sqrt();
        assert_eq!(lost_at(FREE, limit * (1.0 - CLOSE)), 0);
        assert!(lost_at(FREE, limit * (1.0 + CLOSE)) > 0);
    }

    #[test]
    fn small_swings_have_the_natural_frequency() {
        let mut rotor = Rotor::new(FREE);
        rotor.step(0.0, 1);
        let (mut crossings, mut above) = (Vec::new(), false);
        while crossings.len() < 11 {
            rotor.turn_until(rotor.time_s + SLICE_S);
            let is_above = rotor.lag() < 0.0;
            if is_above && !above {
                crossings.push(rotor.time_s);
            }
            above = is_above;
        }
        let measured = 10.0 / (crossings[10] - crossings[0]);
        let wanted = FREE.natural_frequency_hz();
        assert!(
            (measured / wanted - 1.0).abs() < CLOSE,
            "{measured} Hz, not {wanted}"
        );
    }

    /// At speed, an acceleration below that of the torque left over is followed, one above is not.
    #[test]
    fn it_follows_the_acceleration_that_the_torque_allows() {
        let motor = Motor {
            friction_nm: 0.1,
            ..FREE
        };
        let lost = |share: f64| {
            let acceleration = motor.full_steps(0.3) * share;
            let mut rotor = Rotor::new(motor);
            for step in 1..4000_u32 {
                let place = f64::from(step) / f64::from(motor.microsteps);
                rotor.step((2.0 * place / acceleration).sqrt(), 1);
            }
            rotor.lost_steps()
        };
        assert_eq!(lost(0.5), 0);
        assert!(lost(1.2) > 0);
    }

    #[test]
    fn above_its_corner_speed_it_has_less_torque() {
        let weak = Motor {
            corner_speed_hz: 300.0,
            friction_nm: 0.1,
            ..FREE
        };
        // A ramp within seconds to 3000 full steps a second, where 0.04 N m are left of 0.4.
        let lost = |motor: Motor| {
            let mut rotor = Rotor::new(motor);
            for step in 1..200_000_u32 {
                let place = f64::from(step) / f64::from(motor.microsteps);
                rotor.step((2.0 * place / 1500.0_f64).sqrt(), 1);
            }
            rotor.lost_steps()
        };
        assert_eq!(
            lost(Motor {
                corner_speed_hz: 1e9,
                ..weak
            }),
            0
        );
        assert!(lost(weak) > 0);
    }

    /// A load that comes at once swings the rotor to twice its lag where torques are small, and
    /// over the hill from 0.725 of the torque on: -1 = √(1 - r²) - r (π - asin r).
    #[test]
    fn a_sudden_load_is_held_as_far_as_energy_allows() {
        let lost = |share: f64| {
            let mut rotor = Rotor::new(FREE);
            rotor.set_load(FREE.inertia_kg_m2, share * FREE.holding_torque_nm);
            rotor.turn_until(0.2);
            rotor.lost_steps()
        };
        assert_eq!(lost(0.725 - CLOSE), 0);
        assert!(lost(0.725 + CLOSE) > 0);
    }

    /// 2 / sqrt(π² + 4) without damping; with much of it nearly all, less what damping takes at
    /// speed.
    #[test]
    fn a_load_that_turns_round_is_held_as_far_as_energy_allows() {
        let share = |motor: Motor, hz: f64| {
            motor.pull_out_nm(hz, 2.0 * motor.inertia_kg_m2) / motor.holding_torque_nm
        };
        let wanted = 2.0 / (PI * PI + 4.0).sqrt();
        for hz in [0.0, 400.0] {
            let found = share(FREE, hz);
            assert!(
                (found / wanted - 1.0).abs() < 2.0 * CLOSE,
                "{found} at {hz}"
            );
        }
        let damped = Motor {
            damping_ratio: 0.7,
            ..FREE
        };
        assert!(share(damped, 0.0) > 0.95);
        assert!(share(damped, 100.0) < share(damped, 0.0) - 0.05);
    }

    /// At x₁ the first swing turns back, at -(π - asin r) is the hill:
    ///
    /// ```text
    /// cos x₁ + r x₁ = 1    2 r x₁ - 1 = √(1 - r²) - r (π - asin r)    r = 0.4223
    /// ```
    #[test]
    fn a_load_that_comes_at_once_and_turns_round_in_the_swing_is_held_less() {
        let lost = |share: f64| {
            let torque_nm = share * FREE.holding_torque_nm;
            let mut rotor = Rotor::new(FREE);
            rotor.set_load(FREE.inertia_kg_m2, torque_nm);
            rotor.turn_until(SLICE_S);
            while rotor.speed < 0.0 {
                rotor.turn_until(rotor.time_s + SLICE_S);
            }
            rotor.set_load(FREE.inertia_kg_m2, -torque_nm);
            rotor.turn_until(rotor.time_s + 0.2);
            rotor.lost_steps()
        };
        assert_eq!(lost(0.4223 - CLOSE / 2.0), 0);
        assert!(lost(0.4223 + CLOSE / 2.0) > 0);
    }

    /// The lag of a load is what its torque asks for, and small swings slow down with the root of
    /// the inertia.
    #[test]
    fn it_turns_what_it_is_given() {
        let damped = Motor {
            damping_ratio: 0.3,
            ..FREE
        };
        let mut rotor = Rotor::new(damped);
        rotor.set_load(4.0 * FREE.inertia_kg_m2, 0.2);
        rotor.settle();
        let wanted = 0.5_f64.asin() / FRAC_PI_2;
        assert!((rotor.lag() - wanted).abs() < 1e-6, "{}", rotor.lag());
        assert!((rotor.torque_nm() - 0.2).abs() < 1e-6);
        let mut rotor = Rotor::new(FREE);
        rotor.set_load(4.0 * FREE.inertia_kg_m2, 0.0);
        rotor.step(0.0, 1);
        let half_period_s = 1.0 / FREE.natural_frequency_hz();
        rotor.turn_until(half_period_s);
        let step = 1.0 / f64::from(FREE.microsteps);
        assert!((rotor.position - 2.0 * step).abs() < CLOSE * step);
    }
}
