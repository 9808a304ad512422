//! Rounding to steps, tracking and homing.

use stepper_sync::{
    Direction, Level, Position, PositionError, ScaleError, StepCarry, StepScale, Trains,
};

#[test]
fn absolute_rounding_does_not_drift() {
    // 0.3 steps a move: rounding each increment would never move at all.
    let scale = StepScale::new(0.3).unwrap();
    let mut position = Position::home();
    for k in 1..=100_000 {
        let target = scale.to_steps(f64::from(k)).unwrap();
        position.move_to([target]).unwrap();
    }
    assert_eq!(position.steps(), [30_000]);
    assert_eq!(position.homing(), [-30_000]);
}

#[test]
fn halves_round_away_from_zero_up_to_the_limits() {
    let scale = StepScale::new(1.0).unwrap();
    let cases = [
        (0.5, 1),
        (-0.5, -1),
        (0.499_999_999_999_999_94, 0),
        (-0.499_999_999_999_999_94, 0),
        (2.5, 3),
        (-2.5, -3),
        (2_147_483_646.5, i32::MAX),
        (2_147_483_647.499, i32::MAX),
        (-2_147_483_647.499, -i32::MAX),
    ];
    for (position, steps) in cases {
        assert_eq!(scale.to_steps(position), Ok(steps), "{position}");
    }
    assert_eq!(StepScale::new(-2.0).unwrap().to_steps(1.5_f32), Ok(-3));
    assert!((StepScale::new(-2.0).unwrap().to_position(3) + 1.5).abs() < f64::EPSILON);
}

#[test]
fn positions_without_steps_are_refused() {
    let scale = StepScale::new(2.0).unwrap();
    for position in [f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(
            scale.to_steps(position),
            Err(ScaleError::NotFinite { position })
        );
    }
    assert!(matches!(
        scale.to_steps(f64::NAN),
        Err(ScaleError::NotFinite { .. })
    ));
    for position in [1_073_741_823.75, -1_073_741_823.75, f64::MAX] {
        assert_eq!(
            scale.to_steps(position),
            Err(ScaleError::OutOfRange {
                position,
                steps: position * 2.0,
                limit: i32::MAX
            })
        );
    }
    for steps_per_unit in [0.0, -0.0, f64::INFINITY] {
        assert_eq!(
            StepScale::new(steps_per_unit),
            Err(ScaleError::Scale { steps_per_unit })
        );
    }
    assert!(StepScale::new(f64::NAN).is_err());
}

#[test]
fn carried_remainder_is_exact_both_ways() {
    let mut carry = StepCarry::new(7, 3).unwrap();
    let mut units = 0_i64;
    let mut steps = 0_i64;
    for increment in [1, 1, 1, -5, 100, -99, i32::MAX / 7, -i32::MAX / 7, 2] {
        units += i64::from(increment);
        steps += i64::from(carry.advance(increment).unwrap());
        // floor(7 units / 3 + 1/2), and 3 / 2 rounded down to 1 third.
        assert_eq!(steps, (units * 7 + 1).div_euclid(3));
    }
    let before = carry;
    let due = ((units + i64::from(i32::MAX)) * 7 + 1).div_euclid(3) - steps;
    assert_eq!(
        carry.advance(i32::MAX),
        Err(ScaleError::IncrementOutOfRange {
            units: i32::MAX,
            steps: due,
            limit: i32::MAX
        })
    );
    assert_eq!(carry, before);
    for (steps, units) in [(0, 1), (1, 0)] {
        assert_eq!(
            StepCarry::new(steps, units),
            Err(ScaleError::Ratio { steps, units })
        );
    }
}

#[test]
fn overflow_names_axis_position_and_limit_and_moves_nothing() {
    let mut position = Position::home();
    position.apply([1, i32::MAX]).unwrap();
    assert_eq!(
        position.apply([5, 1]),
        Err(PositionError::LimitPassed {
            axis: 1,
            position: i32::MAX,
            steps: 1,
            limit: i32::MAX
        })
    );
    assert_eq!(position.steps(), [1, i32::MAX]);
    assert_eq!(
        position.move_to([2, -1]),
        Err(PositionError::MoveTooLong {
            axis: 1,
            position: i32::MAX,
            target: -1
        })
    );
    assert_eq!(position.steps(), [1, i32::MAX]);
    position.apply(position.homing()).unwrap();
    position.apply([0, -i32::MAX]).unwrap();
    assert_eq!(position.homing(), [0, i32::MAX]);
    let error = position.apply([0, -1]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "axis 1: -1 steps from -2147483647 pass the limit -2147483647"
    );
}

#[test]
fn limits_hold_for_moves_targets_and_steps() {
    let mut position = Position::<2>::home().with_limits(1, -10, 20).unwrap();
    assert_eq!(position.move_to([0, 20]), Ok([0, 20]));
    assert_eq!(
        position.step(1, Direction::Positive),
        Err(PositionError::LimitPassed {
            axis: 1,
            position: 20,
            steps: 1,
            limit: 20
        })
    );
    assert_eq!(position.step(1, Direction::Negative), Ok(()));
    assert_eq!(
        position.move_to([0, -11]),
        Err(PositionError::TargetPastLimit {
            axis: 1,
            target: -11,
            limit: -10
        })
    );
    assert_eq!(
        position.step(2, Direction::Positive),
        Err(PositionError::NoSuchAxis { axis: 2, axes: 2 })
    );
    assert_eq!(
        position.with_limits(1, 20, 30),
        Err(PositionError::Limits {
            axis: 1,
            min: 20,
            max: 30,
            position: 19
        })
    );
    assert!(position.with_limits(0, i32::MIN, 0).is_err());
    assert!(position.with_limits(2, 0, 0).is_err());
}

#[test]
fn edges_move_the_axes_by_their_steps() {
    let steps = [30, -7, 0];
    let trains = Trains::new(steps, 4096).unwrap();
    let directions = trains.directions();
    let mut position = Position::default();
    for edge in trains.edges().filter(|edge| edge.level == Level::High) {
        position
            .step(edge.axis, directions[edge.axis].unwrap())
            .unwrap();
    }
    assert_eq!(position.steps(), steps);
}
