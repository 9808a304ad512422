//! Every row of the reference cases: results of 60-digit arithmetic.

use pose_pt::nalgebra::{
    Isometry3, Matrix3, Point3, Quaternion, Rotation3, UnitQuaternion, Vector3,
};
use pose_pt::{
    Convention, Locator, LocatorAxis, Platform, PoseVector, angle_between, from_matrix, rigid_fit,
    slerp, to_matrix,
};

const POSE9: &str = include_str!("../data/pose9.csv");
const EULER: &str = include_str!("../data/euler.csv");
const SLERP: &str = include_str!("../data/slerp.csv");
const FIT: &str = include_str!("../data/fit.csv");

/// Rounding of a handful of products of sines and of the sums of three, relative to the
/// largest term: 4.5 machine epsilons.
const ROUNDING: f64 = 1e-15;

struct Row {
    names: Vec<&'static str>,
    fields: Vec<&'static str>,
}

impl Row {
    fn text(&self, name: &str) -> &'static str {
        self.fields[self.names.iter().position(|n| *n == name).unwrap()]
    }

    fn number(&self, name: &str) -> f64 {
        self.text(name).parse().unwrap()
    }

    fn numbers<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        names.map(|name| self.number(name))
    }

    /// The numbers `<stem>x`, `<stem>y`, `<stem>z`.
    fn point(&self, stem: &str) -> Point3<f64> {
        let [x, y, z] = ["x", "y", "z"].map(|end| self.number(&format!("{stem}{end}")));
        Point3::new(x, y, z)
    }

    fn points(&self, name: &str) -> Vec<Point3<f64>> {
        let all: Vec<f64> = self
            .text(name)
            .split_whitespace()
            .map(|n| n.parse().unwrap())
            .collect();
        all.chunks(3).map(Point3::from_slice).collect()
    }

    fn matrix(&self, stem: &str) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.number(&format!("{stem}{i}{j}")))
    }

    fn quaternion(&self, stem: &str) -> UnitQuaternion<f64> {
        let [w, x, y, z] = ["w", "x", "y", "z"].map(|end| self.number(&format!("{stem}{end}")));
        UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
    }

    fn vector(&self) -> PoseVector {
        let [x, y, z] = self.numbers(["x", "y", "z"]);
        let [alpha, beta, gamma] = self.numbers(["alpha", "beta", "gamma"]);
        PoseVector::new(x, y, z, alpha, beta, gamma)
    }
}

fn rows(table: &'static str) -> impl Iterator<Item = Row> {
    let names: Vec<_> = table.lines().next().unwrap().split(',').collect();
    table.lines().skip(1).map(move |line| Row {
        names: names.clone(),
        fields: line.split(',').collect(),
    })
}

/// Keeps the largest error seen, and the row.
struct Worst(&'static str, f64, &'static str);

impl Worst {
    fn of(what: &'static str) -> Self {
        Self(what, 0.0, "")
    }

    fn check(&mut self, row: &Row, error: f64, allowed: f64) {
        assert!(
            error <= allowed,
            "{} of row {}: {error:e}, allowed {allowed:e}",
            self.0,
            row.text("id")
        );
        if error / allowed > self.1 {
            (self.1, self.2) = (error / allowed, row.text("id"));
        }
    }
}

impl Drop for Worst {
    fn drop(&mut self) {
        println!(
            "{}: {:.3} of what is allowed, row {}",
            self.0, self.1, self.2
        );
    }
}

const CONVENTIONS: [(Convention, &str); 2] = [
    (Convention::ExtrinsicXyz, "p"),
    (Convention::IntrinsicXyz, "intr_p"),
];

#[test]
fn anchors_are_where_the_pose_puts_them() {
    let mut quaternion = Worst::of("position by quaternion");
    let mut matrix = Worst::of("position by matrix");
    let mut platform = Worst::of("position by platform");
    for row in rows(POSE9) {
        let vector = row.vector();
        let anchors = ["a1", "a2", "a3"].map(|stem| row.point(stem));
        let span = anchors
            .iter()
            .map(|a| a.coords.norm())
            .fold(vector.position().norm(), f64::max);
        for (convention, stem) in CONVENTIONS {
            let pose = vector.to_isometry(convention);
            let rotation = vector.to_rotation(convention);
            let wanted = [1, 2, 3].map(|number| row.point(&format!("{stem}{number}")));
            for (anchor, wanted) in anchors.iter().zip(wanted) {
                let moved = to_matrix(&pose.rotation) * anchor + vector.position();
                quaternion.check(&row, (moved - wanted).norm(), span * ROUNDING);
                let moved = rotation * anchor + vector.position();
                matrix.check(&row, (moved - wanted).norm(), span * ROUNDING);
            }
            let limits = [LocatorAxis {
                min: -1.0,
                max: 1.0,
                speed: 1.0,
                acceleration: 1.0,
                jerk: None,
            }; 3];
            let locators = anchors.map(|anchor| Locator::new(anchor, Point3::origin(), limits));
            let Ok(held) = Platform::new(locators) else {
                assert_eq!(row.text("class"), "collinear");
                continue;
            };
            assert_ne!(row.text("class"), "collinear");
            let axes = held.axes_at(&rotation, &vector.position());
            let positions = held.positions(&pose);
            for ((axes, position), wanted) in axes.iter().zip(positions).zip(wanted) {
                platform.check(&row, (axes - wanted.coords).norm(), span * ROUNDING);
                platform.check(&row, (position - wanted).norm(), span * ROUNDING);
            }
        }
    }
}

#[test]
fn matrices_and_quaternions_of_angles() {
    let mut entries = Worst::of("matrix");
    let mut by_quaternion = Worst::of("matrix by quaternion");
    let mut quaternions = Worst::of("quaternion");
    let mut back = Worst::of("quaternion of matrix");
    for row in rows(EULER) {
        let [alpha, beta, gamma] = row.numbers(["alpha", "beta", "gamma"]);
        let vector = PoseVector::new(0.0, 0.0, 0.0, alpha, beta, gamma);
        for (convention, stem) in [
            (Convention::ExtrinsicXyz, "r"),
            (Convention::IntrinsicXyz, "x"),
        ] {
            let wanted = row.matrix(stem);
            let matrix = vector.to_rotation(convention);
            entries.check(&row, (matrix.matrix() - wanted).amax(), ROUNDING);
            let quaternion = vector.to_quaternion(convention);
            let matrix = to_matrix(&quaternion);
            by_quaternion.check(&row, (matrix.matrix() - wanted).amax(), ROUNDING);
            let again = from_matrix(&wanted, 0.0).unwrap();
            back.check(&row, angle_between(&again, &quaternion), 2.0 * ROUNDING);
        }
        let quaternion = vector.to_quaternion(Convention::ExtrinsicXyz);
        let wanted = row.quaternion("q");
        let sign = quaternion.dot(&wanted).signum();
        let miss = quaternion.as_vector() * sign - wanted.as_vector();
        quaternions.check(&row, miss.norm(), ROUNDING);
        let between = angle_between(&quaternion, &vector.to_quaternion(Convention::IntrinsicXyz));
        assert!((between - row.number("angle_between")).abs() <= 4.0 * ROUNDING);
    }
}

/// The difference of two angles, whole turns aside.
fn off_turn(a: f64, b: f64) -> f64 {
    let way = a - b;
    (way - (way / core::f64::consts::TAU).round() * core::f64::consts::TAU).abs()
}

#[test]
fn angles_of_rotations() {
    let mut angles = Worst::of("angle");
    let mut cosines = Worst::of("cos beta");
    let mut rebuilt = Worst::of("rebuilt matrix");
    for row in rows(EULER) {
        let wanted = row.numbers(["alpha_c", "beta_c", "gamma_c"]);
        let cos_beta = row.number("cos_beta");
        let matrix = row.matrix("r");
        let rotation = from_matrix(&matrix, 0.0).unwrap();
        let [w, x, y, z] = row.numbers(["qw", "qx", "qy", "qz"]);
        let exact = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
        for rotation in [rotation, exact] {
            let pose = Isometry3::from_parts(Vector3::zeros().into(), rotation);
            let resolved = PoseVector::from_isometry(&pose, Convention::ExtrinsicXyz);
            let again = resolved.vector.to_rotation(Convention::ExtrinsicXyz);
            rebuilt.check(&row, (again.matrix() - matrix).amax(), 2.0 * ROUNDING);
            cosines.check(&row, (resolved.cos_beta - cos_beta).abs(), ROUNDING);
            assert_eq!(resolved.locked, row.text("class") == "lock_double");
            if resolved.locked {
                continue;
            }
            // Rounding of the rotation, divided by the lever that the angles have.
            let [alpha, beta, gamma] = wanted;
            let lever = ROUNDING / cos_beta;
            angles.check(&row, off_turn(resolved.vector.alpha, alpha), 2.0 * lever);
            angles.check(&row, off_turn(resolved.vector.beta, beta), ROUNDING);
            angles.check(&row, off_turn(resolved.vector.gamma, gamma), 2.0 * lever);
        }
    }
}

#[test]
fn slerp_of_every_row() {
    let mut worst = Worst::of("slerp");
    let mut angles = Worst::of("angle between");
    for row in rows(SLERP) {
        let (p, q) = (row.quaternion("p_"), row.quaternion("q_"));
        let (t, wanted) = (row.number("t"), row.quaternion("r_"));
        let turned = slerp(&p, &q, t);
        let sign = turned.dot(&wanted).signum();
        let miss = turned.as_vector() * sign - wanted.as_vector();
        worst.check(&row, miss.norm(), ROUNDING);
        let angle = row.number("rotation_angle");
        angles.check(&row, (angle_between(&p, &q) - angle).abs(), ROUNDING);
    }
}

#[test]
fn fits_of_every_row() {
    let mut rotations = Worst::of("rotation");
    let mut translations = Worst::of("translation");
    let mut residuals = Worst::of("rms");
    let mut gaps = Worst::of("gap");
    for row in rows(FIT) {
        let (a, b) = (row.points("A"), row.points("B"));
        let fit = rigid_fit(&a, &b).unwrap_or_else(|e| panic!("{}: {e}", row.text("id")));
        let wanted = row.matrix("r");
        let gap = row.number("eigen_gap");
        let far =
            |points: &[Point3<f64>]| points.iter().map(|p| p.coords.norm()).fold(0.0, f64::max);
        let far = far(&a).max(far(&b));
        // The softest turn meets points that are √(gap / 2) from its axis, each rounded
        // by its distance from the origin.
        let lever = far / (0.5 * gap).sqrt();
        let rotation = to_matrix(&fit.motion.rotation);
        let turn = Rotation3::from_matrix_unchecked(wanted).inverse() * rotation;
        let miss = (turn.matrix() - Matrix3::identity()).amax();
        rotations.check(&row, miss, ROUNDING * lever.max(2.0));
        let miss = fit.motion.translation.vector - row.point("t").coords;
        translations.check(&row, miss.norm(), ROUNDING * lever.max(2.0) * far);
        residuals.check(&row, (fit.rms - row.number("rms")).abs(), ROUNDING * far);
        gaps.check(
            &row,
            (fit.eigenvalue_gap - gap).abs() / gap,
            ROUNDING * lever.max(4.0),
        );
        assert!((rotation.matrix().determinant() - 1.0).abs() < 4.0 * ROUNDING);
    }
}
