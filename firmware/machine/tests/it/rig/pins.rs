//! Pins that are looked at, and what hangs on them.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::rc::Rc;

use board_machine::{Block, Kinematics};

use super::{Kind, STEPS_PER_TURN};

/// Of a DRV8825.
const PULSE_NS: u64 = 1900;
const SETUP_NS: u64 = 650;
/// Speeds near a rest are those between two steps, from half a step to one and a half away.
const SPEED_MARGIN: f64 = 1.2;

/// Home switches, each closed on the side of its place that the axis was not on at first.
#[derive(Clone)]
pub struct Switches<const N: usize> {
    from: Rc<Cell<[i32; N]>>,
    are_below: [bool; N],
}

impl<const N: usize> Switches<N> {
    fn new(from: [i32; N]) -> Self {
        Self {
            from: Rc::new(Cell::new(from)),
            are_below: from.map(|steps| steps >= 0),
        }
    }

    pub fn closed(&self) -> [bool; N] {
        let from = self.from.get();
        std::array::from_fn(|axis| match self.are_below[axis] {
            true => from[axis] <= 0,
            false => from[axis] >= 0,
        })
    }
}

/// A step: when its pulse began, and which.
#[derive(Clone, Copy, Debug)]
pub struct Made<const N: usize> {
    pub ticks: u64,
    pub axis: usize,
    pub sign: i32,
    /// Of all axes, after it.
    pub steps: [i32; N],
}

pub struct Pins<const N: usize> {
    tick_hz: u32,
    levels: u8,
    pub ticks: u64,
    pub steps: [i32; N],
    switches: Switches<N>,
    tool: fn([i32; N]) -> [f64; N],
    acceleration_steps_s2: f64,
    pub made: Vec<Made<N>>,
    /// When the levels have changed, and to what.
    pub changes: Vec<(u64, u8)>,
    /// Time and bit of each edge.
    edges: Vec<(u64, u8, bool)>,
}

impl<const N: usize> Pins<N> {
    pub fn new<K: Kinematics<N>>(kind: &Kind<K, N>, tick_hz: u32, from_switches: [i32; N]) -> Self {
        Self {
            tick_hz,
            levels: 0,
            ticks: 0,
            steps: std::array::from_fn(|axis| kind.home_steps[axis] + from_switches[axis]),
            switches: Switches::new(from_switches),
            tool: kind.tool,
            acceleration_steps_s2: kind.acceleration_steps_s2,
            made: Vec::new(),
            changes: Vec::new(),
            edges: Vec::new(),
        }
    }

    pub fn switches(&self) -> Switches<N> {
        self.switches.clone()
    }

    /// Steps from the places where the switches close.
    pub fn since_switch(&self) -> [i32; N] {
        self.switches.from.get()
    }

    /// Forgets what has been seen so far.
    pub fn forget(&mut self) {
        self.made.clear();
        self.changes.clear();
        self.edges.clear();
    }

    /// Angles of joints, in radians.
    pub fn joints(&self) -> [f64; N] {
        let turns = self.steps.map(|steps| f64::from(steps) / STEPS_PER_TURN);
        turns.map(|turn| turn * TAU)
    }

    /// Where the tool is, in mm.
    pub fn tool(&self) -> [f64; N] {
        (self.tool)(self.steps)
    }

    pub fn play(&mut self, block: &Block<N>) {
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
        for bit in (0..2 * N as u8).filter(|bit| changed >> bit & 1 == 1) {
            let high = levels >> bit & 1 == 1;
            self.edges.push((ticks, bit, high));
            if bit % 2 == 0 && high {
                self.step(usize::from(bit / 2));
            }
        }
    }

    fn step(&mut self, axis: usize) {
        let sign = if self.levels >> (2 * axis + 1) & 1 == 1 {
            1
        } else {
            -1
        };
        self.steps[axis] += sign;
        let mut from_switches = self.switches.from.get();
        from_switches[axis] += sign;
        self.switches.from.set(from_switches);
        self.made.push(Made {
            ticks: self.ticks,
            axis,
            sign,
            steps: self.steps,
        });
    }

    /// All steps since `forget` are near a line of the tool.
    pub fn assert_on_line(&self, from: [f64; N], to: [f64; N], tolerance_mm: f64) {
        assert!(self.made.len() > 100, "nothing has moved");
        let difference = |a: [f64; N], b: [f64; N]| std::array::from_fn(|at| a[at] - b[at]);
        let dot = |a: [f64; N], b: [f64; N]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let way = difference(to, from);
        let length = dot(way, way).sqrt();
        for made in &self.made {
            let gone = difference((self.tool)(made.steps), from);
            let along = dot(gone, way) / length;
            let off = (dot(gone, gone) - along * along).max(0.0).sqrt();
            assert!(off <= tolerance_mm, "{off} mm off the line at {made:?}");
            let range = -tolerance_mm..=length + tolerance_mm;
            assert!(
                range.contains(&along),
                "{along} mm along the line at {made:?}"
            );
        }
    }

    /// All steps since `forget` are near a circle of the tool in the plane of x and y.
    pub fn assert_on_circle(&self, [x, y]: [f64; 2], radius: f64, tolerance_mm: f64) {
        assert!(self.made.len() > 100, "nothing has moved");
        for made in &self.made {
            let tool = (self.tool)(made.steps);
            let off = ((tool[0] - x).hypot(tool[1] - y) - radius).abs();
            assert!(off <= tolerance_mm, "{off} mm off the circle at {made:?}");
        }
    }

    /// Towards the last step each axis has been no faster than it can brake.
    pub fn assert_slow_end(&self) {
        let acceleration = self.acceleration_steps_s2;
        for axis in 0..N {
            let steps: Vec<_> = self.made.iter().filter(|made| made.axis == axis).collect();
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
        for axis in 0..N {
            let (mut rise, mut turn) = (None, None);
            for &(ticks, bit, high) in self
                .edges
                .iter()
                .filter(|edge| usize::from(edge.1 / 2) == axis)
            {
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
