//! The machines beside closed forms of where the tool is.

use core::f64::consts::{FRAC_PI_2, TAU};

use machine_kin::{
    CarriageSide, CoreXy, Elbow, FiveBar, GeometryError, HangingPlotter, LinearDelta, Machine,
    Polar, Scara, WithZ,
};
use proptest::prelude::*;

/// Of places of machines of some hundred mm.
const ROUNDING: f64 = 1e-9;

fn near<const N: usize>(a: [f64; N], b: [f64; N]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < ROUNDING)
}

/// The two places at given distances from two others.
fn circles(a: [f64; 2], r: f64, b: [f64; 2], s: f64) -> [[f64; 2]; 2] {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    let square = x * x + y * y;
    let along = (r * r - s * s + square) / (2.0 * square);
    let beside = (r * r / square - along * along).max(0.0).sqrt();
    [1.0, -1.0].map(|sign| {
        let beside = sign * beside;
        [a[0] + along * x - beside * y, a[1] + along * y + beside * x]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_five_bar_s_forearms_meet_at_the_tool(
        x in -150.0..150.0_f64, y in -200.0..250.0_f64, left: bool, right: bool,
    ) {
        let elbow = |is_left| if is_left { Elbow::Left } else { Elbow::Right };
        let machine = FiveBar::new(80.0, 100.0, 160.0).unwrap();
        let Ok(angles) = machine.inverse([x, y], [elbow(left), elbow(right)]) else { return Ok(()) };
        let motors = [-40.0, 40.0];
        let elbows = [0, 1].map(|arm| {
            let (sin, cos) = angles[arm].sin_cos();
            [motors[arm] + 100.0 * cos, 100.0 * sin]
        });
        let mut meet = circles(elbows[0], 160.0, elbows[1], 160.0).into_iter();
        prop_assert!(meet.any(|at| (at[0] - x).hypot(at[1] - y) < 1e-6));
        for ((elbow, motor), is_left) in elbows.into_iter().zip(motors).zip([left, right]) {
            let side = (x - motor) * elbow[1] - y * (elbow[0] - motor);
            prop_assert_eq!(side > 0.0, is_left);
        }
    }

    #[test]
    fn a_linear_delta_s_rods_have_their_length(x in -80.0..80.0_f64, y in -80.0..80.0_f64, z in 0.0..200.0_f64) {
        let machine = LinearDelta::new(250.0, 110.0, 0.0..=600.0).unwrap();
        let carriages = machine.inverse([x, y, z], ()).unwrap();
        for (carriage, degrees) in carriages.into_iter().zip([-150.0_f64, -30.0, 90.0]) {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let rod = [x - 110.0 * cos, y - 110.0 * sin, z - carriage];
            let length = rod.iter().map(|x| x * x).sum::<f64>().sqrt();
            prop_assert!((length - 250.0).abs() < ROUNDING && carriage > z);
        }
    }

    #[test]
    fn a_hanging_plotter_s_cords_meet_at_the_pen(x in 1.0..1199.0_f64, y in 1.0..900.0_f64) {
        let machine = HangingPlotter::new(1200.0, 0.0..=2000.0).unwrap();
        let [left, right] = machine.inverse([x, y], ()).unwrap();
        let [below, _] = circles([0.0, 0.0], left, [1200.0, 0.0], right);
        prop_assert!((below[0] - x).abs() < 1e-6 && (below[1] - y).abs() < 1e-6);
    }

    #[test]
    fn a_polar_machine_is_there_from_both_sides(x in -90.0..90.0_f64, y in -90.0..90.0_f64, is_front: bool) {
        let side = if is_front { CarriageSide::Front } else { CarriageSide::Behind };
        let [angle, radius] = Polar::new(-130.0..=130.0).inverse([x, y], side).unwrap();
        let (sin, cos) = angle.sin_cos();
        prop_assert!(near([radius * cos, radius * sin], [x, y]));
        prop_assert_eq!(radius > 0.0, is_front);
    }

    #[test]
    fn a_core_xy_s_belts_add_up(x in 0.0..300.0_f64, y in 0.0..200.0_f64, z in 0.0..50.0_f64) {
        let machine = WithZ::new(CoreXy::new(0.0..=300.0, 0.0..=200.0), 0.0..=50.0);
        let [a, b, height] = machine.inverse([x, y, z], ()).unwrap();
        prop_assert!(near([(a + b) / 2.0, (a - b) / 2.0, height], [x, y, z]));
    }

    #[test]
    fn a_scara_s_links_lead_to_the_tool(
        x in -300.0..300.0_f64, y in -300.0..300.0_f64, heading in -99.0..99.0_f64, is_left: bool,
    ) {
        let elbow = if is_left { Elbow::Left } else { Elbow::Right };
        let machine = Scara::new(160.0, 140.0, 30.0).unwrap();
        let Ok([shoulder, bend, height, wrist]) = machine.inverse([x, y, 7.0, heading], elbow) else {
            prop_assert!(!(20.1..299.9).contains(&x.hypot(y)));
            return Ok(());
        };
        let (upper, fore) = (shoulder.sin_cos(), (shoulder + bend).sin_cos());
        let tool = [160.0 * upper.1 + 140.0 * fore.1, 160.0 * upper.0 + 140.0 * fore.0];
        prop_assert!(near(tool, [x, y]) && (height - 7.0).abs() < ROUNDING);
        let turns = (shoulder + bend + wrist - heading / 30.0) / TAU;
        prop_assert!((turns - turns.round()).abs() < ROUNDING);
        prop_assert_eq!(bend < 0.0, is_left);
    }
}

#[test]
fn machines_stand_where_they_should() {
    // Tool straight above the middle, elbows out: both mirror each other.
    let machine = FiveBar::new(80.0, 100.0, 160.0).unwrap();
    let [left, right] = machine
        .inverse([0.0, 180.0], [Elbow::Left, Elbow::Right])
        .unwrap();
    assert!((left + right - 2.0 * FRAC_PI_2).abs() < ROUNDING && left > FRAC_PI_2);
    let error: GeometryError = FiveBar::new(80.0, 100.0, -1.0).unwrap_err();
    assert_eq!(error.name, "forearm");
    assert_eq!(
        error.to_string(),
        "forearm -1 is not above 0 and at most 1e50"
    );
    let apart = FiveBar::new(300.0, 70.0, 80.0).unwrap_err();
    assert_eq!(
        apart.to_string(),
        "forearm 80 is not above 80 and at most 1e50"
    );
    let far = machine.inverse([0.0, 300.0], [Elbow::Left, Elbow::Right]);
    assert_eq!(
        far.unwrap_err().reason,
        "the left arm is too short or too long"
    );
}

#[test]
fn a_linear_delta_reaches_its_middle() {
    let error = LinearDelta::new(100.0, 150.0, 0.0..=400.0).unwrap_err();
    assert_eq!(
        (error.name, error.value, error.above),
        ("rod", 100.0, 150.0)
    );
    assert_eq!(
        error.to_string(),
        "rod 100 is not above 150 and at most 1e50"
    );
    let machine = LinearDelta::new(150.5, 150.0, 0.0..=400.0).unwrap();
    assert!(machine.inverse([0.0, 0.0, 100.0], ()).is_ok());
}

/// Columns and the radius of the smallest circle round them: that through all three, or with two at
/// its ends.
const COLUMNS: [([[f64; 2]; 3], f64); 3] = [
    ([[-87.0, -50.25], [87.0, -50.25], [0.0, 100.5]], 100.5),
    ([[0.0, 0.0], [60.0, 0.0], [60.0, 80.0]], 50.0),
    ([[-70.0, 0.0], [70.0, 0.0], [1.0, 5.0]], 70.0),
];

#[test]
fn measured_columns_hold_the_platform_within_reach() {
    let with = |rod, columns| {
        let machine = LinearDelta::new(rod, 10.0, 0.0..=400.0).unwrap();
        machine.with_columns(columns)
    };
    for (columns, radius) in COLUMNS {
        assert!(with(radius + 0.1, columns).is_ok(), "{columns:?}");
        let error = with(radius - 0.1, columns).unwrap_err();
        assert!((error.above - radius).abs() < 0.05, "{error}");
        assert_eq!((error.name, error.value), ("rod", radius - 0.1));
    }
    let in_line = [[0.0, 0.0], [10.0, 20.0], [-5.0, -10.0]];
    assert_eq!(
        with(100.0, in_line).unwrap_err().to_string(),
        "the area between the columns 0 is not above 0 and at most 1e50"
    );
    for wrong in [f64::NAN, f64::INFINITY] {
        assert!(with(100.0, [[0.0, 0.0], [10.0, wrong], [20.0, 5.0]]).is_err());
    }
}
