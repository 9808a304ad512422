//! Scale, switches and homing on a simulated axis.

use pulse_interp::{
    AxisLoop, Direction, Homing, HomingError, HomingOrder, HomingSettings, HomingSpeed,
    LoopSettings, ScaleRatio, SwitchError, Switches, TravelEnd,
};

fn settings((counts, steps): (u16, u16), dead_band_counts: u32, alarm_counts: u32) -> LoopSettings {
    LoopSettings {
        ratio: ScaleRatio::new(counts, steps).unwrap(),
        dead_band_counts,
        alarm_counts,
    }
}

/// The stage: 500 counts/mm, 100 steps/mm, dead band 3 counts.
fn stage() -> LoopSettings {
    settings((5, 1), 3, 50)
}

fn commanded(settings: LoopSettings, steps: i32) -> AxisLoop {
    let mut axis = AxisLoop::new(settings).unwrap();
    let direction = if steps < 0 {
        Direction::Negative
    } else {
        Direction::Positive
    };
    for _ in 0..steps.abs() {
        axis.command(direction);
    }
    axis
}

#[test]
fn the_dead_band_is_left_alone_and_the_rest_corrected() {
    // Counts off, and steps that correct them: 5 counts are a step, 3 are left alone.
    for (off, wanted) in [
        (0, 0),
        (3, 0),
        (-3, 0),
        (4, -1),
        (-4, 1),
        (-7, 1),
        (-8, 2),
        (50, -10),
        (-50, 10),
    ] {
        let mut axis = commanded(stage(), -20);
        assert_eq!(axis.correction(-100 + off), Ok(wanted), "{off}");
    }
}

#[test]
fn an_alarm_says_where_and_stays_until_reset() {
    let mut axis = commanded(stage(), 20);
    let lost = axis.correction(49).unwrap_err();
    let numbers = (lost.error_counts, lost.counts, lost.commanded_steps);
    assert_eq!((numbers, lost.alarm_counts), ((-51, 49, 20), 50));
    // Back in place, but who knows since when.
    assert!(axis.correction(100).is_err());
    axis.reset();
    assert_eq!((axis.commanded_steps(), axis.correction(0)), (0, Ok(0)));
}

/// A count in 65,535 steps: 40,000 counts are more steps than an `i32` holds.
#[test]
fn what_no_steps_can_correct_is_lost_for_good() {
    let of_band = |band| AxisLoop::new(settings((1, 65_535), band, 60_000)).unwrap();
    let mut axis = of_band(20_000);
    assert_eq!(axis.correction(30_000), Ok(-1_966_050_000));
    assert!(axis.correction(40_000).is_err());
    assert!(axis.correction(0).is_err());
    let mut axis = of_band(50_000);
    assert_eq!(axis.correction(40_000), Ok(0));
}

/// 7 counts in 3 steps: no whole number of counts per step.
#[test]
fn ratios_are_fractions() {
    // 10 steps are 23 1/3 counts.
    for (counts, wanted) in [(22, 0), (25, 0), (26, -1), (21, 1), (0, 10), (-7, 13)] {
        let mut axis = commanded(settings((7, 3), 2, 100), 10);
        assert_eq!(axis.correction(counts), Ok(wanted), "{counts}");
    }
}

#[test]
fn a_corrected_axis_is_in_its_dead_band() {
    for (counts, steps) in [(5_u16, 1_u16), (7, 3), (1, 4), (1000, 1)] {
        let dead_band = u32::from(counts.div_ceil(2 * steps)) + 1;
        let settings = settings((counts, steps), dead_band, u32::MAX);
        for lost in -20..=20 {
            let mut axis = commanded(settings, 37);
            let scale = |steps_made: i32| steps_made * i32::from(counts) / i32::from(steps);
            let correction = axis.correction(scale(37 - lost)).unwrap();
            assert_eq!(axis.correction(scale(37 - lost + correction)), Ok(0));
        }
    }
}

#[test]
fn a_closed_switch_stops_one_way_only() {
    let upper = Switches {
        lower: false,
        upper: true,
    };
    assert_eq!(
        upper.permit(Direction::Positive, 19_999),
        Err(SwitchError::Hit {
            end: TravelEnd::Upper,
            position_steps: 19_999
        })
    );
    assert_eq!(upper.permit(Direction::Negative, 19_999), Ok(()));
    assert!(Switches::default().permit(Direction::Negative, 0).is_ok());
}

const HOMING: HomingSettings = HomingSettings {
    direction: Direction::Negative,
    max_steps: 1000,
    clear_steps: 20,
};

/// Homes an axis; its place, and the orders it got.
fn home(mut position: i32, closed: impl Fn(i32) -> bool) -> (i32, Vec<HomingOrder>) {
    let mut homing = Homing::new(HOMING);
    let mut orders = Vec::new();
    loop {
        let order = homing.next(closed(position)).unwrap();
        let HomingOrder::Step { direction, .. } = order else {
            assert_eq!(homing.next(false), Ok(HomingOrder::Home));
            return (position, orders);
        };
        position += direction.sign();
        orders.push(order);
    }
}

#[test]
fn homing_approaches_backs_off_and_approaches_slowly() {
    // The switch closes at 0 and opens at 4: hysteresis.
    let (position, orders) = home(300, |at| at <= 0);
    assert_eq!(position, 0);
    let step = |direction, speed| HomingOrder::Step { direction, speed };
    let fast_in = step(Direction::Negative, HomingSpeed::Fast);
    let back = step(Direction::Positive, HomingSpeed::Fast);
    let slow_in = step(Direction::Negative, HomingSpeed::Slow);
    let wanted = [vec![fast_in; 300], vec![back; 21], vec![slow_in; 21]].concat();
    assert_eq!(orders, wanted);
}

#[test]
fn homing_from_the_switch_ends_at_the_same_place() {
    for start in [-30, -1, 0, 1, 20, 999] {
        assert_eq!(home(start, |at| at <= 0).0, 0, "from {start}");
    }
}

#[test]
fn homing_ends_where_there_is_no_switch() {
    let run = |closed: bool| {
        let mut homing = Homing::new(HOMING);
        let error = (0..5000).find_map(|_| homing.next(closed).err()).unwrap();
        // For good, whatever the switch does then.
        for again in [closed, !closed, closed, !closed] {
            assert_eq!(homing.next(again), Err(error));
        }
        error
    };
    assert_eq!(run(false), HomingError::NeverClosed { steps: 1000 });
    assert_eq!(run(true), HomingError::NeverOpened { steps: 1000 });
}
