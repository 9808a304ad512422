//! What is refused, by its kind and its numbers; and that messages name place and value.

use pulse_interp::{
    Arc, ArcError, AxesError, AxesLine, AxisLoop, Dda, Direction, HomingError, Line, LineError,
    LoopError, LoopSettings, ScaleRatio, SwitchError, Switches, Turn,
};

const CCW: Turn = Turn::CounterClockwise;

fn off_by(arc: Result<Arc, ArcError>) -> i64 {
    match arc {
        Err(ArcError::EndOffCircle { off_millisteps, .. }) => off_millisteps,
        other => panic!("{other:?}"),
    }
}

#[test]
fn lines_and_axes_that_are_too_long() {
    let too_long = AxesLine::new([1, 2, i32::MIN]);
    assert!(matches!(too_long, Err(AxesError::TooLong { axis: 2, .. })));
    let too_few = Dda::over([5, -7], 6);
    assert!(matches!(
        too_few,
        Err(AxesError::Ticks {
            ticks: 6,
            least: 7,
            ..
        })
    ));
    let too_many = Dda::over([0], u32::MAX);
    assert!(matches!(
        too_many,
        Err(AxesError::Ticks {
            ticks: u32::MAX,
            ..
        })
    ));
    let line = Line::new([0, i32::MIN]);
    assert!(matches!(line, Err(LineError::TooLong { axis: 1, .. })));
}

#[test]
fn arcs_without_a_circle_or_off_it() {
    assert_eq!(Arc::new([0, 0], [1, 0], CCW), Err(ArcError::NoRadius));
    let at_centre = Arc::near([1, 0], [0, 0], CCW, 9999);
    assert_eq!(at_centre, Err(ArcError::EndAtCentre));
    let beyond = Arc::new([1 << 30, 1], [1 << 30, 1], CCW);
    assert!(matches!(beyond, Err(ArcError::RadiusTooLarge { .. })));
    // 5.385 against 5.
    assert_eq!(off_by(Arc::near([5, 0], [5, 2], CCW, 300)), 386);
    assert_eq!(off_by(Arc::new([5, 0], [2, 4], CCW)), -528);
    // A square off by one, far out: less than a thousandth, but not nothing.
    assert_eq!(off_by(Arc::new([1 << 29, 0], [1 << 29, 1], CCW)), 1);
}

#[test]
fn loops_and_scales_that_cannot_be() {
    for (counts, steps) in [(5, 0), (0, 1)] {
        let refused = ScaleRatio::new(counts, steps);
        assert_eq!(refused, Err(LoopError::Ratio { counts, steps }));
    }
    assert!(loop_of(50).is_err() && loop_of(49).is_ok());
}

fn loop_of(dead_band_counts: u32) -> Result<AxisLoop, LoopError> {
    AxisLoop::new(LoopSettings {
        ratio: ScaleRatio::new(5, 1)?,
        dead_band_counts,
        alarm_counts: 50,
    })
}

#[test]
fn messages_name_place_and_value() {
    let both = Switches {
        lower: true,
        upper: true,
    };
    let lost = {
        let mut axis = loop_of(3).unwrap();
        (0..20).for_each(|_| axis.command(Direction::Positive));
        axis.correction(49).unwrap_err()
    };
    for (message, wanted) in [
        (
            AxesLine::new([1, 2, i32::MIN]).unwrap_err().to_string(),
            "axis 2: -2147483648 steps, more than 2147483647 either way",
        ),
        (
            Dda::over([5, -7], 6).unwrap_err().to_string(),
            "6 ticks, not within 7..=2147483647",
        ),
        (
            Arc::new([1 << 30, 1], [1 << 30, 1], CCW)
                .unwrap_err()
                .to_string(),
            "start (1073741824, 1): the radius is above 1073741824 steps",
        ),
        (
            Arc::near([5, 0], [5, 2], CCW, 300).unwrap_err().to_string(),
            "end (5, 2): 386 thousandths of a step outside the circle, 300 allowed either way",
        ),
        (
            lost.to_string(),
            "-51 counts off at 49 counts, 20 steps: above the alarm at 50",
        ),
        (
            loop_of(50).unwrap_err().to_string(),
            "a dead band of 50 counts is not below the alarm at 50",
        ),
        (
            both.permit(Direction::Negative, 7).unwrap_err().to_string(),
            "both limit switches are closed at 7 steps",
        ),
        (
            HomingError::NeverOpened { steps: 1000 }.to_string(),
            "the switch has not stayed open within 1000 steps back",
        ),
    ] {
        assert_eq!(message, wanted);
    }
    for direction in [Direction::Negative, Direction::Positive] {
        let position_steps = 7;
        let refused = both.permit(direction, 7);
        assert_eq!(refused, Err(SwitchError::BothClosed { position_steps }));
    }
}
