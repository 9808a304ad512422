//! A board in emulation, with a PC on its serial line.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Lines, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use board_machine::Kinematics;
use proto3964r::{Config, Event, Line, Priority, Station};

use crate::rig::{Kind, Pins};

const BAUD: u32 = 9600;
/// Of a character: 8 data bits, even parity.
const BITS: u8 = 11;
/// The longest that a board may take for an answer.
const PATIENCE: Duration = Duration::from_secs(30);

/// A program that emulates a board: see `firmware/emulate`.
pub struct Emulator {
    process: Child,
    to: ChildStdin,
    from: Lines<BufReader<ChildStdout>>,
}

impl Drop for Emulator {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Emulator {
    fn start(command: &str, from_switches: &[i32]) -> Self {
        let mut words = command.split(' ');
        let mut process = Command::new(words.next().expect("a program"))
            .args(words)
            .arg("0")
            .args(from_switches.iter().map(i32::to_string))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| panic!("{command}: {error}"));
        let to = process.stdin.take().expect("piped");
        let from = BufReader::new(process.stdout.take().expect("piped")).lines();
        Self { process, to, from }
    }

    fn tell(&mut self, line: &str) {
        writeln!(self.to, "{line}").expect("it runs");
    }

    /// A line in words.
    fn hear(&mut self) -> (String, Vec<i64>) {
        let line = self.from.next().expect("it runs").expect("text");
        let (name, numbers) = line.split_once(' ').expect("words");
        let numbers = numbers.split(' ').map(|word| word.parse().unwrap());
        (name.into(), numbers.collect())
    }
}

/// What the pins of one axis do in a time, by a program that nobody talks to: in seconds.
pub fn edges(command: &str, time: Duration) -> Vec<(f64, u8)> {
    let mut emulator = Emulator::start(command, &[1]);
    let (_, hz) = emulator.hear();
    let hz = hz[0] as f64;
    emulator.tell(&format!("run {:.0}", hz * time.as_secs_f64()));
    let mut edges = Vec::new();
    loop {
        let (name, numbers) = emulator.hear();
        if name == "at" {
            return edges;
        }
        edges.push((numbers[0] as f64 / hz, u8::try_from(numbers[1]).unwrap()));
    }
}

pub struct Board<const N: usize> {
    emulator: Emulator,
    cycles_per_tick: u64,
    hz: u64,
    pub cycle: u64,
    pc: Station<192, 80>,
    /// The PC's transmitter is free from this cycle on.
    free: u64,
    /// When the PC's last character has ended.
    sent: u64,
    /// When the last telegram that the board has taken had ended.
    pub told: u64,
    pub is_plugged: bool,
    /// Characters until one that is damaged.
    pub until_damaged: Option<u32>,
    /// The same, until the plug is pulled.
    pub until_unplugged: Option<u32>,
    answers: VecDeque<String>,
    log: Vec<String>,
    /// When the levels have changed, in cycles, and to what.
    pub changes: Vec<(u64, u8)>,
    pub pins: Pins<N>,
    pub events: Vec<String>,
}

impl<const N: usize> Board<N> {
    pub fn start<K: Kinematics<N>>(
        command: &str,
        kind: Kind<K, N>,
        tick_hz: u32,
        from_switches: [i32; N],
    ) -> Self {
        let mut emulator = Emulator::start(command, &from_switches);
        let (_, hz) = emulator.hear();
        let hz = hz[0].unsigned_abs();
        let line = Line::paced(BAUD, BITS);
        Self {
            emulator,
            cycles_per_tick: hz / u64::from(tick_hz),
            hz,
            cycle: 0,
            pc: Station::with_buffers(Config::siemens_3964r(Priority::High, line)),
            free: 0,
            sent: 0,
            told: 0,
            is_plugged: true,
            until_damaged: None,
            until_unplugged: None,
            answers: VecDeque::new(),
            log: Vec::new(),
            pins: Pins::new(&kind, tick_hz, from_switches),
            changes: Vec::new(),
            events: Vec::new(),
        }
    }

    /// The cycles of a time.
    pub fn cycles(&self, time: Duration) -> u64 {
        u64::try_from(time.as_nanos() * u128::from(self.hz) / 1_000_000_000).unwrap()
    }

    pub fn seconds(&self, cycles: u64) -> f64 {
        cycles as f64 / self.hz as f64
    }

    fn time(&self, cycle: u64) -> Duration {
        Duration::from_nanos(
            u64::try_from(u128::from(cycle) * 1_000_000_000 / u128::from(self.hz)).unwrap(),
        )
    }

    /// Sends a command; its first answer.
    pub fn ask(&mut self, command: &str) -> String {
        assert!(self.answers.is_empty(), "not read: {:?}", self.answers);
        self.submit(command.as_bytes());
        self.answer()
    }

    pub fn submit(&mut self, telegram: &[u8]) {
        self.pc.submit(self.time(self.cycle), telegram).unwrap();
    }

    /// The next answer.
    pub fn answer(&mut self) -> String {
        let end = self.cycle + self.cycles(PATIENCE);
        while self.answers.is_empty() && self.cycle < end {
            self.step(end);
        }
        self.answers
            .pop_front()
            .unwrap_or_else(|| panic!("no answer after {:?}, {:?}", self.log, self.events))
    }

    pub fn run(&mut self, time: Duration) {
        let end = self.cycle + self.cycles(time);
        while self.cycle < end {
            self.step(end);
        }
    }

    /// Until the telegram of the PC is taken or given up.
    pub fn run_to_end_of_job(&mut self) {
        let end = self.cycle + self.cycles(PATIENCE);
        while self.pc.is_busy() && self.cycle < end {
            self.step(end);
        }
    }

    /// Forgets what the pins have done so far.
    pub fn forget(&mut self) {
        self.changes.clear();
        self.pins.forget();
    }

    /// Until the pins have begun to move.
    pub fn run_to_edge(&mut self) {
        let end = self.cycle + self.cycles(PATIENCE);
        while self.changes.is_empty() && self.cycle < end {
            self.step(self.cycle + self.cycles(Duration::from_millis(1)));
        }
    }

    pub fn tell(&mut self, line: &str) {
        self.emulator.tell(line);
    }

    /// The motor of an axis loses so many steps, from the next one on.
    pub fn lose(&mut self, axis: usize, steps: u32) {
        self.pins.lose(axis, steps);
        self.tell(&format!("lose {axis} {steps}"));
    }

    /// To a cycle, or to what comes first.
    fn step(&mut self, end: u64) {
        self.transmit();
        let mut next = end;
        if self.free > self.cycle {
            next = next.min(self.free);
        }
        if let Some(due) = self.pc.poll_timeout() {
            next = next.min(self.cycles(due) + 1).max(self.cycle + 1);
        }
        self.emulator.tell(&format!("run {next}"));
        loop {
            let (name, numbers) = self.emulator.hear();
            let cycle = numbers[0].unsigned_abs();
            match name.as_str() {
                "edge" => {
                    let levels = u8::try_from(numbers[1]).unwrap();
                    self.changes.push((cycle, levels));
                    self.pins.set(cycle / self.cycles_per_tick, levels);
                }
                "sent" => self.receive(cycle, u8::try_from(numbers[1]).unwrap()),
                _ => {
                    self.cycle = cycle;
                    let real = numbers[1..].iter().map(|&steps| steps as i32);
                    assert_eq!(
                        self.pins.since_switch().to_vec(),
                        real.collect::<Vec<_>>(),
                        "steps that only one has seen"
                    );
                    break;
                }
            }
        }
        let now = self.time(self.cycle);
        self.pc.handle_timeout(now);
        self.take_events();
    }

    fn receive(&mut self, cycle: u64, byte: u8) {
        if self.is_plugged {
            self.pc.handle_byte(self.time(cycle), byte);
            self.cycle = cycle;
            self.take_events();
        }
    }

    fn take_events(&mut self) {
        while let Some(event) = self.pc.poll_event() {
            match event {
                Event::Received(telegram) => {
                    let text = String::from_utf8(telegram.to_vec()).unwrap();
                    self.log.push(text.clone());
                    self.answers.push_back(text);
                }
                Event::Sent { .. } => self.told = self.sent,
                other => self.events.push(format!("{other:?}")),
            }
        }
    }

    fn transmit(&mut self) {
        let now = self.time(self.cycle);
        if self.free > self.cycle {
            return;
        }
        let Some(byte) = self.pc.poll_transmit_byte(now) else {
            return;
        };
        let character = self.hz * u64::from(BITS) / u64::from(BAUD);
        self.free = self.cycle + character;
        let is_last = |left: &mut Option<u32>| match left {
            Some(0) => left.take().is_some(),
            Some(left) => {
                *left -= 1;
                false
            }
            None => false,
        };
        if is_last(&mut self.until_unplugged) {
            self.is_plugged = false;
        }
        if self.is_plugged {
            let (end, error) = (
                self.free,
                if is_last(&mut self.until_damaged) {
                    " parity"
                } else {
                    ""
                },
            );
            self.emulator.tell(&format!("receive {end} {byte}{error}"));
            self.sent = end;
        }
    }
}
