//! Both boards' firmware in emulation (`firmware/emulate`), edge for edge with the machine on this PC.
//!
//! Runs where `ARM_PICO` and `ARM_NUCLEO` are the commands of the emulators, as `firmware/emulate/run`
//! makes them.

#[path = "../../../rp2040/src/arm.rs"]
mod arm;
mod board;

use std::time::Duration;

use board::Board;

use crate::rig::{Rig, STEPS_PER_TURN, forward};

/// Where each joint is when it is switched on, in steps from its switch.
const FROM_SWITCHES: [i32; 2] = [150, 60];
/// Each joint is within half a step of the path, both links in a row, and the tolerance of the settings
/// on top.
const TOOL_TOLERANCE_MM: f64 = 0.05 + 0.75 * 264.0 * std::f64::consts::TAU / STEPS_PER_TURN;
/// More fast steps than are decided before they are made.
const IN_FLIGHT: u32 = 16;
/// How long a contact bounces.
const BOUNCE: Duration = Duration::from_millis(2);
/// Long and short, near the base and far from it, slow and fast; the last ends where the first began.
const LINES: [&str; 6] = [
    "line -100 150",
    "line -40 60 200",
    "line 20 70",
    "line 21 70",
    "line 240 40",
    "line 60 150 40",
];
/// From the end of a telegram to the first edge.
const MOST_UNTIL_EDGE_S: f64 = 0.25;

/// A board, the variable that has the command of its emulator, and its ticks.
struct Kind {
    variable: &'static str,
    tick_hz: u32,
}

const PICO: Kind = Kind {
    variable: "ARM_PICO",
    tick_hz: 12_500_000,
};
const NUCLEO: Kind = Kind {
    variable: "ARM_NUCLEO",
    tick_hz: 250_000,
};

/// A board with the same machine on this PC beside it.
struct Pair {
    board: Board,
    rig: Rig,
    tick_hz: u32,
    cycles_per_tick: u64,
    compared: usize,
}

impl Pair {
    fn new(kind: &Kind) -> Option<Self> {
        let command = std::env::var(kind.variable).ok()?;
        let board = Board::start(&command, kind.tick_hz, FROM_SWITCHES);
        let rig = Rig::with_settings(&arm::SETTINGS, kind.tick_hz, FROM_SWITCHES);
        Some(Self {
            tick_hz: kind.tick_hz,
            cycles_per_tick: board.cycles(Duration::from_secs(1)) / u64::from(kind.tick_hz),
            board,
            rig,
            compared: 0,
        })
    }

    /// A motion by both: the same answers, the same levels at the same intervals.
    fn moves_alike(&mut self, command: &str) {
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
            until_edge <= MOST_UNTIL_EDGE_S,
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
        assert_eq!(self.board.ask("line 60 150"), "refused: not homed");
        self.board.forget();
        assert_eq!(self.board.ask("home"), self.rig.ask("home"));
        self.assert_home();
        self.assert_homing_rates();
        self.assert_where();
    }

    /// Each joint is on the step that has closed its switch.
    fn assert_home(&self) {
        assert_eq!(self.board.pins.since_switch(), [0, 0]);
    }

    fn assert_homing_rates(&self) {
        let ticks = |hz| u64::from(self.tick_hz / hz);
        let (fast, slow) = (
            ticks(arm::SETTINGS.homing_fast_hz),
            ticks(arm::SETTINGS.homing_slow_hz),
        );
        for joint in 0..2 {
            let made = self.board.pins.made.iter();
            let made: Vec<_> = made.filter(|made| made.joint == joint).collect();
            let intervals = made.windows(2).map(|pair| pair[1].ticks - pair[0].ticks);
            let mut slow_steps = 0;
            for interval in intervals {
                assert!(
                    interval == fast || interval == slow,
                    "joint {joint} steps after {interval} ticks, not after {fast} or {slow}"
                );
                slow_steps += u32::from(interval == slow);
            }
            // Back beyond the switch, and by what had been on its way.
            let clear = arm::SETTINGS.homing[joint].clear_steps;
            assert!(
                (clear..clear + IN_FLIGHT).contains(&slow_steps),
                "{slow_steps} slow steps"
            );
        }
    }

    /// A line that is held and resumed stays on the line.
    fn holds(&mut self) {
        let (start, to) = (self.tool(), [200.0, -60.0]);
        self.board.forget();
        assert!(self.board.ask("line 200 -60").starts_with("ok, "));
        self.board.run_to_edge();
        self.board.run(Duration::from_millis(300));
        assert_eq!(self.board.ask("hold"), "ok");
        let held = self.board.answer();
        assert!(held.starts_with("held, "), "{held}");
        self.board.pins.assert_slow_end();
        self.assert_where();
        assert_eq!(self.board.ask("line 0 100"), "refused: held");
        assert_eq!(self.board.ask("resume"), "ok");
        assert!(self.board.answer().starts_with("done, "));
        self.board.pins.assert_on_line(start, to, TOOL_TOLERANCE_MM);
        self.board.pins.assert_driver_times();
        self.assert_where();
    }

    /// A line that is stopped ends on the line, and the board knows where.
    fn stops(&mut self) {
        let (start, to) = (self.tool(), [60.0, 150.0]);
        self.board.forget();
        assert!(self.board.ask("line 60 150").starts_with("ok, "));
        self.board.run_to_edge();
        self.board.run(Duration::from_millis(250));
        assert_eq!(self.board.ask("stop"), "ok");
        let stopped = self.board.answer();
        assert!(stopped.starts_with("stopped, "), "{stopped}");
        self.board.pins.assert_slow_end();
        self.board.pins.assert_on_line(start, to, TOOL_TOLERANCE_MM);
        self.assert_where();
    }

    /// What is refused is refused alike, and nothing moves.
    fn refuses_alike(&mut self) {
        self.board.forget();
        for command in [
            "limits",
            "line 400 0",
            "line 0 0",
            "jog elbow 200",
            "resume",
            "lime",
        ] {
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
        self.board.submit(b"jog elbow 5");
        self.board.run_to_end_of_job();
        assert!(!self.board.is_plugged);
        self.board.is_plugged = true;
        self.board.events.clear();
        assert_eq!(self.board.changes, []);
        self.assert_where();
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
        assert!(self.board.ask("jog shoulder 90").starts_with("ok, "));
        self.board.run(Duration::from_millis(150));
        self.board.tell("power");
        self.board.forget();
        self.board.run(Duration::from_millis(300));
        assert!(self.board.pins.made.is_empty(), "steps without a command");
        assert_eq!(
            self.board.ask("status"),
            "not homed, feed 100 %, 0 underruns"
        );
        assert_eq!(self.board.ask("line 60 150"), "refused: not homed");
    }

    fn tool(&self) -> [f64; 2] {
        forward(self.board.pins.joints())
    }

    fn assert_where(&mut self) {
        let [shoulder, elbow] = self.board.pins.steps;
        let place = self.board.ask("where");
        assert!(
            place.ends_with(&format!("steps {shoulder} {elbow}")),
            "{place}, steps {shoulder} {elbow} by the pins"
        );
    }
}

fn a_day(kind: &Kind) {
    let Some(mut pair) = Pair::new(kind) else {
        return;
    };
    pair.homes();
    pair.moves_alike("jog shoulder 60");
    pair.moves_alike("line 60 150");
    for line in 0..more_lines() {
        pair.moves_alike(LINES[line % LINES.len()]);
    }
    pair.refuses_alike();
    pair.holds();
    pair.stops();
    pair.bears_a_bad_line();
    assert_eq!(pair.board.ask("status"), "ready, feed 100 %, 0 underruns");
    pair.homes_with_bouncing_switches();
    pair.starts_again();
    eprintln!("{} edges alike", pair.compared);
}

/// How many of [`LINES`] are run, one after the other, besides: `BOARD_LINES`.
fn more_lines() -> usize {
    std::env::var("BOARD_LINES").map_or(0, |lines| lines.parse().expect("a number"))
}

#[test]
fn a_day_of_the_pico() {
    a_day(&PICO);
}

#[test]
fn a_day_of_the_nucleo() {
    a_day(&NUCLEO);
}
