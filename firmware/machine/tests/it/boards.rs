//! Both boards' firmware in emulation (`firmware/emulate`), edge for edge with the machine on this
//! PC.
//!
//! Runs where `ARM_PICO`, `DELTA_NUCLEO` and so on are the commands of the emulators, as
//! `firmware/emulate/run` makes them.

mod board;

use std::time::Duration;

use board::Board;
use board_machine::{Axis, Kinematics, RotaryDelta, TwoLinkArm, XyStage};

use crate::rig::{ARM, DELTA, Kind, Rig, STAGE};

/// More fast steps than are decided before they are made.
const IN_FLIGHT: u32 = 16;
/// How long a contact bounces.
const BOUNCE: Duration = Duration::from_millis(2);
/// Steps that a motor loses.
const LOST: u32 = 7;

/// What a machine is asked on its day.
struct Day<K: Kinematics<N> + 'static, const N: usize> {
    kind: Kind<K, N>,
    /// Where each axis is when it is switched on, in steps from its switch.
    from_switches: [i32; N],
    /// From home away.
    begin: &'static [&'static str],
    /// Long and short, near and far, slow and fast; the last ends where `begin` does.
    lines: &'static [&'static str],
    /// What it refuses, or only answers.
    refused: &'static [&'static str],
    held: ([f64; N], &'static str),
    stopped: ([f64; N], &'static str),
    /// A longer way of an axis, and a shorter one.
    jogs: [&'static str; 2],
    /// From the end of a telegram to the first edge, on the Pico and on the Nucleo.
    most_until_edge_s: [f64; 2],
    /// How many times as long it takes on [`lines`](Self::lines), some twice as far as the others.
    longer: f64,
    /// Whether the Nucleo counts its scales.
    has_scales: bool,
}

const ARM_DAY: Day<TwoLinkArm, 2> = Day {
    kind: ARM,
    from_switches: [150, 60],
    begin: &["jog shoulder 60", "line 60 150"],
    lines: &[
        "line -100 150",
        "line -40 60 200",
        "line 20 70",
        "line 21 70",
        "line 240 40",
        "line 60 150 40",
    ],
    refused: &[
        "machine",
        "limits",
        "scales",
        "line 400 0",
        "line 0 0",
        "jog elbow 200",
        "resume",
        "lime",
    ],
    held: ([200.0, -60.0], "line 200 -60"),
    stopped: ([60.0, 150.0], "line 60 150"),
    jogs: ["jog shoulder 90", "jog elbow 5"],
    most_until_edge_s: [0.22, 0.1],
    longer: 1.0,
    has_scales: false,
};

const DELTA_DAY: Day<RotaryDelta, 3> = Day {
    kind: DELTA,
    from_switches: [-150, -60, -30],
    begin: &["jog arm3 -10", "line 0 0 -250", "line 90 -40 -260 250"],
    lines: &[
        "line 90 -40 -290 60",
        "line -70 40 -260",
        "line -70 41 -260",
        "line 0 -90 -280 200",
        "line 90 -40 -260 40",
    ],
    refused: &[
        "machine",
        "limits",
        "scales",
        "line 0 0 -400",
        "jog arm2 200",
        "cw 1 2 3 4",
        "resume",
    ],
    held: ([-70.0, 40.0, -270.0], "line -70 40 -270 100"),
    stopped: ([90.0, -40.0, -260.0], "line 90 -40 -260 100"),
    jogs: ["jog arm1 -30", "jog arm1 5"],
    most_until_edge_s: [0.22, 0.1],
    longer: 1.4,
    has_scales: false,
};

const STAGE_DAY: Day<XyStage, 2> = Day {
    kind: STAGE,
    from_switches: [150, 60],
    begin: &["jog x 20", "line 20 50", "ccw 60 90 40 0"],
    lines: &[
        "cw 100 50 0 -40 30",
        "line 20.01 50.02 20",
        "line 20 50",
        "ccw 20 50 40 0",
        "cw 60 90 40 0 40",
    ],
    refused: &[
        "machine",
        "limits",
        "scales",
        "line 400 0",
        "ccw 0 0 7 7",
        "jog y 200",
        "resume",
        "lime",
    ],
    held: ([100.0, 20.0], "line 100 20"),
    stopped: ([20.0, 50.0], "line 20 50"),
    jogs: ["jog x 20", "jog x 5"],
    most_until_edge_s: [0.2, 0.1],
    longer: 1.0,
    has_scales: true,
};

/// A board with the same machine on this PC beside it.
struct Pair<K: Kinematics<N> + 'static, const N: usize> {
    day: Day<K, N>,
    board: Board<N>,
    rig: Rig<N>,
    tick_hz: u32,
    cycles_per_tick: u64,
    most_until_edge_s: f64,
    compared: usize,
}

impl<K: Kinematics<N> + 'static, const N: usize> Pair<K, N> {
    /// With the command of an emulator.
    fn new(day: Day<K, N>, command: &str, tick_hz: u32, most_until_edge_s: f64) -> Self {
        let board = Board::start(command, day.kind, tick_hz, day.from_switches);
        let rig = Rig::of(day.kind, tick_hz, day.from_switches);
        if day.has_scales {
            rig.pins.count_scales();
        }
        Self {
            tick_hz,
            cycles_per_tick: board.cycles(Duration::from_secs(1)) / u64::from(tick_hz),
            board,
            rig,
            day,
            most_until_edge_s,
            compared: 0,
        }
    }

    /// A motion by both: the same answers, the same levels at the same intervals.
    fn moves_alike(&mut self, command: &str, most_until_edge_s: f64) {
        self.board.forget();
        self.rig.pins.forget();
        let begun = self.rig.ask(command);
        let ended = self.rig.answer();
        assert!(ended.starts_with("done, "), "{command}: {begun}, {ended}");
        assert_eq!(self.board.ask(command), begun);
        assert_eq!(self.board.answer(), ended);
        let until_edge = self
            .board
            .seconds(self.board.changes[0].0 - self.board.told);
        assert!(
            until_edge <= most_until_edge_s,
            "{command}: the first edge comes after {until_edge} s"
        );
        eprintln!("{command}: first edge after {until_edge:.3} s, {ended}");
        self.compare(command);
    }

    fn compare(&mut self, command: &str) {
        let (real, planned) = (&self.board.changes, &self.rig.pins.changes);
        let (start, begin) = (real[0].0, planned[0].0);
        for (index, (real, planned)) in real.iter().zip(planned).enumerate() {
            let real = (real.0 - start, real.1);
            let planned = ((planned.0 - begin) * self.cycles_per_tick, planned.1);
            assert_eq!(real, planned, "edge {index} of {command}, in cycles");
        }
        assert_eq!(real.len(), planned.len(), "edges of {command}");
        self.compared += real.len();
        assert_eq!(self.board.pins.steps, self.rig.pins.steps);
        self.board.pins.assert_driver_times();
    }

    /// Both find home, at the rates of the settings and where the switches have closed.
    fn homes(&mut self) {
        assert_eq!(self.board.ask(self.day.held.1), "refused: not homed");
        self.board.forget();
        assert_eq!(self.board.ask("home"), self.rig.ask("home"));
        self.assert_home();
        self.assert_homing_rates();
        self.assert_where();
    }

    /// Each axis is on the step that has closed its switch.
    fn assert_home(&self) {
        assert_eq!(self.board.pins.since_switch(), [0; N]);
    }

    fn assert_homing_rates(&self) {
        let ticks = |hz| u64::from(self.tick_hz / hz);
        let settings = self.day.kind.settings;
        let (fast, slow) = (
            ticks(settings.homing_fast_hz),
            ticks(settings.homing_slow_hz),
        );
        for axis in 0..N {
            let made = self.board.pins.made.iter();
            let made: Vec<_> = made.filter(|made| made.axis == axis).collect();
            let intervals = made.windows(2).map(|pair| pair[1].ticks - pair[0].ticks);
            let mut slow_steps = 0;
            for interval in intervals {
                assert!(
                    interval == fast || interval == slow,
                    "axis {axis} steps after {interval} ticks, not after {fast} or {slow}"
                );
                slow_steps += u32::from(interval == slow);
            }
            // Back beyond the switch, and by what had been on its way.
            let clear = settings.axes[axis].homing().clear_steps;
            assert!(
                (clear..clear + IN_FLIGHT).contains(&slow_steps),
                "{slow_steps} slow steps"
            );
        }
    }

    /// A line that is held and resumed stays on the line.
    fn holds(&mut self) {
        let (start, (to, line)) = (self.board.pins.tool(), self.day.held);
        self.board.forget();
        assert!(self.board.ask(line).starts_with("ok, "));
        self.board.run_to_edge();
        self.board.run(Duration::from_millis(300));
        assert_eq!(self.board.ask("hold"), "ok");
        let held = self.board.answer();
        assert!(held.starts_with("held, "), "{held}");
        self.board.pins.assert_slow_end();
        self.assert_where();
        assert_eq!(self.board.ask(line), "refused: held");
        assert_eq!(self.board.ask("resume"), "ok");
        assert!(self.board.answer().starts_with("done, "));
        self.board
            .pins
            .assert_on_line(start, to, self.day.kind.tolerance_mm);
        self.board.pins.assert_driver_times();
        self.assert_where();
    }

    /// A line that is stopped ends on the line, and the board knows where.
    fn stops(&mut self) {
        let (start, (to, line)) = (self.board.pins.tool(), self.day.stopped);
        self.board.forget();
        assert!(self.board.ask(line).starts_with("ok, "));
        self.board.run_to_edge();
        self.board.run(Duration::from_millis(250));
        assert_eq!(self.board.ask("stop"), "ok");
        let stopped = self.board.answer();
        assert!(stopped.starts_with("stopped, "), "{stopped}");
        self.board.pins.assert_slow_end();
        self.board
            .pins
            .assert_on_line(start, to, self.day.kind.tolerance_mm);
        self.assert_where();
    }

    /// What is refused is refused alike, and nothing moves.
    fn refuses_alike(&mut self) {
        self.board.forget();
        for command in self.day.refused {
            let answer = self.board.ask(command);
            assert_eq!(answer, self.rig.ask(command), "{command}");
        }
        assert_eq!(self.board.changes, []);
    }

    /// Damage to the line harms neither the machine nor the telegram after it.
    fn bears_a_bad_line(&mut self) {
        self.board.forget();
        self.board.submit(&[b'x'; 65]);
        self.board.run_to_end_of_job();
        let events = core::mem::take(&mut self.board.events);
        assert!(
            events.iter().any(|event| event.starts_with("Failed")),
            "a telegram of 65 bytes is taken: {events:?}"
        );
        // In the middle of the telegram: it is sent again.
        self.board.until_damaged = Some(4);
        self.assert_where();
        assert_eq!(self.board.until_damaged, None);
        self.board.until_unplugged = Some(4);
        self.board.submit(self.day.jogs[1].as_bytes());
        self.board.run_to_end_of_job();
        assert!(!self.board.is_plugged);
        self.board.is_plugged = true;
        self.board.events.clear();
        assert_eq!(self.board.changes, []);
        self.assert_where();
    }

    /// Lost steps are made again at the end of a motion, and a motor that stalls stops the machine.
    fn closes_its_loops(&mut self) {
        let jog = self.day.jogs[1];
        assert!(self.board.ask(jog).starts_with("ok, "));
        self.board.lose(0, LOST);
        let done = self.board.answer();
        assert!(done.starts_with("done, "), "{done}");
        let home = self.day.kind.home_steps;
        let slides = self.board.pins.since_switch();
        let steps: [_; N] = std::array::from_fn(|axis| format!(" {}", slides[axis] + home[axis]));
        let place = self.board.ask("where");
        assert!(
            place.ends_with(&format!("steps{}", steps.concat())),
            "{place}, not {steps:?}"
        );
        let scales = self.board.ask("scales");
        assert!(
            scales.ends_with(&format!("corrected {LOST} 0 steps")),
            "{scales}"
        );
        assert!(self.board.ask(self.day.jogs[0]).starts_with("ok, "));
        self.board.lose(0, u32::MAX);
        let failed = self.board.answer();
        let expected = "failed, home again: x is -";
        assert!(failed.starts_with(expected), "{failed}");
        self.board.lose(0, 0);
        assert_eq!(self.board.ask(jog), "refused: not homed");
    }

    /// A switch that bounces is found where it closes.
    fn homes_with_bouncing_switches(&mut self) {
        let cycles = self.board.cycles(BOUNCE);
        self.board.tell(&format!("bounce {cycles}"));
        self.board.forget();
        let answer = self.board.ask("home");
        assert!(answer.starts_with("done, "), "{answer}");
        self.assert_home();
        assert_eq!(self.board.ask("status"), "ready, feed 100 %, 0 underruns");
    }

    /// After a loss of supply in the middle of a motion the pins rest, and the board asks for home.
    fn starts_again(&mut self) {
        assert!(self.board.ask(self.day.jogs[0]).starts_with("ok, "));
        self.board.run(Duration::from_millis(150));
        self.board.tell("power");
        self.board.forget();
        self.board.run(Duration::from_millis(300));
        assert!(self.board.pins.made.is_empty(), "steps without a command");
        assert_eq!(
            self.board.ask("status"),
            "not homed, feed 100 %, 0 underruns"
        );
        assert_eq!(self.board.ask(self.day.held.1), "refused: not homed");
    }

    fn assert_where(&mut self) {
        let steps = self.board.pins.steps.map(|steps| format!(" {steps}"));
        let place = self.board.ask("where");
        assert!(
            place.ends_with(&format!("steps{}", steps.concat())),
            "{place}, steps{} by the pins",
            steps.concat()
        );
    }

    fn run(mut self) {
        self.homes();
        for command in self.day.begin {
            self.moves_alike(command, self.most_until_edge_s);
        }
        let most_until_edge_s = self.most_until_edge_s * self.day.longer;
        for line in 0..more_lines() {
            let command = self.day.lines[line % self.day.lines.len()];
            self.moves_alike(command, most_until_edge_s);
        }
        self.refuses_alike();
        self.holds();
        self.stops();
        self.bears_a_bad_line();
        assert_eq!(self.board.ask("status"), "ready, feed 100 %, 0 underruns");
        if self.day.has_scales {
            self.closes_its_loops();
        }
        self.homes_with_bouncing_switches();
        self.starts_again();
        eprintln!("{} edges alike", self.compared);
    }
}

/// A day of a machine on the Pico, and on the Nucleo, where the variables have their emulators'
/// commands.
fn on_the_pico<K: Kinematics<N> + 'static, const N: usize>(mut day: Day<K, N>, variable: &str) {
    if let Ok(command) = std::env::var(variable) {
        day.has_scales = false;
        let most_until_edge_s = day.most_until_edge_s[0];
        Pair::new(day, &command, 12_500_000, most_until_edge_s).run();
    }
}

fn on_the_nucleo<K: Kinematics<N> + 'static, const N: usize>(day: Day<K, N>, variable: &str) {
    if let Ok(command) = std::env::var(variable) {
        let most_until_edge_s = day.most_until_edge_s[1];
        Pair::new(day, &command, 250_000, most_until_edge_s).run();
    }
}

/// How many of [`Day::lines`] are run, one after the other, besides: `BOARD_LINES`.
fn more_lines() -> usize {
    std::env::var("BOARD_LINES").map_or(0, |lines| lines.parse().expect("a number"))
}

#[test]
fn a_day_of_the_arm_on_the_pico() {
    on_the_pico(ARM_DAY, "ARM_PICO");
}

#[test]
fn a_day_of_the_arm_on_the_nucleo() {
    on_the_nucleo(ARM_DAY, "ARM_NUCLEO");
}

#[test]
fn a_day_of_the_delta_on_the_pico() {
    on_the_pico(DELTA_DAY, "DELTA_PICO");
}

#[test]
fn a_day_of_the_delta_on_the_nucleo() {
    on_the_nucleo(DELTA_DAY, "DELTA_NUCLEO");
}

#[test]
fn a_day_of_the_stage_on_the_pico() {
    on_the_pico(STAGE_DAY, "STAGE_PICO");
}

#[test]
fn a_day_of_the_stage_on_the_nucleo() {
    on_the_nucleo(STAGE_DAY, "STAGE_NUCLEO");
}

/// The example of `step-player`: 1000 steps a second, of pulses so long. At the internal oscillator
/// the Nucleo has fewer cycles a second than its emulator says.
fn trains(variable: &str, pulse_s: f64, slower: f64) {
    let Ok(command) = std::env::var(variable) else {
        return;
    };
    let edges = board::edges(&command, Duration::from_millis(20));
    // From the first pulse on: direction and step together, then the step's end.
    assert!(edges.len() > 6, "{edges:?}");
    for pair in edges.windows(2) {
        let [(from, levels), (to, _)] = [pair[0], pair[1]];
        let expected = match levels {
            0b11 => pulse_s,
            0b10 => 0.001 - pulse_s,
            _ => panic!("levels {levels:#b}"),
        };
        let took = (to - from) * slower;
        assert!((took - expected).abs() < 1e-9, "{took} s, not {expected} s");
    }
}

#[test]
fn a_step_train_of_the_pico() {
    trains("TRAIN_PICO", 2e-6, 1.0);
}

#[test]
fn a_step_train_of_the_nucleo() {
    trains("TRAIN_NUCLEO", 20e-6, 84.0 / 16.0);
}
