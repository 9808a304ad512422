//! The three screens, as the panel's pendant must show them.

use super::{Axis, Message, Motion, Multiplier, Panel, Refusal, View};
use crate::arbiter::{Arbiter, Target};
use crate::screen::{Decimal, LINES, Screen};

/// Lines between title and message.
const ROWS: usize = LINES - 2;
const MESSAGE: usize = LINES - 1;
/// Where IDLE and BUSY begin.
const STATE: usize = 12;
/// Where a number ends, and how many cells it has: sign, point and digits.
const NUMBER_END: usize = 13;
const NUMBER: usize = 10;
/// After `LOCATOR`, and as wide as 255.
const INDEX_END: usize = 11;
const INDEX: usize = 3;

impl Panel {
    /// What the pendant must show. `positions_um` are the axis positions of all locators, in
    /// micrometres.
    #[must_use]
    pub fn screen<const N: usize>(
        &self,
        arbiter: &Arbiter<N>,
        positions_um: &[[i32; 3]; N],
    ) -> Screen {
        let mut screen = Screen::BLANK;
        match self.view {
            View::List => self.list(&mut screen, arbiter),
            View::Locator(locator) => {
                title(&mut screen, 0, locator, arbiter);
                let position = positions_um.get(usize::from(locator));
                self.locator(&mut screen, position.copied().unwrap_or_default());
            }
            View::Adjust => self.adjustment(&mut screen, arbiter),
        }
        self.message(&mut screen);
        screen
    }

    fn list<const N: usize>(&self, screen: &mut Screen, arbiter: &Arbiter<N>) {
        screen.put(0, 0, "SINGLE");
        let cursor = usize::from(self.cursor);
        let top = cursor.saturating_sub(ROWS - 1);
        for (row, entry) in (1..=ROWS).zip(top..=N) {
            match u8::try_from(entry).ok().filter(|_| entry < N) {
                Some(locator) => title(screen, row, locator, arbiter),
                None => {
                    screen.put(row, 1, "ADJUST");
                    state(screen, row, Target::Body, arbiter);
                }
            }
            if entry == cursor {
                screen.put(row, 0, ">");
            }
        }
    }

    fn locator(&self, screen: &mut Screen, position_um: [i32; 3]) {
        let chosen = self.direction.and_then(Axis::of_position);
        let names = ["X", "Y", "Z"];
        for (row, ((axis, name), value)) in
            (2..).zip(Axis::ALL.into_iter().zip(names).zip(position_um))
        {
            value_row(screen, row, name, value, false);
            if chosen == Some(axis) {
                screen.put(row, 0, ">");
            }
        }
        screen.put(6, 1, "SPEED");
        screen.put(6, STATE, self.multiplier_name());
    }

    fn adjustment<const N: usize>(&self, screen: &mut Screen, arbiter: &Arbiter<N>) {
        screen.put(0, 0, "ADJUST");
        screen.put(0, 7, self.multiplier_name());
        state(screen, 0, Target::Body, arbiter);
        let chosen = self.direction.map(|it| usize::from(it.get()));
        let names = ["dX", "dY", "dZ", "da", "db", "dg"];
        for (row, (name, (value, angle))) in (1..).zip(names.into_iter().zip(self.change.values()))
        {
            value_row(screen, row, name, value, angle);
            if chosen == Some(row) {
                screen.put(row, 0, ">");
            }
        }
    }

    fn multiplier_name(&self) -> &'static str {
        self.multiplier().map_or("x?", Multiplier::name)
    }

    fn message(&self, screen: &mut Screen) {
        let text = match self.message {
            Message::None if self.motion == Motion::Stopping => "STOPPING",
            Message::None => "",
            Message::Enable => "ENABLE SWITCHES?",
            Message::Direction => "DIRECTION?",
            Message::Multiplier => "MULTIPLIER?",
            Message::NoChange => "NO CHANGE SET",
            Message::Limit => "LIMIT",
            Message::Refused(Refusal::OutOfReach) => "OUT OF REACH",
            Message::Refused(Refusal::NotReady) => "NOT READY",
            Message::Stopped => "STOPPED",
            Message::Done => "DONE",
            Message::Lost => "LINK LOST",
            Message::Busy(owner) => {
                screen.put_number(MESSAGE, 14, 4, whole(owner.0));
                "BUSY: UNIT"
            }
        };
        screen.put(MESSAGE, 0, text);
    }
}

/// `LOCATOR  1 IDLE`, counted from 1.
fn title<const N: usize>(screen: &mut Screen, row: usize, locator: u8, arbiter: &Arbiter<N>) {
    screen.put_number(row, INDEX_END, INDEX, whole(locator.saturating_add(1)));
    screen.put(row, 1, "LOCATOR");
    state(screen, row, Target::Locator(locator), arbiter);
}

fn state<const N: usize>(screen: &mut Screen, row: usize, target: Target, arbiter: &Arbiter<N>) {
    let busy = arbiter.owner(target).is_some();
    screen.put(row, STATE, if busy { "BUSY" } else { "IDLE" });
}

fn value_row(screen: &mut Screen, row: usize, name: &str, value: i32, angle: bool) {
    let (decimals, unit) = if angle { (6, "deg") } else { (3, " mm") };
    screen.put(row, 1, name);
    let value = Decimal {
        value,
        decimals,
        signed: true,
    };
    screen.put_number(row, NUMBER_END, NUMBER, value);
    screen.put(row, NUMBER_END, unit);
}

fn whole(value: u8) -> Decimal {
    Decimal {
        value: value.into(),
        decimals: 0,
        signed: false,
    }
}
