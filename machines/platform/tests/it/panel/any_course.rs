//! Any course of inputs is safe.

use super::*;

fn input() -> impl Strategy<Value = Input> {
    let key = || prop::option::of((1u8..=5).prop_map(|key| Key::new(key).unwrap()));
    let position = || (1u8..=7).prop_map(|position| Position::new(position).unwrap());
    let switch = prop::sample::select(vec![RotarySwitch::W1, RotarySwitch::W2]);
    prop_oneof![
        6 => key().prop_map(Input::Key),
        2 => (switch, position())
            .prop_map(|(switch, position)| Input::RotarySwitch(switch, position)),
        2 => (key(), position(), position())
            .prop_map(|(key, w1, w2)| Input::Status(Status::Hbls { key, w1, w2 })),
        4 => (prop::bool::weighted(0.8), prop::bool::weighted(0.8))
            .prop_map(|(left, right)| Input::Enable { left, right }),
        1 => Just(Input::Enable { left: false, right: false }),
        6 => (-300..300i32).prop_map(Input::Wheel),
        1 => any::<i32>().prop_map(Input::Wheel),
        1 => Just(Input::Wheel(0)),
        1 => Just(Input::StopButton),
        1 => Just(Input::Lost),
        3 => Just(Input::AtRest),
        1 => Just(Input::Refused(Refusal::NotReady)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Any course of inputs at two pendants: nothing moves unless both switches of its pendant are
    /// down and have been up before; a stop follows at once when one comes up, or the link or the
    /// stop button says so; nothing is moved by two; and every screen can be shown.
    #[test]
    fn any_course_is_safe(inputs in prop::collection::vec((0usize..2, input()), 1..150)) {
        let mut desk = Desk::new(2);
        let mut down = [false; 2];
        let mut armed = [true; 2];
        let mut moving = [None; 2];
        for (unit, input) in inputs {
            match input {
                Input::Enable { left, right } => {
                    down[unit] = left && right;
                    armed[unit] |= !left && !right;
                }
                Input::Lost => armed[unit] = false,
                Input::AtRest | Input::Refused(_) => moving[unit] = None,
                _ => {}
            }
            let action = desk.on(unit, input);
            let enabled = down[unit] && armed[unit];
            prop_assert_eq!(desk.panels[unit].is_enabled(), enabled);
            let target = match action {
                Some(Action::Jog { locator, speed_um_s, .. }) => {
                    prop_assert!(speed_um_s != 0 && speed_um_s.unsigned_abs() <= 10_000);
                    Some(Target::Locator(locator))
                }
                Some(Action::Move(change)) => {
                    prop_assert!(change != PoseChange::ZERO);
                    Some(Target::Body)
                }
                Some(Action::Stop(target)) => {
                    prop_assert_eq!(moving[unit], Some((target, true)));
                    moving[unit] = Some((target, false));
                    None
                }
                _ => None,
            };
            if let Some(target) = target {
                prop_assert!(enabled);
                prop_assert!(moving[unit].is_none_or(|it| it == (target, true)));
                moving[unit] = Some((target, true));
            }
            let must_stop = !enabled || input == Input::StopButton;
            prop_assert!(!must_stop || moving[unit].is_none_or(|(_, runs)| !runs));
            if let [Some((a, _)), Some((b, _))] = moving {
                prop_assert!(a != b && a != Target::Body && b != Target::Body);
            }
            for (unit, panel) in (0u8..).zip(&desk.panels) {
                prop_assert_eq!(panel.is_moving(), moving[usize::from(unit)].is_some());
                let owns = [0, 1, 2].map(Target::Locator).into_iter().chain([Target::Body])
                    .any(|it| desk.arbiter.owner(it) == Some(PendantId(unit)));
                prop_assert_eq!(owns, panel.is_moving());
            }
            prop_assert!(desk.screen(unit).iter().all(|line| line.len() <= 16));
        }
    }
}
