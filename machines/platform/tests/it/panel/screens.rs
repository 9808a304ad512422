//! What the display shows.

use super::*;

#[test]
fn the_three_screens() {
    let mut desk = Desk::new(1);
    let single = [
        "SINGLE",
        ">LOCATOR  1 IDLE",
        " LOCATOR  2 IDLE",
        " LOCATOR  3 IDLE",
        " ADJUST     IDLE",
        "",
        "",
        "",
    ];
    assert_eq!(desk.screen(0), single);
    desk.press(0, ENTER);
    let locator = [
        " LOCATOR  1 IDLE",
        "",
        ">X  +1234.567 mm",
        " Y     -0.001 mm",
        " Z     +0.000 mm",
        "",
        " SPEED      x100",
        "",
    ];
    assert_eq!(desk.screen(0), locator);
    desk.press(0, DOWN);
    desk.press(0, DOWN);
    // 2147483.648 does not fit.
    assert_eq!(desk.screen(0)[2], ">X ********** mm");
    desk.press(0, UP);
    assert_eq!(desk.screen(0)[0], " LOCATOR  2 IDLE");
    desk.press(0, ENTER);
    assert_eq!(desk.screen(0)[2], ">LOCATOR  2 IDLE");
    desk.press(0, DOWN);
    desk.press(0, DOWN);
    desk.press(0, ENTER);
    desk.on(0, Input::Wheel(-1005));
    desk.rotary_switches(0, 2, 6);
    desk.on(0, Input::Wheel(12));
    let adjust = [
        "ADJUST x10  IDLE",
        " dX  -100.000 mm",
        " dY    +0.000 mm",
        " dZ    +0.000 mm",
        " da +0.000000deg",
        " db +0.000000deg",
        ">dg +0.012000deg",
        "",
    ];
    assert_eq!(desk.screen(0), adjust);
    assert!(desk.screen(0).iter().all(|line| line.len() <= 16));
}

#[test]
fn the_list_scrolls() {
    let settings = PanelSettings::new(WheelQuantiser::new(100, 10).unwrap());
    let mut panel = Panel::new(PendantId(0), settings).unwrap();
    let mut arbiter = Arbiter::<10>::new();
    for _ in 0..12 {
        panel.handle(Input::Key(Key::new(DOWN).ok()), &mut arbiter);
        panel.handle(Input::Key(None), &mut arbiter);
    }
    let screen = panel.screen(&arbiter, &[[0; 3]; 10]);
    let lines: Vec<_> = screen.lines().collect();
    assert_eq!(lines[1], " LOCATOR  6 IDLE");
    assert_eq!(lines[6], ">ADJUST     IDLE");
}
