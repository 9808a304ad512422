//! What those who talk, plan and play share.

use core::cell::Cell;
use core::fmt::{self, Display, Formatter};

use embassy_sync::blocking_mutex::Mutex;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::{Channel, TrySendError};
use embassy_sync::signal::Signal;
use step_player::Source;

use crate::command::{Command, Job};
use crate::pulses::{Block, BlockEnd};
use crate::scales::{Counters, Reading};
use crate::{Text, text};

/// Blocks between planner and pins. With the time of a block this is how far the
/// planner may be late, and how long a hold takes to show.
const BLOCKS: usize = 8;

/// What the machine does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It does not know where it is: `home` comes first.
    NotHomed,
    /// On its way to the switches.
    Homing,
    /// At rest.
    Ready,
    /// A motion is planned or run.
    Moving,
    /// At rest on the path, until `resume` or `stop`.
    Held,
}

impl Display for State {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotHomed => "not homed",
            Self::Homing => "homing",
            Self::Ready => "ready",
            Self::Moving => "moving",
            Self::Held => "held",
        })
    }
}

/// What the user wants of the motion under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    Run,
    Hold,
    Stop,
}

#[derive(Clone, Copy, Debug)]
struct Shared<const N: usize> {
    state: State,
    wanted: Wanted,
    feed_percent: u8,
    /// Steps of all axes from zero that the pins have made.
    steps: [i32; N],
    /// Of the blocks that are put and not played.
    ticks_ahead: u32,
    underruns: u32,
    counters: Counters<N>,
}

/// What those who talk, plan and play share; each may be a task of another priority.
pub struct Panel<const N: usize> {
    shared: Mutex<CriticalSectionRawMutex, Cell<Shared<N>>>,
    jobs: Signal<CriticalSectionRawMutex, Job<N>>,
    /// Something that the planner may wait for has changed.
    changed: Signal<CriticalSectionRawMutex, ()>,
    played: Signal<CriticalSectionRawMutex, ()>,
    blocks: Channel<CriticalSectionRawMutex, Block<N>, BLOCKS>,
    answers: Channel<CriticalSectionRawMutex, Text, 4>,
}

impl<const N: usize> Default for Panel<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Panel<N> {
    /// A machine that is not homed.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            shared: Mutex::new(Cell::new(Shared {
                state: State::NotHomed,
                wanted: Wanted::Run,
                feed_percent: 100,
                steps: [0; N],
                ticks_ahead: 0,
                underruns: 0,
                counters: Counters::new(),
            })),
            jobs: Signal::new(),
            changed: Signal::new(),
            played: Signal::new(),
            blocks: Channel::new(),
            answers: Channel::new(),
        }
    }

    fn shared(&self) -> Shared<N> {
        self.shared.lock(Cell::get)
    }

    /// Changes all or nothing.
    fn change<R>(&self, change: impl FnOnce(&mut Shared<N>) -> R) -> R {
        self.shared.lock(|cell| {
            let mut shared = cell.get();
            let result = change(&mut shared);
            cell.set(shared);
            result
        })
    }

    /// What the machine does.
    pub fn state(&self) -> State {
        self.shared().state
    }

    /// Steps of all axes from zero that the pins have made.
    pub fn steps(&self) -> [i32; N] {
        self.shared().steps
    }

    /// Whether the pins would have to wait for a block.
    pub fn has_no_block(&self) -> bool {
        self.blocks.is_empty()
    }

    /// How often the pins had to wait for the planner in the middle of a motion.
    pub fn underruns(&self) -> u32 {
        self.shared().underruns
    }
}

/// For the task that plays.
impl<const N: usize> Source for Panel<N> {
    type Block = Block<N>;
    type End = BlockEnd<N>;

    async fn next_block(&self) -> Block<N> {
        self.blocks.receive().await
    }

    fn try_next_block(&self) -> Option<Block<N>> {
        self.blocks.try_receive().ok()
    }

    fn end(block: &Block<N>) -> BlockEnd<N> {
        block.end
    }

    fn played(&self, end: BlockEnd<N>) {
        self.change(|shared| {
            shared.steps = end.steps;
            shared.ticks_ahead = shared.ticks_ahead.saturating_sub(end.ticks);
        });
        self.played.signal(());
    }

    /// Counts as an underrun unless the machine rests there.
    fn ran_out_after(&self, end: BlockEnd<N>) {
        if !end.rests {
            self.change(|shared| shared.underruns = shared.underruns.wrapping_add(1));
        }
    }
}

/// For the task that plans.
impl<const N: usize> Panel<N> {
    pub(crate) async fn next_job(&self) -> Job<N> {
        self.jobs.wait().await
    }

    pub(crate) async fn put(&self, block: Block<N>) {
        let ticks = block.end.ticks;
        self.change(|shared| shared.ticks_ahead = shared.ticks_ahead.saturating_add(ticks));
        self.blocks.send(block).await;
    }

    /// Returns when all blocks are played.
    pub(crate) async fn all_played(&self) {
        self.all_played_but(0).await;
    }

    /// Returns when blocks of at most so many ticks are left to be played.
    pub(crate) async fn all_played_but(&self, ticks: u32) {
        while self.shared().ticks_ahead > ticks {
            self.played.wait().await;
        }
    }

    pub(crate) fn wanted(&self) -> (Wanted, u8) {
        let shared = self.shared();
        (shared.wanted, shared.feed_percent)
    }

    /// Returns when [`wanted`](Self::wanted) may have changed.
    pub(crate) async fn changed(&self) {
        self.changed.wait().await;
    }

    pub(crate) fn set_state(&self, state: State) {
        self.change(|shared| shared.state = state);
    }

    pub(crate) fn set_steps(&self, steps: [i32; N]) {
        self.change(|shared| shared.steps = steps);
    }

    /// What the scales say, as their counters read now.
    pub(crate) fn read_scales(&self, now: [u16; N]) -> Reading<N> {
        self.change(|shared| shared.counters.read(now, shared.steps))
    }

    /// The scales are at home, so many steps from zero.
    pub(crate) fn set_home(&self, home_steps: [i32; N]) {
        self.change(|shared| shared.counters.set_home(home_steps));
    }

    /// The axes have been corrected by so many steps.
    pub(crate) fn corrected(&self, steps: [i32; N]) {
        self.change(|shared| shared.counters.correct(steps));
    }

    /// Says what became of a job. Nobody who listens too slowly stops the machine: the oldest
    /// answer is lost then.
    pub(crate) fn answer(&self, answer: Text) {
        if let Err(TrySendError::Full(answer)) = self.answers.try_send(answer) {
            let _ = self.answers.try_receive();
            let _ = self.answers.try_send(answer);
        }
    }
}

/// For the task that talks.
impl<const N: usize> Panel<N> {
    pub(crate) fn status(&self) -> Text {
        let shared = self.shared();
        let (state, percent, underruns) = (shared.state, shared.feed_percent, shared.underruns);
        text!("{state}, feed {percent} %, {underruns} underruns")
    }

    pub(crate) async fn next_answer(&self) -> Text {
        self.answers.receive().await
    }

    /// Takes a command that changes what the machine does. Of one that takes time the planner tells
    /// the outcome.
    pub(crate) fn take(&self, command: Command<N>) -> Option<Text> {
        let refusal = self.change(|shared| {
            let state = shared.state;
            match (command, state) {
                (Command::Job(Job::Home), State::NotHomed | State::Ready) => {
                    shared.state = State::Homing;
                }
                (
                    Command::Job(Job::Line { .. } | Job::Arc { .. } | Job::Jog { .. }),
                    State::Ready,
                ) => {
                    shared.state = State::Moving;
                }
                (Command::Hold | Command::Resume, State::Moving | State::Held)
                    if shared.wanted == Wanted::Stop =>
                {
                    return Some(text!("refused: stopping"));
                }
                (Command::Hold, State::Moving) => shared.wanted = Wanted::Hold,
                (Command::Resume, State::Held | State::Moving) => shared.wanted = Wanted::Run,
                (Command::Stop, State::Moving | State::Held | State::Homing) => {
                    shared.wanted = Wanted::Stop;
                }
                (Command::Feed { percent }, _) => shared.feed_percent = percent,
                _ => return Some(text!("refused: {state}")),
            }
            if matches!(command, Command::Job(_)) {
                shared.wanted = Wanted::Run;
            }
            None
        });
        match (refusal, command) {
            (Some(refusal), _) => Some(refusal),
            (None, Command::Job(job)) => {
                self.jobs.signal(job);
                None
            }
            (None, _) => {
                self.changed.signal(());
                Some(text!("ok"))
            }
        }
    }
}
