//! Pins that are looked at, and what hangs on them.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::rc::Rc;

use board_machine::{Block, Inputs, Kinematics};

use super::{Kind, STEPS_PER_TURN};

/// Of a DRV8825.
const PULSE_NS: u64 = 1900;
const SETUP_NS: u64 = 650;
/// Speeds near a rest are those between two steps, from half a step to one and a half away.
const SPEED_MARGIN: f64 = 1.2;

/// Counts of a step, on each axis; a whole turn of a counter is 13,107.2 steps.
const COUNTS_PER_STEP: i32 = 5;

/// What the motors move: home switches, each closed on the side of its place that the axis was not on
/// at first, and scales. A motor may lose steps.
#[derive(Clone)]
pub struct Slides<const N: usize> {
    from_switches: Rc<Cell<[i32; N]>>,
    are_below: [bool; N],
    /// Steps of each axis that move nothing, from the next one on.
    losing: Rc<Cell<[u32; N]>>,
    /// Whether there is a counter for each scale.
    are_counted: Rc<Cell<bool>>,
}

impl<const N: usize> Slides<N> {
    fn new(from_switches: [i32; N]) -> Self {
        Self {
            from_switches: Rc::new(Cell::new(from_switches)),
            are_below: from_switches.map(|steps| steps >= 0),
            losing: Rc::new(Cell::new([0; N])),
            are_counted: Rc::new(Cell::new(false)),
        }
    }

    fn step(&self, axis: usize, sign: i32) {
        let mut losing = self.losing.get();
        match losing[axis] {
            0 => self.push(axis, sign),
            _ => losing[axis] -= 1,
        }
        self.losing.set(losing);
    }

    fn push(&self, axis: usize, steps: i32) {
        let mut from_switches = self.from_switches.get();
        from_switches[axis] += steps;
        self.from_switches.set(from_switches);
    }
}

impl<const N: usize> Inputs<N> for Slides<N> {
    fn closed(&self) -> [bool; N] {
        let from = self.from_switches.get();
        std::array::from_fn(|axis| match self.are_below[axis] {
            true => from[axis] <= 0,
            false => from[axis] >= 0,
        })
    }

    fn counts(&self) -> Option<[u16; N]> {
        let counts = |steps: i32| (steps * COUNTS_PER_STEP) as u16;
        self.are_counted
            .get()
            .then(|| self.from_switches.get().map(counts))
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
    slides: Slides<N>,
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
            slides: Slides::new(from_switches),
            tool: kind.tool,
            acceleration_steps_s2: kind.acceleration_steps_s2,
            made: Vec::new(),
            changes: Vec::new(),
            edges: Vec::new(),
        }
    }

    pub fn slides(&self) -> Slides<N> {
        self.slides.clone()
    }

    /// The scales have counters from now on.
    pub fn count_scales(&self) {
        self.slides.are_counted.set(true);
    }

    /// Steps of the slides from the places where the switches close.
    pub fn since_switch(&self) -> [i32; N] {
        self.slides.from_switches.get()
    }

    /// The motor of an axis loses so many steps, from the next one on.
    pub fn lose(&self, axis: usize, steps: u32) {
        let mut losing = self.slides.losing.get();
        losing[axis] = steps;
        self.slides.losing.set(losing);
    }

    /// Somebody pushes a slide, by so many steps.
    pub fn push(&self, axis: usize, steps: i32) {
        self.slides.push(axis, steps);
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
        self.slides.step(axis, sign);
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
