//! Platform files: what is written is read back, what is wrong is refused.

use pose_pt::nalgebra::Point3;
use pose_pt::{Axis, Convention, Locator, LocatorAxis, Platform, PoseVector};
use test_support::{not_read, stored};

fn panel() -> Platform<3> {
    let limits = LocatorAxis {
        min: -300.0,
        max: 300.0,
        speed: 20.0,
        acceleration: 100.0,
        jerk: Some(1000.0),
    };
    let anchors = [[0.0, 0.0, 0.0], [3000.0, 0.0, 0.0], [0.0, 2000.0, 10.0]];
    Platform::new(anchors.map(|anchor| Locator::new(anchor.into(), Point3::origin(), [limits; 3])))
        .unwrap()
}

#[test]
fn a_platform_is_read_back() {
    let text = stored(&panel());
    // Axes parallel to the world may be left out.
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
    let text = r#"{"x":1.0,"y":2.0,"z":3.0,"alpha":0.1,"beta":0.2,"gamma":0.3}"#;
    assert_eq!(stored(&vector), text);
    assert_eq!(stored(&Convention::IntrinsicXyz), r#""intrinsic_xyz""#);
    assert_eq!(stored(&Axis::Z), r#""z""#);
}

#[test]
fn wrong_platforms_are_refused_with_their_reason() {
    let text = stored(&panel());
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
        let error = not_read::<Platform<3>>(&wrong);
        assert!(error.contains(reason), "{error}");
    }
}
