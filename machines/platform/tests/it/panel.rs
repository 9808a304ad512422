//! The panel as an operator and a machine see it.

mod any_course;
mod screens;

use handwheel::{Event, Key, LcdAnswer, LedState, Position, RotarySwitch, Status, WheelQuantiser};
use platform::{
    Action, Arbiter, Axis, Input, Panel, PanelSettings, PanelSettingsError, PendantId, PoseChange,
    Refusal, Refused, Target,
};
use proptest::prelude::*;

const UP: u8 = 1;
const DOWN: u8 = 2;
const ENTER: u8 = 3;
const START: u8 = 4;

/// A panel with three locators, its rotary switches known, both switches seen up.
struct Desk {
    arbiter: Arbiter<3>,
    panels: Vec<Panel>,
}

impl Desk {
    fn new(units: u8) -> Self {
        let settings = PanelSettings::new(WheelQuantiser::new(100, 10).unwrap());
        let panel = |unit| Panel::new(PendantId(unit), settings).unwrap();
        let mut desk = Self {
            arbiter: Arbiter::new(),
            panels: (0..units).map(panel).collect(),
        };
        for unit in 0..units.into() {
            desk.rotary_switches(unit, 3, 1);
            desk.switches(unit, false, false);
        }
        desk
    }

    fn on(&mut self, unit: usize, input: Input) -> Option<Action> {
        self.panels[unit].handle(input, &mut self.arbiter)
    }

    fn press(&mut self, unit: usize, key: u8) -> Option<Action> {
        let action = self.on(unit, Input::Key(Key::new(key).ok()));
        assert_eq!(self.on(unit, Input::Key(None)), None);
        action
    }

    fn rotary_switches(&mut self, unit: usize, multiplier: u8, direction: u8) {
        let [w1, w2] = [multiplier, direction].map(|it| Position::new(it).unwrap());
        let status = Status::Hbls { key: None, w1, w2 };
        assert_eq!(self.on(unit, Input::Status(status)), None);
    }

    fn switches(&mut self, unit: usize, left: bool, right: bool) -> Option<Action> {
        self.on(unit, Input::Enable { left, right })
    }

    fn screen(&self, unit: usize) -> Vec<String> {
        let positions = [[1_234_567, -1, 0], [0; 3], [i32::MIN; 3]];
        let screen = self.panels[unit].screen(&self.arbiter, &positions);
        let text = screen.to_string();
        text.lines()
            .map(|line| line.trim_end().to_owned())
            .collect()
    }

    fn message(&self, unit: usize) -> String {
        self.screen(unit)[7].clone()
    }
}

fn jog(locator: u8, axis: Axis, speed_um_s: i32) -> Option<Action> {
    Some(Action::Jog {
        locator,
        axis,
        speed_um_s,
    })
}

#[test]
fn a_key_that_went_down_unseen_does_nothing() {
    let mut desk = Desk::new(1);
    let key = Key::new(ENTER).ok();
    let (w1, w2) = (Position::MIN, Position::MIN);
    desk.on(0, Input::Status(Status::Hbls { key, w1, w2 }));
    desk.on(0, Input::Key(key));
    assert_eq!(desk.screen(0)[0], "SINGLE");
    desk.on(0, Input::Key(None));
    desk.on(0, Input::Key(key));
    assert_eq!(desk.screen(0)[0], " LOCATOR  1 IDLE");
}

#[test]
fn events_of_the_driver_are_inputs() {
    let key = Key::new(5).ok();
    let lcd = LcdAnswer::Done;
    let status = Status::Hbas { key, lcd };
    let (switch, position) = (RotarySwitch::W2, Position::MAX);
    let connected = false;
    for (event, input) in [
        (Event::Key(key), Some(Input::Key(key))),
        (
            Event::RotarySwitch(switch, position),
            Some(Input::RotarySwitch(switch, position)),
        ),
        (
            Event::Status { status, connected },
            Some(Input::Status(status)),
        ),
        (
            Event::Lcd {
                answer: lcd,
                status: Some(status),
            },
            Some(Input::Status(status)),
        ),
        (Event::Lost, Some(Input::Lost)),
        (Event::LedDone, None),
    ] {
        assert_eq!(Input::of_event(&event), input);
    }
}

#[test]
fn a_jog_follows_the_wheel_and_stops() {
    let mut desk = Desk::new(1);
    desk.press(0, ENTER);
    assert_eq!(desk.on(0, Input::Wheel(10)), None);
    assert_eq!(desk.message(0), "ENABLE SWITCHES?");
    assert_eq!(desk.switches(0, true, false), None);
    assert_eq!(desk.on(0, Input::Wheel(10)), None);
    assert_eq!(desk.switches(0, true, true), None);
    assert_eq!(desk.panels[0].led(), LedState::On);
    assert_eq!(desk.on(0, Input::Wheel(10)), jog(0, Axis::X, 1500));
    assert_eq!(desk.on(0, Input::Wheel(-100)), jog(0, Axis::X, -10_000));
    assert_eq!(desk.panels[0].led(), LedState::Flashing);
    assert_eq!(desk.screen(0)[0], " LOCATOR  1 BUSY");
    // The wheel stands: stop, and nothing until the axis is at rest.
    let stop = Some(Action::Stop(Target::Locator(0)));
    assert_eq!(desk.on(0, Input::Wheel(0)), stop);
    assert_eq!(desk.on(0, Input::Wheel(50)), None);
    assert_eq!(desk.message(0), "STOPPING");
    desk.on(0, Input::AtRest);
    assert_eq!(desk.screen(0)[0], " LOCATOR  1 IDLE");
    // The direction changes while it moves: stop.
    desk.on(0, Input::RotarySwitch(RotarySwitch::W1, Position::MIN));
    assert_eq!(desk.on(0, Input::Wheel(50)), jog(0, Axis::X, 55));
    let third = Position::new(3).unwrap();
    assert_eq!(
        desk.on(0, Input::RotarySwitch(RotarySwitch::W2, third)),
        stop
    );
    desk.on(0, Input::AtRest);
    assert_eq!(desk.on(0, Input::Wheel(50)), jog(0, Axis::Z, 55));
    // The same direction once more changes nothing.
    assert_eq!(
        desk.on(0, Input::RotarySwitch(RotarySwitch::W2, third)),
        None
    );
    // Of the keys only enter stops, and the screen stays.
    assert_eq!(desk.press(0, DOWN), None);
    assert_eq!(desk.press(0, ENTER), stop);
    assert_eq!(desk.screen(0)[0], " LOCATOR  1 BUSY");
    desk.on(0, Input::AtRest);
    assert_eq!(desk.message(0), "STOPPED");
    assert_eq!(desk.on(0, Input::Wheel(50)), jog(0, Axis::Z, 55));
    // A multiplier that is none: stop, and say why.
    desk.on(0, Input::RotarySwitch(RotarySwitch::W1, Position::MAX));
    assert_eq!(desk.on(0, Input::Wheel(50)), stop);
    assert_eq!(desk.message(0), "MULTIPLIER?");
}

#[test]
fn a_pose_change_runs() {
    let mut desk = Desk::new(1);
    for _ in 0..3 {
        desk.press(0, DOWN);
    }
    desk.press(0, ENTER);
    desk.switches(0, true, true);
    assert_eq!(desk.press(0, START), None);
    assert_eq!(desk.message(0), "NO CHANGE SET");
    desk.on(0, Input::Wheel(25));
    desk.rotary_switches(0, 1, 4);
    desk.on(0, Input::Wheel(-7));
    desk.switches(0, false, true);
    assert_eq!(desk.press(0, START), None);
    assert_eq!(desk.message(0), "ENABLE SWITCHES?");
    desk.switches(0, true, true);
    let change = PoseChange {
        translation_um: [2500, 0, 0],
        rotation_udeg: [-700, 0, 0],
    };
    assert_eq!(desk.press(0, START), Some(Action::Move(change)));
    assert_eq!(desk.press(0, START), None);
    assert_eq!(desk.screen(0)[0], "ADJUST x1   BUSY");
    // The body does not follow the rotary switches.
    assert_eq!(
        desk.on(0, Input::RotarySwitch(RotarySwitch::W2, Position::MIN)),
        None
    );
    assert_eq!(desk.screen(0)[0], "ADJUST x1   BUSY");
    desk.on(0, Input::AtRest);
    assert_eq!(desk.message(0), "DONE");
    assert_eq!(desk.panels[0].change(), PoseChange::ZERO);

    desk.on(0, Input::Wheel(1));
    assert!(desk.press(0, START).is_some());
    desk.on(0, Input::Refused(Refusal::OutOfReach));
    assert_eq!(desk.message(0), "OUT OF REACH");
    // It stays, to be made smaller.
    assert_ne!(desk.panels[0].change(), PoseChange::ZERO);
    assert!(desk.press(0, START).is_some());
    let stop = Some(Action::Stop(Target::Body));
    assert_eq!(desk.on(0, Input::StopButton), stop);
    desk.on(0, Input::AtRest);
    assert_eq!(desk.message(0), "STOPPED");
    assert_eq!(desk.panels[0].change(), PoseChange::ZERO);

    desk.rotary_switches(0, 3, 2);
    desk.on(0, Input::Wheel(i32::MAX));
    assert_eq!(desk.message(0), "LIMIT");
    assert_eq!(desk.panels[0].change().translation_um[1], 100_000);
}

#[test]
fn one_owner_at_a_time() {
    let mut desk = Desk::new(2);
    for unit in 0..2 {
        desk.press(unit, ENTER);
        desk.switches(unit, true, true);
    }
    assert!(desk.on(0, Input::Wheel(50)).is_some());
    assert_eq!(desk.on(1, Input::Wheel(50)), None);
    assert_eq!(desk.message(1), "BUSY: UNIT   0");
    // Another locator is free, the body is not.
    desk.press(1, DOWN);
    assert!(desk.on(1, Input::Wheel(50)).is_some());
    assert_eq!(
        desk.on(1, Input::Wheel(0)),
        Some(Action::Stop(Target::Locator(1)))
    );
    desk.on(1, Input::AtRest);
    desk.press(1, ENTER);
    desk.press(1, DOWN);
    desk.press(1, DOWN);
    desk.press(1, ENTER);
    desk.on(1, Input::Wheel(50));
    assert_eq!(desk.press(1, START), None);
    assert_eq!(desk.message(1), "BUSY: UNIT   0");
    // The link of the first is lost: it stops, and what it had is free when it is at rest.
    assert_eq!(
        desk.on(0, Input::Lost),
        Some(Action::Stop(Target::Locator(0)))
    );
    assert_eq!(desk.press(1, START), None);
    desk.on(0, Input::AtRest);
    assert!(desk.press(1, START).is_some());
    // Back again, with the switches held: nothing, until they were up.
    desk.rotary_switches(0, 3, 1);
    desk.switches(0, true, true);
    assert_eq!(desk.on(0, Input::Wheel(50)), None);
    assert_eq!(desk.message(0), "ENABLE SWITCHES?");
    desk.switches(0, false, false);
    desk.switches(0, true, true);
    assert_eq!(desk.on(0, Input::Wheel(50)), None);
    assert_eq!(desk.message(0), "BUSY: UNIT   1");
}

#[test]
fn arbiter_refuses_by_name() {
    let mut arbiter = Arbiter::<2>::new();
    let (target, owner) = (Target::Locator(1), PendantId(7));
    arbiter.acquire(target, owner).unwrap();
    let refused = arbiter.acquire(Target::Body, PendantId(1));
    assert_eq!(refused, Err(Refused::Owned { target, owner }));
    assert!(arbiter.acquire(Target::Body, owner).is_ok());
    assert_eq!(arbiter.owner(Target::Locator(0)), Some(owner));
    let (index, locators) = (2, 2);
    let missing = arbiter.acquire(Target::Locator(index), owner);
    assert_eq!(missing, Err(Refused::NoSuchLocator { index, locators }));
    arbiter.release(owner);
    assert_eq!(arbiter, Arbiter::new());
}

#[test]
fn settings_are_checked() {
    let good = PanelSettings::new(WheelQuantiser::new(100, 10).unwrap());
    let (name, value) = ("step_um", 0);
    let zero = PanelSettings { step_um: 0, ..good };
    let refused = Panel::new(PendantId(0), zero);
    assert_eq!(refused, Err(PanelSettingsError::Range { name, value }));
    let key = Key::MIN;
    let same = PanelSettings {
        keys: [key, Key::MAX, key, Key::MAX],
        ..good
    };
    assert_eq!(
        Panel::new(PendantId(0), same),
        Err(PanelSettingsError::SameKey { key })
    );
}
