//! A pendant jogs the first of three locators while both enabling switches are pressed.

use handwheel::{
    Action, Arbiter, Input, Key, Panel, Position, Settings, Status, UnitId, WheelQuantiser,
};

fn main() -> Result<(), Box<dyn core::error::Error>> {
    let wheel = WheelQuantiser::new(100, 10)?; // 100 counts in 200 ms are full speed, 10 bins
    let mut platform = Arbiter::<3>::new(); // three locators, shared by all panels
    let mut panel = Panel::new(UnitId(1), Settings::new(wheel))?;

    let (w1, w2) = (Position::new(3)?, Position::new(2)?); // multiplier x100, direction Y
    let (key, both, one) = (None, (true, true), (true, false));
    let enable = |(left, right)| Input::Enable { left, right };
    for input in [
        Input::Status(Status::Hbls { key, w1, w2 }),
        enable((false, false)),
        Input::Key(Some(Key::new(3)?)), // enter: opens locator 1
        enable(both),
    ] {
        assert_eq!(panel.handle(input, &mut platform), None);
    }
    let jog = panel.handle(Input::Wheel(-57), &mut platform); // the bin around 55
    let Some(Action::Jog { speed_um_s, .. }) = jog else {
        return Err("no motion".into());
    };
    assert_eq!(speed_um_s, -5_500);
    let stop = panel.handle(enable(one), &mut platform);
    assert!(matches!(stop, Some(Action::Stop(_))));
    Ok(())
}
