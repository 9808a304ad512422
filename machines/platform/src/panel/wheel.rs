//! What the wheel does: jogs an axis of a locator, or sets a value of the pose change.

use handwheel::Position;

use super::{Action, Axis, Message, Motion, Panel, PoseChange, View};
use crate::arbiter::{Arbiter, Refused, Target};

impl Panel {
    pub(super) fn wheel<const N: usize>(
        &mut self,
        counts: i32,
        arbiter: &mut Arbiter<N>,
    ) -> Option<Action> {
        match self.view {
            View::List => None,
            View::Locator(locator) => self.jog(locator, counts, arbiter),
            View::Adjust => {
                self.adjust(counts);
                None
            }
        }
    }

    fn jog<const N: usize>(
        &mut self,
        locator: u8,
        counts: i32,
        arbiter: &mut Arbiter<N>,
    ) -> Option<Action> {
        if self.motion == Motion::Stopping {
            return None;
        }
        if counts == 0 {
            return self.stop(Message::None);
        }
        if !self.is_enabled() {
            self.message = Message::Enable;
            return None;
        }
        let axis = self.direction.and_then(Axis::of_position);
        let multiplier = self.multiplier();
        let Some((axis, multiplier)) = self.switches(axis, multiplier) else {
            // Turned away during a jog.
            return self.stop(self.message);
        };
        let speed_um_s = self.settings.jog_um_s(counts, multiplier);
        if speed_um_s == 0 {
            return self.stop(Message::None);
        }
        self.acquire(Target::Locator(locator), arbiter)?;
        self.motion = Motion::Jog(locator);
        self.message = Message::None;
        Some(Action::Jog {
            locator,
            axis,
            speed_um_s,
        })
    }

    fn adjust(&mut self, counts: i32) {
        if self.is_moving() || counts == 0 {
            return;
        }
        let direction = self.direction.map(Position::get);
        let direction = direction.filter(|&direction| direction <= PoseChange::DIRECTIONS);
        let multiplier = self.multiplier();
        let Some((direction, multiplier)) = self.switches(direction, multiplier) else {
            return;
        };
        let (step, max) = self.settings.adjustment(direction, multiplier);
        if let Some(value) = self.change.value_mut(direction) {
            let wanted = i64::from(*value).saturating_add(step.saturating_mul(counts.into()));
            let held = wanted.clamp(max.saturating_neg(), max);
            self.message = if held == wanted {
                Message::None
            } else {
                Message::Limit
            };
            // Within `max`, which fits.
            *value = i32::try_from(held).unwrap_or(*value);
        }
    }

    /// Both rotary switches, or a message which of them means nothing where it stands.
    fn switches<D, M>(&mut self, direction: Option<D>, multiplier: Option<M>) -> Option<(D, M)> {
        if direction.is_none() {
            self.message = Message::Direction;
        } else if multiplier.is_none() {
            self.message = Message::Multiplier;
        }
        direction.zip(multiplier)
    }

    pub(super) fn acquire<const N: usize>(
        &mut self,
        target: Target,
        arbiter: &mut Arbiter<N>,
    ) -> Option<()> {
        match arbiter.acquire(target, self.pendant) {
            Ok(()) => Some(()),
            Err(Refused::Owned { owner, .. }) => {
                self.message = Message::Busy(owner);
                None
            }
            // The list has no other locators.
            Err(Refused::NoSuchLocator { .. }) => None,
        }
    }
}
