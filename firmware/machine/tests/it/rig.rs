//! An arm on a desk: its firmware, a PC on its serial line, pins that are looked at, and switches.

mod kind;
mod pins;
mod wire;

use std::collections::VecDeque;
use std::pin::Pin;
use std::task::{Context, Waker};
use std::time::{Duration, Instant};

use board_machine::{Kinematics, Machine, Motion, Panel, PlanMemory, Source, State, talk};
use proto3964r::{CharacterError, Config, Event, Line, Priority, Station};
use scara_kin::nalgebra::Point2;
use scara_kin::{Arm, Elbow, Joints};

pub use kind::{ARM, DELTA, Kind, STAGE};
pub use pins::Pins;
use pins::Slides;
use wire::Wire;

pub const STEPS_PER_TURN: f64 = 16_000.0;
pub const TICK_HZ: u32 = 1_000_000;
/// -90 and 20 degrees.
pub const HOME_STEPS: [i32; 2] = [-4000, 889];
/// -30 and 20 degrees.
pub const START_STEPS: [i32; 2] = [-1333, 889];
pub const LINKS_MM: [f64; 2] = [132.0, 132.0];
pub const SPEED_DEG_S: f64 = 180.0;
pub const ACCELERATION_DEG_S2: f64 = 1500.0;

/// Looks at all tasks before something else happens: enough for a command and its answer.
const ROUNDS: usize = 60;
/// Blocks of the longest homing.
const MOST_BLOCKS: usize = 100_000;

pub fn forward(joints: [f64; 2]) -> [f64; 2] {
    let point = arm().forward(Joints::new(joints[0], joints[1]));
    [point.x, point.y]
}

pub fn joints_of(tool: [f64; 2]) -> [f64; 2] {
    let joints = arm()
        .inverse_elbow(Point2::from(tool), Elbow::Right)
        .unwrap();
    [joints.shoulder, joints.elbow]
}

pub fn arm() -> Arm {
    Arm::new(LINKS_MM[0], LINKS_MM[1]).unwrap()
}

type Task = Pin<Box<dyn Future<Output = ()>>>;

pub struct Rig<const N: usize> {
    panel: &'static Panel<N>,
    tasks: [Task; 2],
    pc: Station<192, 64>,
    to_firmware: Wire,
    from_firmware: Wire,
    answers: VecDeque<String>,
    log: Vec<String>,
    /// Whether the PC listens to nothing once its telegram is taken, and whether that is so by now.
    deaf: (bool, bool),
    start: Instant,
    pub pins: Pins<N>,
}

impl<const N: usize> Rig<N> {
    /// A machine whose axes are so many steps from their switches.
    pub fn of<K: Kinematics<N> + 'static>(
        kind: Kind<K, N>,
        tick_hz: u32,
        from_switches: [i32; N],
    ) -> Self {
        let panel: &Panel<N> = Box::leak(Box::new(Panel::new()));
        let machine = Machine::new(kind.settings, tick_hz).unwrap();
        let machine: &Machine<K, N> = Box::leak(Box::new(machine));
        let pins = Pins::new(&kind, tick_hz, from_switches);
        let (to_firmware, from_firmware) = (Wire::default(), Wire::default());

        let inputs: &Slides<N> = Box::leak(Box::new(pins.slides()));
        let memory = Box::leak(Box::new(PlanMemory::new()));
        let motion = Motion::new(machine, panel, inputs, memory).unwrap();
        let plan = async move {
            motion.run().await;
        };
        let port = (to_firmware.clone(), from_firmware.clone());
        let converse = async move {
            talk(machine, panel, inputs, Line::Instant, port, |_| {
                Some(CharacterError::Parity)
            })
            .await;
        };
        Self {
            panel,
            tasks: [Box::pin(plan), Box::pin(converse)],
            pc: Station::with_buffers(Config::siemens_3964r(Priority::High, Line::Instant)),
            to_firmware,
            from_firmware,
            answers: VecDeque::new(),
            log: Vec::new(),
            deaf: (false, false),
            start: Instant::now(),
            pins,
        }
    }
}

impl Rig<2> {
    /// The arm, so many steps from its switches.
    pub fn new(from_switches: [i32; 2]) -> Self {
        Self::of(ARM, TICK_HZ, from_switches)
    }

    /// The arm at home, and away from the end of the shoulder's range.
    pub fn homed() -> Self {
        let mut rig = Self::new([3, 3]);
        let answer = rig.ask("home");
        assert!(answer.starts_with("done, "), "{answer}");
        assert_eq!(rig.pins.steps, HOME_STEPS);
        assert!(rig.ask("jog shoulder 60").starts_with("ok, "));
        assert!(rig.answer().starts_with("done, "));
        assert_eq!(rig.pins.steps, START_STEPS);
        rig.pins.forget();
        rig
    }
}

impl<const N: usize> Rig<N> {
    pub fn panel(&self) -> &Panel<N> {
        self.panel
    }

    pub fn log(&self) -> &[String] {
        &self.log
    }

    /// Sends a command; its first answer.
    pub fn ask(&mut self, command: &str) -> String {
        assert_eq!(self.answers, [""; 0], "answers that nobody has read");
        self.pc.submit(self.now(), command.as_bytes()).unwrap();
        self.answer()
    }

    /// The next answer; the pins play when there is none yet.
    pub fn answer(&mut self) -> String {
        for _ in 0..MOST_BLOCKS {
            self.work();
            if let Some(answer) = self.answers.pop_front() {
                return answer;
            }
            self.play_block();
        }
        panic!("no answer after {:?}", self.log);
    }

    /// Gives a command whose motion ends before the PC listens to its first answer.
    pub fn submit_unheard(&mut self, command: &str) {
        self.pc.submit(self.now(), command.as_bytes()).unwrap();
        self.deaf = (true, false);
        self.work();
        while self.play_block() {
            self.work();
        }
        self.deaf = (false, false);
    }

    pub fn play_blocks(&mut self, count: usize) {
        for _ in 0..count {
            self.work();
            assert!(self.play_block(), "no block after {:?}", self.log);
        }
    }

    /// Plays up to so many blocks; whether there are more.
    pub fn plays_blocks(&mut self, count: usize) -> bool {
        for _ in 0..count {
            self.work();
            if !self.play_block() {
                return false;
            }
        }
        self.panel.state() == State::Moving
    }

    /// Plays what there is, while the planner does nothing.
    pub fn starve(&mut self) {
        let mut end = None;
        while let Some(block) = self.panel.try_next_block() {
            self.pins.play(&block);
            self.panel.played(block.end);
            end = Some(block.end);
        }
        self.panel.ran_out_after(end.expect("a block"));
    }

    fn play_block(&mut self) -> bool {
        let Some(block) = self.panel.try_next_block() else {
            return false;
        };
        self.pins.play(&block);
        self.panel.played(block.end);
        self.work();
        if self.panel.has_no_block() {
            self.panel.ran_out_after(block.end);
        }
        true
    }

    /// All tasks as far as they go.
    fn work(&mut self) {
        for _ in 0..ROUNDS {
            let mut context = Context::from_waker(Waker::noop());
            for task in &mut self.tasks {
                assert!(
                    task.as_mut().poll(&mut context).is_pending(),
                    "a task ended"
                );
            }
            self.exchange();
        }
    }

    /// The PC's side of the line.
    fn exchange(&mut self) {
        let now = self.now();
        if self.deaf.1 {
            return;
        }
        while let Some(byte) = self.pc.poll_transmit_byte(now) {
            self.to_firmware.push(byte);
        }
        while let Some(byte) = self.from_firmware.pop() {
            self.pc.handle_byte(now, byte);
        }
        self.pc.handle_timeout(now);
        while let Some(event) = self.pc.poll_event() {
            match event {
                Event::Received(telegram) => {
                    let answer = String::from_utf8(telegram.to_vec()).unwrap();
                    self.log.push(answer.clone());
                    self.answers.push_back(answer);
                }
                Event::Sent { .. } => self.deaf.1 = self.deaf.0,
                _ => {}
            }
        }
    }

    fn now(&self) -> Duration {
        self.start.elapsed()
    }
}
