//! A pendant in somebody's hands: jogs, a pose change, and what is refused.

use handwheel::{Key, LedState, Position};
use platform::{Desk, Hand, Machine, PLATFORM};

/// What the display rounds off.
const DISPLAYED_MM: f64 = 0.0005;

fn desk() -> Desk {
    let mut desk = Desk::new(&Machine::parse(PLATFORM).unwrap()).unwrap();
    desk.wait_ms(3000).unwrap();
    assert!(line(&desk, 0).starts_with("SINGLE"));
    desk
}

fn line(desk: &Desk, line: usize) -> String {
    desk.seen().unwrap().display[line].clone()
}

fn act(desk: &mut Desk, hand: Hand) {
    desk.act(hand).unwrap();
    desk.wait_ms(300).unwrap();
}

fn press(desk: &mut Desk, key: u8) {
    act(desk, Hand::Key(Some(Key::new(key).unwrap())));
    act(desk, Hand::Key(None));
}

/// Turns the wheel by counts in each of some samples.
fn turn(desk: &mut Desk, counts: i32, samples: u32) {
    for _ in 0..samples {
        desk.act(Hand::Wheel(counts)).unwrap();
        desk.wait_ms(200).unwrap();
    }
}

/// Holds down both enabling switches.
fn hold_switches(desk: &mut Desk) {
    let (left, right) = (true, true);
    act(desk, Hand::Enable { left, right });
}

/// Opens the pose change, sets dX to 1 mm and starts it.
fn move_x(desk: &mut Desk) {
    for _ in 0..3 {
        press(desk, 2);
    }
    press(desk, 3);
    assert!(line(desk, 0).starts_with("ADJUST"));
    turn(desk, 10, 1);
    desk.wait_ms(1000).unwrap();
    assert!(line(desk, 1).contains("+1.000"), "{}", line(desk, 1));
    press(desk, 4);
}

#[test]
fn a_pose_change_moves_the_body() {
    let mut desk = desk();
    let before = desk.seen().unwrap().platform;
    act(&mut desk, Hand::Multiplier(Position::new(3).unwrap()));
    hold_switches(&mut desk);
    move_x(&mut desk);
    desk.wait_ms(10_000).unwrap();
    assert!(line(&desk, 7).starts_with("DONE"));
    let after = desk.seen().unwrap();
    assert!(!after.is_moving && after.led == LedState::On);
    let outlines = before.outline_mm.iter().zip(&after.platform.outline_mm);
    for (before, after) in outlines {
        assert!((after[0] - before[0] - 1.0).abs() < DISPLAYED_MM);
    }
}

/// A platform file with a pose between, and another first pose.
fn edited(from: &str) -> Machine {
    let via = "[[path.via]]\npose = [35.0, 0.0, 1200.0, 0.0, 0.0, 2.5]\n\
               distance_mm = 0.0\nrotation_deg = 0.0\n[wheel]";
    let text = PLATFORM.replace("[wheel]", via);
    let first = "from = [0.0, 0.0, 1200.0, 0.0, 0.0, 0.0]";
    assert!(text.contains(first));
    Machine::parse(&text.replace(first, from)).unwrap()
}

/// The poses between the first and the last of the platform file are not passed.
#[test]
fn a_pose_change_goes_straight() {
    let machine = edited("from = [0.0, 0.0, 1200.0, 0.0, 0.0, 0.0]");
    let mut desk = Desk::new(&machine).unwrap();
    desk.wait_ms(3000).unwrap();
    let corner = |desk: &Desk| desk.seen().unwrap().platform.outline_mm[0];
    let before = corner(&desk);
    act(&mut desk, Hand::Multiplier(Position::new(3).unwrap()));
    hold_switches(&mut desk);
    move_x(&mut desk);
    for _ in 0..100 {
        desk.wait_ms(100).unwrap();
        let moved = corner(&desk)[0] - before[0];
        assert!((-DISPLAYED_MM..1.0 + DISPLAYED_MM).contains(&moved));
    }
    assert!(line(&desk, 7).starts_with("DONE"));
}

#[test]
fn a_body_out_of_reach_is_refused() {
    let machine = edited("from = [900.0, 0.0, 1200.0, 0.0, 0.0, 0.0]");
    let error = format!("{:#}", Desk::new(&machine).unwrap_err());
    assert!(error.starts_with("from: out of reach: "), "{error}");
}

/// Without the switches nothing moves; with them to the end of the stroke and no farther; and then
/// the locators do not hold the body any more.
#[test]
fn a_jog_ends_at_the_end_of_the_stroke() {
    let mut desk = desk();
    act(&mut desk, Hand::Multiplier(Position::new(3).unwrap()));
    press(&mut desk, 3);
    turn(&mut desk, 100, 5);
    desk.wait_ms(1000).unwrap();
    assert!(line(&desk, 2).contains("+0.000"));
    hold_switches(&mut desk);
    turn(&mut desk, 100, 150);
    desk.wait_ms(2000).unwrap();
    assert!(line(&desk, 2).contains("+250.000"), "{}", line(&desk, 2));
    assert!(!desk.seen().unwrap().is_moving);
    press(&mut desk, 3);
    move_x(&mut desk);
    desk.wait_ms(2000).unwrap();
    assert!(
        line(&desk, 7).starts_with("NOT READY"),
        "{}",
        line(&desk, 7)
    );
}
