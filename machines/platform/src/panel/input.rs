//! What goes into a panel and what comes out.

use handwheel::{Event, Key, Position, RotarySwitch, Status};

use crate::arbiter::Target;

/// Something that happened at the pendant or at the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Input {
    /// A key went down, or all are released.
    Key(Option<Key>),
    /// A rotary switch was turned.
    RotarySwitch(RotarySwitch, Position),
    /// Where keys and rotary switches stand.
    Status(Status),
    /// The enabling switches, which have their own wires: true while down. Hand them in whenever
    /// one changes, and once at the start.
    Enable {
        /// The left one.
        left: bool,
        /// The right one.
        right: bool,
    },
    /// The stop button, which has its own wires too.
    StopButton,
    /// Wheel counts of one [`WheelSampler::PERIOD`](handwheel::WheelSampler::PERIOD); zero when the
    /// wheel stood still.
    Wheel(i32),
    /// The link to the pendant is lost.
    Lost,
    /// What this pendant moved is at rest: it stopped as commanded, or the pose is reached, or the
    /// axis ended its jog by itself. Only when it is: a panel at rest has nothing to stop.
    AtRest,
    /// The machine does not carry out this pendant's last action; nothing moves.
    Refused(Refusal),
}

impl Input {
    /// What the driver's event means to a panel; `None` for the outcomes of display and LEDs.
    #[must_use]
    pub const fn of_event(event: &Event) -> Option<Self> {
        match *event {
            Event::Key(key) => Some(Self::Key(key)),
            Event::RotarySwitch(switch, position) => Some(Self::RotarySwitch(switch, position)),
            Event::Status { status, .. }
            | Event::Lcd {
                status: Some(status),
                ..
            } => Some(Self::Status(status)),
            Event::Lost => Some(Self::Lost),
            _ => None,
        }
    }
}

/// Why the machine does not move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Refusal {
    /// Out of the stroke of an axis.
    OutOfReach,
    /// The drives are not ready.
    NotReady,
}

/// What the machine must do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Action {
    /// Move one axis of a locator at a speed, until the next action. Comes with every sample of
    /// the wheel, so a machine may stop by itself when it stays away.
    Jog {
        /// Counted from 0.
        locator: u8,
        /// Which of its axes.
        axis: Axis,
        /// In micrometres per second, never 0.
        speed_um_s: i32,
    },
    /// Move the body by a pose change, from where it is.
    Move(PoseChange),
    /// Stop at once.
    Stop(Target),
}

/// An axis of a locator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::exhaustive_enums, reason = "a locator has three")]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl Axis {
    pub(crate) const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    pub(crate) const fn of_position(position: Position) -> Option<Self> {
        match position.get() {
            1 => Some(Self::X),
            2 => Some(Self::Y),
            3 => Some(Self::Z),
            _ => None,
        }
    }

    /// 0, 1 or 2.
    #[must_use]
    pub const fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Z => 2,
        }
    }
}

/// A change of the body's pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[expect(clippy::exhaustive_structs, reason = "six values, no more")]
pub struct PoseChange {
    /// dX, dY, dZ in micrometres.
    pub translation_um: [i32; 3],
    /// d alpha, d beta, d gamma in millionths of a degree.
    pub rotation_udeg: [i32; 3],
}

impl PoseChange {
    /// No change.
    pub const ZERO: Self = Self {
        translation_um: [0; 3],
        rotation_udeg: [0; 3],
    };

    /// Its values: positions 1 to 6 of the direction switch.
    pub(crate) const DIRECTIONS: u8 = 6;

    /// The six values in the order of the screen, each with whether it is an angle.
    pub(crate) fn values(&self) -> impl Iterator<Item = (i32, bool)> {
        let lengths = self.translation_um.into_iter().map(|value| (value, false));
        let angles = self.rotation_udeg.into_iter().map(|value| (value, true));
        lengths.chain(angles)
    }

    /// The value of a direction, 1 to 6.
    pub(crate) fn value_mut(&mut self, direction: u8) -> Option<&mut i32> {
        let index = usize::from(direction.checked_sub(1)?);
        self.translation_um
            .iter_mut()
            .chain(&mut self.rotation_udeg)
            .nth(index)
    }
}
