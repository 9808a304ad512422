//! Poses between the first and the last: passed without a stop as near as the platform file says.

use platform::{Alignment, Machine, PLATFORM, run};
use serde_json::Value;

/// A pose aside of the straight path, with its tolerances in mm and degrees.
fn report(distance_mm: f64, rotation_deg: f64) -> Value {
    let via = format!(
        "[[path.via]]\npose = [35.0, 0.0, 1200.0, 0.0, 0.0, 2.5]\n\
         distance_mm = {distance_mm:?}\nrotation_deg = {rotation_deg:?}\n[wheel]"
    );
    let machine = Machine::parse(&PLATFORM.replace("[wheel]", &via)).unwrap();
    let run = run(&machine, &Alignment::default(), &mut |_, byte| Ok(byte)).unwrap();
    assert!(run.report().is_within_bounds());
    serde_json::to_value(run.report()).unwrap()
}

#[test]
fn a_pose_between_is_passed_within_its_tolerance() {
    // Of the fit of the pose, in mm and degrees.
    const ROUNDING: f64 = 1e-6;
    let number = |report: &Value, at: &str| report.pointer(at).unwrap().as_f64().unwrap();
    let [passed, stopped] = [[2.0, 0.1], [0.0, 0.0]].map(|[mm, deg]| report(mm, deg));
    for (report, [mm, deg]) in [(&passed, [2.0, 0.1]), (&stopped, [0.0, 0.0])] {
        assert!(number(report, "/via/0/distance_mm") <= mm + ROUNDING);
        assert!(number(report, "/via/0/rotation_deg") <= deg + ROUNDING);
    }
    assert!(number(&passed, "/via/0/speed_ratio") > 0.05);
    assert!(number(&stopped, "/via/0/speed_ratio") < ROUNDING);
    assert!(number(&passed, "/duration_s") < number(&stopped, "/duration_s"));
}

#[test]
fn refusals_name_the_pose() {
    let parse = |via: &str| {
        let text = PLATFORM.replace("[wheel]", &format!("[[path.via]]\n{via}\n[wheel]"));
        Machine::parse(&text)
    };
    let far = "pose = [900.0, 0.0, 1200.0, 0.0, 0.0, 0.0]\ndistance_mm = 1.0\nrotation_deg = 1.0";
    let refused = run(
        &parse(far).unwrap(),
        &Alignment::default(),
        &mut |_, byte| Ok(byte),
    );
    let error = format!("{:#}", refused.unwrap_err());
    assert!(error.starts_with("via 1: out of reach"), "{error}");
    let negative = far.replace("900", "9").replace("= 1.0", "= -1.0");
    let refused = run(
        &parse(&negative).unwrap(),
        &Alignment::default(),
        &mut |_, byte| Ok(byte),
    );
    let error = format!("{:#}", refused.unwrap_err());
    assert!(error.starts_with("via 1: "), "{error}");
    assert!(error.contains("the blend at pose 1"), "{error}");
    let error = format!("{:#}", parse("pose = [1.0]").unwrap_err());
    assert!(error.contains("6 are needed"), "{error}");
}
