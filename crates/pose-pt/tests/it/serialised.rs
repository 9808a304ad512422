//! Platform files: what is written is read back, what is wrong is refused.

use pose_pt::nalgebra::Point3;
use pose_pt::{Axis, AxisLimits, Convention, Locator, Platform, PoseVector};

fn panel() -> Platform<3> {
    let limits = AxisLimits::new(-300.0, 300.0, 20.0, 100.0).with_jerk(1000.0);
    let anchors = [[0.0, 0.0, 0.0], [3000.0, 0.0, 0.0], [0.0, 2000.0, 10.0]];
    Platform::new(anchors.map(|anchor| Locator::new(anchor.into(), Point3::origin(), [limits; 3])))
        .unwrap()
}

#[test]
fn a_platform_is_read_back() {
    let text = serde_json::to_string(&panel()).unwrap();
    assert_eq!(serde_json::from_str::<Platform<3>>(&text).unwrap(), panel());
}

#[test]
fn axes_parallel_to_the_world_may_be_left_out() {
    let text = serde_json::to_string(&panel()).unwrap();
    let identity = r#""axes":[1.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0],"#;
    assert_eq!(text.matches(identity).count(), 3);
    let short = text.replace(identity, "").replace(r#","jerk":1000.0"#, "");
    let read: Platform<3> = serde_json::from_str(&short).unwrap();
    assert_eq!(read.locators()[0].limits[0].jerk, None);
    assert_eq!(read.locators()[2].axes, panel().locators()[2].axes);
}

#[test]
fn poses_and_names_are_read_back() {
    let vector = PoseVector::new(1.0, 2.0, 3.0, 0.1, 0.2, 0.3);
    let text = serde_json::to_string(&vector).unwrap();
    assert_eq!(
        text,
        r#"{"x":1.0,"y":2.0,"z":3.0,"alpha":0.1,"beta":0.2,"gamma":0.3}"#
    );
    assert_eq!(serde_json::from_str::<PoseVector>(&text).unwrap(), vector);
    let name = serde_json::to_string(&Convention::IntrinsicXyz).unwrap();
    assert_eq!(name, r#""intrinsic_xyz""#);
    assert_eq!(serde_json::to_string(&Axis::Z).unwrap(), r#""z""#);
}

#[test]
fn wrong_platforms_are_refused_with_their_reason() {
    let text = serde_json::to_string(&panel()).unwrap();
    for (wrong, reason) in [
        (
            text.replacen(r#""speed":20.0"#, r#""speed":0.0"#, 1),
            "locator 0, axis X: speed is 0",
        ),
        (
            text.replace("[3000.0,0.0,0.0]", "[0.0,1000.0,5.0]"),
            "anchors are on a line",
        ),
        (
            text.replacen(r#""min""#, r#""least""#, 1),
            "unknown field `least`",
        ),
        (
            serde_json::to_string(&panel().locators()[..2]).unwrap(),
            "expected 3 locators",
        ),
    ] {
        let error = serde_json::from_str::<Platform<3>>(&wrong).unwrap_err();
        assert!(error.to_string().contains(reason), "{error}");
    }
}
