//! A platform whose pendant is in somebody's hands.

use anyhow::{Context as _, Result};
use handwheel::{Key, LedState, Position, RotarySwitch};
use pose_pt::Platform;

use crate::machine::{Locators, Machine, isometry};
use crate::mode::Mode;
use crate::moments::PlatformAt;
use crate::planner::Planner;
use crate::screen::LINES;
use crate::world::World;

/// What a hand does at the pendant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Hand {
    /// Presses a key, or releases all: 1 to 4 are page up, page down, enter and motion start.
    Key(Option<Key>),
    /// Turns the rotary switch for the direction.
    Direction(Position),
    /// Turns the rotary switch for the multiplier.
    Multiplier(Position),
    /// Holds the enabling switches.
    Enable {
        /// The left one.
        left: bool,
        /// The right one.
        right: bool,
    },
    /// Turns the wheel by counts.
    Wheel(i32),
}

/// What is seen at the desk.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Seen {
    /// The lines of the display.
    pub display: [String; LINES],
    /// Of the pendant.
    pub led: LedState,
    /// A jog or a pose change is under way.
    pub is_moving: bool,
    /// The platform.
    pub platform: PlatformAt,
}

/// A platform at rest with its pendant switched on; time passes when it is told to.
///
/// ```
/// use handwheel::{Key, Position};
/// use platform::{Desk, Hand, Machine};
///
/// let machine = Machine::parse(platform::PLATFORM)?;
/// let mut desk = Desk::new(&machine)?;
/// desk.wait_ms(3000)?;
/// assert!(desk.seen()?.display[0].starts_with("SINGLE"));
/// desk.act(Hand::Key(Some(Key::new(3)?)))?; // enter: opens locator 1
/// desk.wait_ms(1000)?;
/// assert!(desk.seen()?.display[0].contains("LOCATOR  1 IDLE"));
/// # Ok::<(), anyhow::Error>(())
/// ```
pub struct Desk {
    world: Box<dyn Hands>,
}

impl core::fmt::Debug for Desk {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Desk").finish_non_exhaustive()
    }
}

impl Desk {
    /// The body at the first pose of the platform file, and both enabling switches up. The poses
    /// between are of that file's motion: a pose change set at the desk does not pass them.
    ///
    /// # Errors
    /// The pose is out of reach; settings of the panel that cannot work.
    pub fn new(machine: &Machine) -> Result<Self> {
        let world = match &machine.locators {
            Locators::Three(platform) => desk(machine, platform)?,
            Locators::Four(platform) => desk(machine, platform)?,
            Locators::Five(platform) => desk(machine, platform)?,
            Locators::Six(platform) => desk(machine, platform)?,
        };
        Ok(Self { world })
    }

    /// Does something at the pendant.
    ///
    /// # Errors
    /// Numbers that do not fit: of a machine that has run for years.
    pub fn act(&mut self, hand: Hand) -> Result<()> {
        self.world.act(hand)
    }

    /// Lets time pass.
    ///
    /// # Errors
    /// As [`Self::act`].
    pub fn wait_ms(&mut self, millis: u64) -> Result<()> {
        self.world.wait_ms(millis)
    }

    /// What is seen now.
    ///
    /// # Errors
    /// The locators are in line: no body fits them.
    pub fn seen(&self) -> Result<Seen> {
        self.world.seen()
    }
}

/// A world of any number of locators.
trait Hands {
    fn act(&mut self, hand: Hand) -> Result<()>;
    fn wait_ms(&mut self, millis: u64) -> Result<()>;
    fn seen(&self) -> Result<Seen>;
}

fn desk<const N: usize>(machine: &Machine, platform: &Platform<N>) -> Result<Box<dyn Hands>> {
    let [from, _] = machine.settings.poses();
    let axes = platform.checked_axes(&isometry(from));
    axes.context("from: out of reach")?;
    let planner = Planner::new(platform, &machine.settings, Vec::new(), Mode::Pvt);
    let mut world = World::new(planner, machine.panel, from, |_, byte| Ok(byte))?;
    world.pendant.switch_on();
    world.switches(false, false)?;
    Ok(Box::new(world))
}

impl<const N: usize> Hands for World<'_, N> {
    fn act(&mut self, hand: Hand) -> Result<()> {
        match hand {
            Hand::Key(Some(key)) => self.press(key),
            Hand::Key(None) => self.release(),
            Hand::Direction(position) => self.turn(RotarySwitch::W2, position),
            Hand::Multiplier(position) => self.turn(RotarySwitch::W1, position),
            Hand::Enable { left, right } => return self.switches(left, right),
            Hand::Wheel(counts) => self.turn_wheel(counts),
        }
        Ok(())
    }

    fn wait_ms(&mut self, millis: u64) -> Result<()> {
        self.wait_ms(millis)
    }

    fn seen(&self) -> Result<Seen> {
        let (platform, settings) = (&self.planner.platform, &self.planner.settings);
        Ok(Seen {
            display: core::array::from_fn(|line| self.pendant.line(line)),
            led: self.pendant.led(),
            is_moving: self.is_moving(),
            platform: PlatformAt::new(self.now_s(), self.drives.states(), platform, settings)?,
        })
    }
}
