//! Pins that are looked at, and what hangs on them.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::rc::Rc;

use board_machine::Block;

use super::{ACCELERATION_DEG_S2, HOME_STEPS, STEPS_PER_TURN, forward};

/// Of a DRV8825.
const PULSE_NS: u64 = 1900;
const SETUP_NS: u64 = 650;
/// Speeds near a rest are those between two steps, from half a step to one and a half away.
const SPEED_MARGIN: f64 = 1.2;

/// A step: when its pulse began, and which.
#[derive(Clone, Copy, Debug)]
pub struct Made {
    pub ticks: u64,
    pub joint: usize,
    pub sign: i32,
    /// Of both joints, after it.
    pub steps: [i32; 2],
}

pub struct Pins {
    tick_hz: u32,
    levels: u8,
    pub ticks: u64,
    pub steps: [i32; 2],
    from_switches: Rc<Cell<[i32; 2]>>,
    pub made: Vec<Made>,
    /// When the levels have changed, and to what.
    pub changes: Vec<(u64, u8)>,
    /// Time and bit of each edge.
    edges: Vec<(u64, u8, bool)>,
}

impl Pins {
    pub fn new(tick_hz: u32, from_switches: Rc<Cell<[i32; 2]>>) -> Self {
        let away = from_switches.get();
        Self {
            tick_hz,
            levels: 0,
            ticks: 0,
            steps: [0, 1].map(|joint| HOME_STEPS[joint] + away[joint]),
            from_switches,
            made: Vec::new(),
            changes: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// Steps from the places where the switches close.
    pub fn since_switch(&self) -> [i32; 2] {
        self.from_switches.get()
    }

    /// Forgets what has been seen so far.
    pub fn forget(&mut self) {
        self.made.clear();
        self.changes.clear();
        self.edges.clear();
    }

    pub fn joints(&self) -> [f64; 2] {
        self.steps.map(angle)
    }

    pub fn play(&mut self, block: &Block) {
        assert!(!block.words.is_empty(), "an empty block");
        for word in &block.words {
            assert!(word.ticks > 0, "a word of no time");
            self.set(self.ticks + u64::from(word.ticks), word.levels);
        }
    }

    /// The levels of all pins from a tick on.
    pub fn set(&mut self, ticks: u64, levels: u8) {
        self.ticks = ticks;
        let changed = levels ^ self.levels;
        self.levels = levels;
        if changed != 0 {
            self.changes.push((ticks, levels));
        }
        for bit in (0..4).filter(|bit| changed >> bit & 1 == 1) {
            let high = levels >> bit & 1 == 1;
            self.edges.push((ticks, bit, high));
            if bit % 2 == 0 && high {
                self.step(usize::from(bit / 2));
            }
        }
    }

    fn step(&mut self, joint: usize) {
        let sign = if self.levels >> (2 * joint + 1) & 1 == 1 {
            1
        } else {
            -1
        };
        self.steps[joint] += sign;
        let mut from_switches = self.from_switches.get();
        from_switches[joint] += sign;
        self.from_switches.set(from_switches);
        self.made.push(Made {
            ticks: self.ticks,
            joint,
            sign,
            steps: self.steps,
        });
    }

    /// All steps since `forget` are near a line of the tool.
    pub fn assert_on_line(&self, from: [f64; 2], to: [f64; 2], tolerance_mm: f64) {
        assert!(self.made.len() > 100, "nothing has moved");
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        for made in &self.made {
            let [x, y] = forward(made.steps.map(angle));
            let (dx, dy) = (x - from[0], y - from[1]);
            let off = (dx * way[1] - dy * way[0]).abs() / length;
            let along = (dx * way[0] + dy * way[1]) / length;
            assert!(off <= tolerance_mm, "{off} mm off the line at {made:?}");
            let range = -tolerance_mm..=length + tolerance_mm;
            assert!(
                range.contains(&along),
                "{along} mm along the line at {made:?}"
            );
        }
    }

    /// Towards the last step each joint has been no faster than it can brake.
    pub fn assert_slow_end(&self) {
        let acceleration = ACCELERATION_DEG_S2 / 360.0 * STEPS_PER_TURN;
        for joint in 0..2 {
            let steps: Vec<_> = self
                .made
                .iter()
                .filter(|made| made.joint == joint)
                .collect();
            let tail = steps.windows(2).rev().take(50);
            for (left, pair) in tail.enumerate() {
                let ticks = (pair[1].ticks - pair[0].ticks) as f64;
                let speed = f64::from(self.tick_hz) / ticks;
                let max = (2.0 * acceleration * (left as f64 + 2.0)).sqrt() * SPEED_MARGIN;
                assert!(speed <= max, "{speed} steps/s, {left} steps before the end");
            }
        }
    }

    /// What a driver asks for.
    pub fn assert_driver_times(&self) {
        let ticks = |ns: u64| (ns * u64::from(self.tick_hz)).div_ceil(1_000_000_000);
        let (setup, pulse) = (ticks(SETUP_NS), ticks(PULSE_NS));
        for joint in 0..2 {
            let (mut rise, mut turn) = (None, None);
            for &(ticks, bit, high) in self.edges.iter().filter(|edge| edge.1 / 2 == joint) {
                let since = |before: Option<u64>| before.map_or(u64::MAX, |before| ticks - before);
                match (bit % 2, high) {
                    (0, true) => {
                        assert!(since(rise) >= 2 * pulse, "steps too near at {ticks}");
                        assert!(since(turn) >= setup, "direction too late at {ticks}");
                        rise = Some(ticks);
                    }
                    (0, false) => assert!(since(rise) >= pulse, "short pulse at {ticks}"),
                    _ => {
                        assert!(since(rise) >= setup, "direction too early at {ticks}");
                        turn = Some(ticks);
                    }
                }
            }
        }
    }
}

fn angle(steps: i32) -> f64 {
    f64::from(steps) / STEPS_PER_TURN * TAU
}
