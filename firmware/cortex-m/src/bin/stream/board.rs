//! The board's end: a station in the main loop, an interrupt for each step of each joint.

mod joint;

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use core::time::Duration;

use cortex_m::interrupt;
use cortex_m::peripheral::NVIC;
use cortex_m_firmware::board::{CLOCK_HZ, Clock, StepInterrupt, StepTimer, Uart, exit};
use cortex_m_firmware::stream::{Batch, Event, MAX_BATCH, REPORT, Report, WINDOW, line};
use cortex_m_semihosting::hprintln;
use joint::Joint;
use panic_semihosting as _;
use proto3964r::{Event as LineEvent, Priority, Station};

/// A tail is taken up that long before the end of its batch: 20 ms, in which the main loop comes
/// round even if it has a batch to decode, which takes it some 5 ms.
const LEAD_TICKS: u64 = CLOCK_HZ as u64 / 50;
/// Most starts from rest that are remembered.
const MAX_STARTS: usize = 16;

/// A batch, and how the stream goes on after it. The main loop fills it, then it is ready; from
/// then on the interrupt reads it until both joints have left it.
pub struct Slot {
    ready: AtomicBool,
    next: AtomicU8,
    batch: UnsafeCell<Option<Batch>>,
}

/// What comes after a batch: open, then for both joints the same.
pub mod next {
    pub const OPEN: u8 = 0;
    pub const BATCH: u8 = 1;
    pub const TAIL: u8 = 2;
}

impl Slot {
    const EMPTY: Self = Self {
        ready: AtomicBool::new(false),
        next: AtomicU8::new(next::OPEN),
        batch: UnsafeCell::new(None),
    };

    pub fn batch(&self) -> Option<&Batch> {
        if !self.ready.load(Ordering::Acquire) {
            return None;
        }
        // SAFETY: nobody writes to a slot that is ready.
        unsafe { &*self.batch.get() }.as_ref()
    }

    fn fill(&self, batch: Batch) {
        assert!(!self.ready.load(Ordering::Acquire), "a slot that is in use");
        self.next.store(next::OPEN, Ordering::Relaxed);
        // SAFETY: nobody reads a slot that is not ready.
        unsafe { *self.batch.get() = Some(batch) };
        self.ready.store(true, Ordering::Release);
    }

    fn clear(&self) {
        self.ready.store(false, Ordering::Release);
    }
}

/// The slots, by number of their batch.
pub struct Slots([Slot; WINDOW]);

// SAFETY: one processor; `Slot` says who looks when.
unsafe impl Sync for Slots {}

static SLOTS: Slots = Slots([Slot::EMPTY; WINDOW]);

impl Slots {
    pub fn of(&self, number: u16) -> &Slot {
        &self.0[usize::from(number) % WINDOW]
    }

    /// The batch after another one, if it is there.
    pub fn after(&self, number: u16) -> Option<&Batch> {
        let next = self.of(number + 1).batch();
        next.filter(|next| next.head.number == number + 1)
    }
}

struct Shared(UnsafeCell<[Joint; 2]>);

// SAFETY: one processor; the main loop looks while interrupts are off.
unsafe impl Sync for Shared {}

static JOINTS: Shared = Shared(UnsafeCell::new([Joint::NEW; 2]));

/// Both joints, while no interrupt comes.
fn with_joints<R>(work: impl FnOnce(&mut [Joint; 2]) -> R) -> R {
    // SAFETY: interrupts are off.
    interrupt::free(|_| work(unsafe { &mut *JOINTS.0.get() }))
}

/// All interrupts of the board; only the step timers' is on.
#[cortex_m_rt::exception]
unsafe fn DefaultHandler(_: i16) {
    // SAFETY: the main loop looks while interrupts are off.
    let joints = unsafe { &mut *JOINTS.0.get() };
    for (number, (joint, timer)) in joints.iter_mut().zip(&StepTimer::BOTH).enumerate() {
        if timer.is_due() {
            joint.step(number, timer, &SLOTS);
        }
    }
}

/// A tick of the plan, and the tick of the clock at which it comes.
#[derive(Clone, Copy)]
struct Start {
    plan: u64,
    clock: u64,
}

/// The main loop's state.
struct Machine {
    clock: Clock,
    /// The clock at the beginning; it counts down.
    zero: u32,
    last_clock: u32,
    now: u64,
    start: Start,
    starts: [Start; MAX_STARTS],
    start_count: usize,
    is_at_rest: bool,
    /// The oldest batch that is not over, and the one after the newest.
    oldest: u16,
    expected: u16,
    reports: Reports,
}

/// Reports that have not been sent.
#[derive(Default)]
struct Reports {
    waiting: [Option<Report>; 2 * WINDOW],
}

impl Reports {
    fn push(&mut self, report: Report) {
        let free = self.waiting.iter_mut().find(|place| place.is_none());
        *free.expect("no more reports than batches") = Some(report);
    }

    fn pop(&mut self) -> Option<Report> {
        let report = self.waiting[0].take();
        self.waiting.rotate_left(1);
        report
    }
}

impl Machine {
    fn new() -> Self {
        let clock = Clock::start();
        let start = Start { plan: 0, clock: 0 };
        let zero = clock.value();
        Self {
            zero,
            last_clock: zero,
            clock,
            now: 0,
            start,
            starts: [start; MAX_STARTS],
            start_count: 0,
            is_at_rest: true,
            oldest: 0,
            expected: 0,
            reports: Reports::default(),
        }
    }

    /// Ticks of the clock since the beginning; asked for more often than the clock wraps.
    fn now(&mut self) -> u64 {
        let clock = self.clock.value();
        self.now += u64::from(self.last_clock.wrapping_sub(clock));
        self.last_clock = clock;
        self.now
    }

    /// A batch that is not the next one is dropped: the PC sent it before it knew of a rest.
    fn take(&mut self, telegram: &[u8]) {
        let batch = Batch::decode(telegram).expect("the PC's batches are good");
        if batch.head.number == self.expected && batch.head.from_rest == self.is_next_from_rest() {
            SLOTS.of(self.expected).fill(batch);
            self.expected += 1;
        }
    }

    fn is_next_from_rest(&self) -> bool {
        self.is_at_rest && self.oldest == self.expected
    }

    /// Starts from rest when a batch is there.
    fn start(&mut self) {
        let Some(batch) = SLOTS.of(self.oldest).batch() else {
            return;
        };
        if !self.is_at_rest {
            return;
        }
        self.start = Start {
            plan: batch.head.ticks[0],
            clock: self.now() + LEAD_TICKS,
        };
        self.starts[self.start_count] = self.start;
        self.start_count += 1;
        self.is_at_rest = false;
        with_joints(|joints| joints.iter_mut().for_each(|joint| joint.begin(self.oldest)));
    }

    /// When a tick of the plan comes, by the clock.
    fn due(&self, plan: u64) -> u64 {
        self.start.clock + (plan - self.start.plan)
    }

    /// Goes over to the tail where no batch has come in time. It is not asked whether a joint
    /// waits: a fast one does so too late.
    fn decide(&mut self) {
        let number = with_joints(|joints| joints[0].batch.max(joints[1].batch));
        let slot = SLOTS.of(number);
        let Some(batch) = slot.batch() else {
            return;
        };
        let is_due = self.now() + LEAD_TICKS >= self.due(batch.head.ticks[1]);
        if !self.is_at_rest && is_due && !batch.head.is_last && SLOTS.after(number).is_none() {
            interrupt::free(|_| {
                if slot.next.load(Ordering::Relaxed) == next::OPEN {
                    slot.next.store(next::TAIL, Ordering::Relaxed);
                }
            });
        }
    }

    /// Gives joints that wait their next steps.
    fn serve(&mut self) {
        for (number, timer) in StepTimer::BOTH.iter().enumerate() {
            let now = self.now();
            with_joints(|joints| {
                joints[number].fill(number, timer, &SLOTS, |plan| {
                    self.due(plan).checked_sub(now).expect("served too late")
                });
            });
        }
    }

    /// Says what is over.
    fn report(&mut self) {
        let (batches, rests, steps) = with_joints(|joints| {
            let all = joints.iter().all(|joint| joint.rests());
            (
                joints.each_ref().map(|joint| joint.batch),
                all,
                joints.each_ref().map(|joint| joint.made),
            )
        });
        while !self.is_at_rest && batches.iter().all(|&batch| batch > self.oldest) {
            SLOTS.of(self.oldest).clear();
            self.say(Event::Played, self.oldest, steps);
            self.oldest += 1;
        }
        if !self.is_at_rest && rests {
            self.is_at_rest = true;
            self.say(Event::Rests, self.oldest, steps);
            SLOTS.0.iter().for_each(Slot::clear);
            self.oldest += 1;
            self.expected = self.oldest;
        }
    }

    fn say(&mut self, event: Event, number: u16, steps: [i32; 2]) {
        self.reports.push(Report {
            event,
            number,
            steps,
        });
    }
}

/// Ticks as the time of the station.
fn time(ticks: u64) -> Duration {
    Duration::from_nanos(ticks * (1_000_000_000 / u64::from(CLOCK_HZ)))
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let uart = Uart::start();
    let mut machine = Machine::new();
    let mut station = Station::<MAX_BATCH, REPORT>::with_buffers(line(Priority::Low));
    // SAFETY: handles it, and the shared state is in place.
    unsafe { NVIC::unmask(StepInterrupt) };
    let mut is_last = false;
    loop {
        let now = time(machine.now());
        station.handle_timeout(now);
        if let Some(byte) = uart.read() {
            station.handle_byte(now, byte);
        }
        if uart.has_room()
            && let Some(byte) = station.poll_transmit_byte(now)
        {
            uart.write(byte);
        }
        match station.poll_event() {
            Some(LineEvent::Received(telegram)) if telegram.is_empty() => is_last = true,
            Some(LineEvent::Received(telegram)) => machine.take(telegram),
            Some(LineEvent::Failed(failure)) => panic!("the PC is not there: {failure:?}"),
            _ => {}
        }
        if !station.is_busy()
            && let Some(report) = machine.reports.pop()
        {
            station.submit(now, &report.bytes()).expect("not busy");
        }
        if is_last {
            finish(&machine);
        }
        machine.start();
        machine.decide();
        machine.serve();
        machine.report();
    }
}

/// Says what came when.
fn finish(machine: &Machine) -> ! {
    hprintln!("clock {}", machine.zero);
    for start in &machine.starts[..machine.start_count] {
        hprintln!("start {} {}", start.plan, start.clock);
    }
    with_joints(|joints| {
        for (number, joint) in joints.iter().enumerate() {
            for (sign, clock) in joint.trace.edges() {
                hprintln!("step {} {} {}", number, sign, clock);
            }
        }
    });
    exit()
}
