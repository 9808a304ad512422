//! The player: an interrupt for each step of each joint.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::NVIC;
use cortex_m_firmware::Hash;
use cortex_m_firmware::arm_line::{MAX_BYTES, Planner, Segments, Steps, plan};
use cortex_m_firmware::board::{Clock, StepInterrupt, StepTimer, Trace, exit};
use cortex_m_semihosting::hprintln;
use panic_semihosting as _;
use stepper_sync::Direction;

/// Where QEMU's loader puts the PC's line: two lengths, and the bytes of both joints.
const WIRE: *const u32 = 0x2100_0000 as *const u32;

/// What the interrupt has of a joint.
struct Joint {
    steps: Steps,
    /// The step whose ticks are counted now, and the one after it.
    now: Option<(u32, Direction)>,
    next: Option<(u32, Direction)>,
    /// The clock at the start.
    start: u32,
    trace: Trace,
}

struct Shared(UnsafeCell<[Option<Joint>; 2]>);

// SAFETY: one processor; outside the interrupt used only while no timer runs.
unsafe impl Sync for Shared {}

static JOINTS: Shared = Shared(UnsafeCell::new([None, None]));
static RUNNING: AtomicU32 = AtomicU32::new(0);

impl Joint {
    fn new(wire: &[u8]) -> Self {
        let mut steps = Segments::decoded(wire).steps();
        Self {
            now: steps.next(),
            next: steps.next(),
            steps,
            start: 0,
            trace: Trace::EMPTY,
        }
    }

    fn start(&mut self, timer: &StepTimer) {
        let ticks = |step: Option<(u32, Direction)>| step.expect("a line has steps").0;
        self.start = Clock::started().value();
        timer.start(ticks(self.now), ticks(self.next));
    }

    /// An edge at the pin, and the ticks of the step after the next.
    #[inline]
    fn step(&mut self, timer: &StepTimer) {
        timer.clear_interrupt();
        let Some((_, direction)) = self.now else {
            return;
        };
        // A firmware with pins would change one here.
        self.trace.push(direction);
        self.now = self.next;
        self.next = self.steps.next();
        if let Some((ticks, _)) = self.next {
            timer.set_next(ticks);
        }
        if self.now.is_none() {
            timer.stop();
            // A Cortex-M0+ has no instruction that subtracts from memory; nothing else writes here.
            RUNNING.store(RUNNING.load(Ordering::Relaxed) - 1, Ordering::Release);
        }
    }
}

/// All interrupts of the board; only the step timers' is on.
#[cortex_m_rt::exception]
unsafe fn DefaultHandler(_: i16) {
    // SAFETY: `play` waits while the timers run.
    let joints = unsafe { &mut *JOINTS.0.get() };
    for (joint, timer) in joints.iter_mut().zip(&StepTimer::BOTH) {
        if let (Some(joint), true) = (joint, timer.is_due()) {
            joint.step(timer);
        }
    }
}

/// Plays both joints' segments, and says what came when.
fn play(name: &str, wire: [&[u8]; 2]) {
    // SAFETY: no timer runs; the interrupt does not look before `start`.
    let joints = unsafe { &mut *JOINTS.0.get() };
    *joints = wire.map(|wire| Some(Joint::new(wire)));
    RUNNING.store(2, Ordering::Release);
    for (joint, timer) in joints.iter_mut().flatten().zip(&StepTimer::BOTH) {
        joint.start(timer);
    }
    while RUNNING.load(Ordering::Acquire) > 0 {}
    for (number, joint) in joints.iter().flatten().enumerate() {
        for (sign, clock) in joint.trace.edges() {
            let ticks = joint.start.wrapping_sub(clock) & (u32::MAX >> 1);
            hprintln!("{} {} {} {}", name, number, sign, ticks);
        }
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut OWN: [[u8; MAX_BYTES]; 2] = [[0; MAX_BYTES]; 2];

    let clock = Clock::start();
    // SAFETY: handles it, and the shared state is in place.
    unsafe { NVIC::unmask(StepInterrupt) };

    // SAFETY: QEMU has loaded it there.
    let [first, second] = [0, 1].map(|number| unsafe { *WIRE.add(number) } as usize);
    let bytes = unsafe { core::slice::from_raw_parts(WIRE.add(2).cast::<u8>(), first + second) };
    play("pc", bytes.split_at(first).into());

    let start = clock.value();
    let [first, second] = plan(Planner::Board, OWN);
    let ticks = start.wrapping_sub(clock.value());
    let [shoulder, elbow] = [&OWN[0][..first], &OWN[1][..second]];
    let mut hash = Hash::default();
    shoulder
        .iter()
        .chain(elbow)
        .for_each(|&byte| hash.add(byte.into()));
    hprintln!("planned {} {}", ticks, hash.value());
    play("board", [shoulder, elbow]);
    exit()
}
