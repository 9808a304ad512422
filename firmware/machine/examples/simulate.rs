//! A machine on a PC, in real time: its serial line is standard input and output.
//!
//! `simulate [arm|delta|stage]`. Talk, planner, pulses and settings are those of the boards; only
//! pins and switches are simulated. The wire takes no time here.

use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::convert::Infallible;
use std::error::Error;
use std::future::poll_fn;
use std::io::{self, Read as _, Write as _};
use std::pin::pin;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::task::{Context, Poll, Waker};
use std::thread;
use std::time::{Duration, Instant};

use board_machine::{
    Block, BlockEnd, Inputs, Kinematics, Machine, Motion, Panel, PlanMemory, Settings, Source, talk,
};
use board_settings::{arm, delta, stage};
use embedded_io_async::{ErrorType, Read, Write};
use proto3964r::Line;

const TICK_HZ: u32 = 1_000_000;
/// The boards' line: 8 data bits, even parity, one stop bit.
const LINE: Line = Line::buffered(9600, 11);
/// From one look at all tasks to the next; a block of pulses is longer.
const LOOK: Duration = Duration::from_micros(500);

fn main() -> Result<(), Box<dyn Error>> {
    // Steps from where the machine is switched on to where its switches close.
    match std::env::args().nth(1).as_deref() {
        None | Some("arm") => run(&arm::SETTINGS, [500, 300]),
        Some("delta") => run(&delta::SETTINGS, [-500, -300, -400]),
        Some("stage") => run(&stage::SETTINGS, [500, 300]),
        Some(name) => Err(format!("`{name}` is no machine: arm, delta or stage").into()),
    }
}

fn run<K: Kinematics<N>, const N: usize>(
    settings: &Settings<K, N>,
    from_switches: [i32; N],
) -> Result<(), Box<dyn Error>> {
    let machine = Machine::new(settings, TICK_HZ)?;
    let panel = Panel::new();
    let mut memory = PlanMemory::new();
    let slides = Slides {
        are_below: from_switches.map(|steps| steps > 0),
        from_switches: Cell::new(from_switches),
    };
    let motion = Motion::new(&machine, &panel, &slides, &mut memory)?;
    let input = RefCell::new(VecDeque::new());
    let received = receive();

    let mut plan = pin!(motion.run());
    let port = (Input(&input), Output);
    let mut converse = pin!(talk(
        &machine,
        &panel,
        &slides,
        LINE,
        port,
        |never| match never {}
    ));
    let mut pins = Pins::new(&panel, &slides.from_switches);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        match received.try_recv() {
            Ok(bytes) => input.borrow_mut().extend(bytes),
            Err(TryRecvError::Empty) => thread::sleep(LOOK),
            Err(TryRecvError::Disconnected) => return Ok(()),
        }
        pins.play();
        let _ = plan.as_mut().poll(&mut context);
        let _ = converse.as_mut().poll(&mut context);
    }
}

/// Axes with a home switch each, which is open where the machine is switched on.
struct Slides<const N: usize> {
    from_switches: Cell<[i32; N]>,
    are_below: [bool; N],
}

impl<const N: usize> Inputs<N> for Slides<N> {
    fn closed(&self) -> [bool; N] {
        let from_switches = self.from_switches.get();
        std::array::from_fn(|axis| match self.are_below[axis] {
            true => from_switches[axis] <= 0,
            false => from_switches[axis] >= 0,
        })
    }
}

/// What comes in, until the other end closes.
fn receive() -> Receiver<Vec<u8>> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let mut buffer = [0; 256];
        while let Ok(count @ 1..) = io::stdin().read(&mut buffer) {
            if sender.send(buffer[..count].to_vec()).is_err() {
                return;
            }
        }
    });
    receiver
}

/// Pins that take their time, and the axes that they move.
struct Pins<'a, const N: usize> {
    panel: &'a Panel<N>,
    from_switches: &'a Cell<[i32; N]>,
    levels: u8,
    /// What is played, and until when.
    playing: Option<(Instant, BlockEnd<N>)>,
}

impl<'a, const N: usize> Pins<'a, N> {
    fn new(panel: &'a Panel<N>, from_switches: &'a Cell<[i32; N]>) -> Self {
        Self {
            panel,
            from_switches,
            levels: 0,
            playing: None,
        }
    }

    /// Blocks follow each other without a gap as long as there are some.
    fn play(&mut self) {
        let now = Instant::now();
        let mut begin = now;
        if let Some((until, end)) = self.playing {
            if now < until {
                return;
            }
            self.panel.played(end);
            if self.panel.has_no_block() {
                self.panel.ran_out_after(end);
            }
            begin = until;
        }
        self.playing = self.panel.try_next_block().map(|block| {
            let ticks: u64 = block.words.iter().map(|word| u64::from(word.ticks)).sum();
            self.turn(&block);
            (begin + Duration::from_micros(ticks), block.end)
        });
    }

    fn turn(&mut self, block: &Block<N>) {
        let mut from_switches = self.from_switches.get();
        for word in &block.words {
            let risen = word.levels & !self.levels;
            self.levels = word.levels;
            for (axis, steps) in from_switches.iter_mut().enumerate() {
                let is_forward = word.levels >> (2 * axis + 1) & 1 == 1;
                if risen >> (2 * axis) & 1 == 1 {
                    *steps += if is_forward { 1 } else { -1 };
                }
            }
        }
        self.from_switches.set(from_switches);
    }
}

struct Input<'a>(&'a RefCell<VecDeque<u8>>);

impl ErrorType for Input<'_> {
    type Error = Infallible;
}

impl Read for Input<'_> {
    async fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Infallible> {
        // Whoever waits is looked at again without being woken.
        poll_fn(
            |_| match io::Read::read(&mut *self.0.borrow_mut(), buffer) {
                Ok(0) | Err(_) => Poll::Pending,
                Ok(count) => Poll::Ready(Ok(count)),
            },
        )
        .await
    }
}

struct Output;

impl ErrorType for Output {
    type Error = Infallible;
}

impl Write for Output {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        let mut output = io::stdout();
        // Nobody listens any more: the input ends too.
        let _ = output.write_all(bytes).and_then(|()| output.flush());
        Ok(bytes.len())
    }

    async fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
