//! The operator's panel: what keys, rotary switches, wheel and enabling switches of one pendant do.

mod input;
mod screens;
mod settings;
mod wheel;

pub use input::{Action, Axis, Input, PoseChange, Refusal};
pub use settings::{PanelSettings, PanelSettingsError};

use self::settings::{KeyRole, Multiplier};

use handwheel::{Key, LedState, Position, RotarySwitch, Status};

use crate::arbiter::{Arbiter, PendantId, Target};

/// Which of the three screens is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum View {
    /// SINGLE: the list of locators, and the body after them.
    List,
    /// One locator, counted from 0.
    Locator(u8),
    /// ADJUST: the pose change.
    Adjust,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Motion {
    Rest,
    Jog(u8),
    Pose,
    /// Told to stop, still moving.
    Stopping,
}

/// What the bottom line says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Message {
    None,
    Enable,
    Direction,
    Multiplier,
    NoChange,
    Limit,
    Busy(PendantId),
    Refused(Refusal),
    Stopped,
    Done,
    Lost,
}

/// The panel of one hand-held pendant.
///
/// A pure state machine: [`handle`](Self::handle) takes what happened at the pendant and at the
/// machine and returns what the machine must do; [`screen`](Self::screen) says what the pendant
/// must show. Panels of several pendants share one [`Arbiter`].
///
/// # The enabling switches
/// Nothing moves unless both are down. When one comes up, or the stop button is pressed, or the
/// link is lost, a motion stops at once, in every state. After power-on and after a lost link both
/// must have been seen up before they count: a switch that is stuck or tied down enables nothing.
///
/// # What the controls do
/// | screen | page up, down | enter | motion start | wheel |
/// |---|---|---|---|---|
/// | SINGLE | cursor | opens the locator or ADJUST | | |
/// | locator | previous, next locator | back to SINGLE; stops a motion first | | jogs the axis of the direction switch (positions 1 to 3: X, Y, Z) |
/// | ADJUST | | back to SINGLE; stops a motion first | runs the pose change | sets the value of the direction switch (positions 1 to 6: X, Y, Z, alpha, beta, gamma) |
///
/// The multiplier switch (positions 1, 2, 3: x1, x10, x100) scales the speed of a jog and the step
/// of a value. Turning the direction switch stops a jog.
#[derive(Clone, Debug, PartialEq, Eq)]
#[expect(
    missing_copy_implementations,
    reason = "a copy would be a second panel of one pendant"
)]
pub struct Panel {
    pendant: PendantId,
    settings: PanelSettings,
    view: View,
    /// Line of the list.
    cursor: u8,
    key: Option<Key>,
    direction: Option<Position>,
    multiplier: Option<Position>,
    left: bool,
    right: bool,
    /// The switches have been seen up.
    armed: bool,
    change: PoseChange,
    motion: Motion,
    message: Message,
}

impl Panel {
    /// A panel that shows SINGLE, with both switches up and the rotary switches not known yet.
    ///
    /// # Errors
    /// [`PanelSettingsError`] for settings that cannot work.
    pub fn new(pendant: PendantId, settings: PanelSettings) -> Result<Self, PanelSettingsError> {
        Ok(Self {
            pendant,
            settings: settings.check()?,
            view: View::List,
            cursor: 0,
            key: None,
            direction: None,
            multiplier: None,
            left: false,
            right: false,
            armed: false,
            change: PoseChange::ZERO,
            motion: Motion::Rest,
            message: Message::None,
        })
    }

    /// Whether both enabling switches are down, and count.
    #[must_use]
    pub const fn is_enabled(&self) -> bool {
        self.left && self.right && self.armed
    }

    /// Whether a motion of this pendant has not come to rest.
    #[must_use]
    pub const fn is_moving(&self) -> bool {
        !matches!(self.motion, Motion::Rest)
    }

    /// The pose change as it is set.
    #[must_use]
    pub const fn change(&self) -> PoseChange {
        self.change
    }

    /// For an LED: flashing while something moves, on while both switches enable it.
    #[must_use]
    pub const fn led(&self) -> LedState {
        if self.is_moving() {
            LedState::Flashing
        } else if self.is_enabled() {
            LedState::On
        } else {
            LedState::Off
        }
    }

    /// Takes what happened; returns what the machine must do.
    pub fn handle<const N: usize>(
        &mut self,
        input: Input,
        arbiter: &mut Arbiter<N>,
    ) -> Option<Action> {
        match input {
            Input::Key(key) => self.key(key, arbiter),
            Input::RotarySwitch(switch, position) => self.switch(switch, position),
            Input::Status(status) => self.status(status),
            Input::Enable { left, right } => self.enable(left, right),
            Input::StopButton => self.stop(Message::Stopped),
            Input::Lost => self.lost(),
            Input::Wheel(counts) => self.wheel(counts, arbiter),
            Input::AtRest => {
                self.at_rest(arbiter);
                None
            }
            Input::Refused(refusal) => {
                if self.is_moving() {
                    self.rest(arbiter, Message::Refused(refusal));
                }
                None
            }
        }
    }

    fn key<const N: usize>(
        &mut self,
        key: Option<Key>,
        arbiter: &mut Arbiter<N>,
    ) -> Option<Action> {
        // The same key again is a repeated telegram.
        let pressed = key.filter(|_| key != self.key);
        self.key = key;
        let role = self.settings.role(pressed?)?;
        if self.is_moving() {
            return match role {
                KeyRole::Enter => self.stop(Message::Stopped),
                _ => None,
            };
        }
        self.message = Message::None;
        match role {
            KeyRole::PageUp => self.page(-1, N),
            KeyRole::PageDown => self.page(1, N),
            KeyRole::Enter => self.enter(N),
            KeyRole::Start => return self.start(arbiter),
        }
        None
    }

    fn page(&mut self, lines: i8, locators: usize) {
        // The list has the body after the locators.
        let last = match self.view {
            View::List => locators,
            View::Locator(_) => locators.saturating_sub(1),
            View::Adjust => return,
        };
        let last = u8::try_from(last).unwrap_or(u8::MAX);
        self.cursor = self.cursor.saturating_add_signed(lines).min(last);
        if let View::Locator(locator) = &mut self.view {
            *locator = self.cursor;
        }
    }

    fn enter(&mut self, locators: usize) {
        self.view = match self.view {
            View::List if usize::from(self.cursor) < locators => View::Locator(self.cursor),
            View::List => View::Adjust,
            View::Locator(_) | View::Adjust => View::List,
        };
    }

    fn start<const N: usize>(&mut self, arbiter: &mut Arbiter<N>) -> Option<Action> {
        if self.view != View::Adjust {
            return None;
        }
        if !self.is_enabled() {
            self.message = Message::Enable;
            return None;
        }
        if self.change == PoseChange::ZERO {
            self.message = Message::NoChange;
            return None;
        }
        self.acquire(Target::Body, arbiter)?;
        self.motion = Motion::Pose;
        Some(Action::Move(self.change))
    }

    fn switch(&mut self, switch: RotarySwitch, position: Position) -> Option<Action> {
        if switch == self.settings.direction_switch {
            self.set_direction(Some(position))
        } else {
            self.multiplier = Some(position);
            None
        }
    }

    fn multiplier(&self) -> Option<Multiplier> {
        self.multiplier.and_then(Multiplier::of_position)
    }

    fn set_direction(&mut self, position: Option<Position>) -> Option<Action> {
        let turned = self.direction != position;
        self.direction = position;
        // The wheel now means another axis.
        if turned && matches!(self.motion, Motion::Jog(_)) {
            return self.stop(Message::Stopped);
        }
        None
    }

    /// Where keys and rotary switches stand: a key that went down unseen does nothing.
    fn status(&mut self, status: Status) -> Option<Action> {
        self.key = status.key();
        let Status::Hbls { w1, w2, .. } = status else {
            return None;
        };
        let (direction, multiplier) = match self.settings.direction_switch {
            RotarySwitch::W1 => (w1, w2),
            RotarySwitch::W2 => (w2, w1),
        };
        self.multiplier = Some(multiplier);
        if self.message == Message::Lost {
            self.message = Message::None;
        }
        self.set_direction(Some(direction))
    }

    fn enable(&mut self, left: bool, right: bool) -> Option<Action> {
        (self.left, self.right) = (left, right);
        self.armed |= !left && !right;
        if self.is_enabled() {
            if self.message == Message::Enable {
                self.message = Message::None;
            }
            return None;
        }
        self.stop(Message::Stopped)
    }

    fn lost(&mut self) -> Option<Action> {
        self.armed = false;
        self.key = None;
        self.direction = None;
        self.multiplier = None;
        let stop = self.stop(Message::Lost);
        self.message = Message::Lost;
        stop
    }

    /// Stops what moves; nothing when nothing does, or stops already.
    fn stop(&mut self, message: Message) -> Option<Action> {
        let target = match self.motion {
            Motion::Jog(locator) => Target::Locator(locator),
            Motion::Pose => Target::Body,
            Motion::Rest | Motion::Stopping => return None,
        };
        self.motion = Motion::Stopping;
        self.message = message;
        Some(Action::Stop(target))
    }

    fn at_rest<const N: usize>(&mut self, arbiter: &mut Arbiter<N>) {
        match self.motion {
            Motion::Rest => {}
            Motion::Pose => self.rest(arbiter, Message::Done),
            Motion::Jog(_) | Motion::Stopping => self.rest(arbiter, self.message),
        }
    }

    fn rest<const N: usize>(&mut self, arbiter: &mut Arbiter<N>, message: Message) {
        self.motion = Motion::Rest;
        self.message = message;
        // Where the body is now is for the machine to know; the change was from where it was.
        if self.view == View::Adjust && !matches!(message, Message::Refused(_)) {
            self.change = PoseChange::ZERO;
        }
        arbiter.release(self.pendant);
    }
}
