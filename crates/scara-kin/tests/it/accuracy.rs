//! The documented accuracy, against arithmetic of 1e-21, by a search that goes from bad cases to
//! worse ones. `ACCURACY_CASES` makes it longer, `ACCURACY_SEED` another one:
//!
//! ```sh
//! ACCURACY_CASES=100000000 cargo test --release -p scara-kin --test it accuracy:: -- --nocapture
//! ```

use core::f64::consts::PI;

use scara_kin::nalgebra::{self, Isometry2, Point2, RealField, Vector2};
use scara_kin::{Arm, Elbow, Joints, Trig};
use test_support::{Random, setting};
use twofloat::TwoFloat;

use crate::common::double;

/// The documented figures, in machine epsilons of reach and base distance: tool errors of the
/// inverse alone, of forward after inverse, and of forward alone.
const DOCUMENTED: [f64; 3] = [7.0, 8.0, 4.0];
const NAMES: [&str; 3] = ["inverse", "forward of inverse", "forward"];

/// An arm and a point within its reach.
#[derive(Debug, Clone, Copy)]
struct Case {
    upper: f64,
    fore: f64,
    /// Distance from the base: fraction of the distance from the inner to the outer rim.
    fraction: f64,
    heading: f64,
    base: [f64; 3],
    elbow: Elbow,
    turns: [f64; 2],
}

impl Case {
    fn new(random: &mut Random, is_placed: bool) -> Self {
        let upper = random.size(0.0, 4.0);
        let fore = match random.below(4) {
            0 => upper,
            1 => upper * random.size(-0.5, 0.5),
            _ => upper * random.size(-3.0, 3.0),
        };
        let fraction = match random.below(4) {
            0 => random.size(-17.0, 0.0),
            1 => 1.0 - random.size(-17.0, 0.0),
            _ => random.within(0.0, 1.0),
        };
        let span = upper + fore;
        let base = [span, span, PI].map(|size| random.within(-size, size));
        let most_turns = random.size(0.0, 7.0);
        Self {
            upper,
            fore,
            fraction,
            heading: random.within(-PI, PI),
            base: if is_placed { base } else { [0.0; 3] },
            elbow: if random.below(2) == 0 {
                Elbow::Right
            } else {
                Elbow::Left
            },
            turns: [0; 2].map(|_| random.within(-most_turns, most_turns).round()),
        }
    }

    /// A case beside this one, of the same kind.
    fn beside(self, random: &mut Random) -> Self {
        let size = random.size(-16.0, -0.5);
        let mut moved = |value: f64| value * (1.0 + size * random.within(-1.0, 1.0));
        let upper = moved(self.upper);
        let is_equal = self.upper.to_bits() == self.fore.to_bits();
        Self {
            upper,
            fore: if is_equal { upper } else { moved(self.fore) },
            fraction: moved(self.fraction).min(1.0),
            heading: moved(self.heading),
            base: self.base.map(moved),
            ..self
        }
    }

    fn arm<T: RealField + Trig>(&self) -> Arm<T> {
        let [x, y, turn] = self.base.map(nalgebra::convert::<_, T>);
        Arm::new(nalgebra::convert(self.upper), nalgebra::convert(self.fore))
            .and_then(|arm| arm.with_base(Isometry2::new(Vector2::new(x, y), turn)))
            .unwrap()
    }

    /// Tool errors of inverse, forward of inverse and forward in machine epsilons, and what
    /// the rounding of the angles may add. `None` for the base itself and where rounding has
    /// put the point beyond a rim.
    fn errors<T: RealField + Trig>(&self, is_wound: bool) -> Option<[f64; 3]> {
        let arm = self.arm::<T>();
        let (inner, outer) = (double(arm.inner_reach()), double(arm.reach()));
        let r = inner + (outer - inner) * self.fraction;
        let from_base = Vector2::new(r * self.heading.cos(), r * self.heading.sin());
        let point = arm.base() * Point2::from(from_base.map(nalgebra::convert::<_, T>));
        let exact = point.map(|coordinate| TwoFloat::from(double(coordinate)));
        let from_base = in_base(&arm, exact);
        let r = f64::from(from_base[0].hypot(from_base[1]));
        if r <= inner || r >= outer {
            return None;
        }
        let near = self.turns.map(|turns| nalgebra::convert(turns * 2.0 * PI));
        let joints = if is_wound {
            let near = Joints::new(near[0], near[1]);
            let is_within = arm.limits().contains(&near);
            arm.inverse_elbow_near(point, self.elbow, near)
                .ok()
                .filter(|_| is_within)?
        } else {
            arm.inverse_elbow(point, self.elbow).ok()?
        };
        let there = tool(&arm, joints);
        let forward = arm
            .forward(joints)
            .map(|coordinate| TwoFloat::from(double(coordinate)));
        let base = arm.base().translation.vector;
        let span = outer + double(base.x).hypot(double(base.y));
        let unit = span * double(T::default_epsilon());
        let angles =
            double(joints.shoulder).abs() * outer + double(joints.elbow).abs() * double(arm.fore());
        let rounding = if is_wound { angles / span / 2.0 } else { 0.0 };
        Some([
            distance(there, [exact.x, exact.y]) / unit - rounding,
            distance([forward.x, forward.y], [exact.x, exact.y]) / unit - rounding,
            distance([forward.x, forward.y], there) / unit,
        ])
    }
}

fn distance(a: [TwoFloat; 2], b: [TwoFloat; 2]) -> f64 {
    f64::from(a[0] - b[0]).hypot(f64::from(a[1] - b[1]))
}

fn rotation<T: RealField + Trig>(arm: &Arm<T>) -> [TwoFloat; 2] {
    let rotation = arm.base().rotation;
    [rotation.re, rotation.im].map(|part| TwoFloat::from(double(part)))
}

fn in_base<T: RealField + Trig>(arm: &Arm<T>, point: Point2<TwoFloat>) -> [TwoFloat; 2] {
    let base = arm.base().translation.vector;
    let (x, y) = (point.x - double(base.x), point.y - double(base.y));
    let [re, im] = rotation(arm);
    [re * x + im * y, re * y - im * x]
}

/// The tool of the joints.
fn tool<T: RealField + Trig>(arm: &Arm<T>, joints: Joints<T>) -> [TwoFloat; 2] {
    let (s1, c1) = TwoFloat::from(double(joints.shoulder)).sin_cos();
    let (s2, c2) = TwoFloat::from(double(joints.elbow)).sin_cos();
    let along = c2 * double(arm.fore()) + double(arm.upper());
    let across = s2 * double(arm.fore());
    let (x, y) = (c1 * along - s1 * across, s1 * along + c1 * across);
    let base = arm.base().translation.vector;
    let [re, im] = rotation(arm);
    [
        re * x - im * y + double(base.x),
        re * y + im * x + double(base.y),
    ]
}

/// Half of the cases are new, half beside the worst ones.
fn search<T: RealField + Trig>(is_placed: bool, is_wound: bool) {
    let mut random = Random::new(setting("ACCURACY_SEED", 1));
    let mut worst = [(0.0, Case::new(&mut random, is_placed)); 3];
    let mut counted = 0;
    let cases = setting("ACCURACY_CASES", 100_000);
    while counted < cases {
        let case = match random.below(2) {
            0 => Case::new(&mut random, is_placed),
            _ => worst[usize::try_from(random.below(3)).unwrap()]
                .1
                .beside(&mut random),
        };
        let Some(errors) = case.errors::<T>(is_wound) else {
            continue;
        };
        counted += 1;
        for (worst, error) in worst.iter_mut().zip(errors) {
            if error > worst.0 {
                *worst = (error, case);
            }
        }
    }
    for ((name, documented), (error, case)) in NAMES.into_iter().zip(DOCUMENTED).zip(worst) {
        println!("{name}: {error:.2} machine epsilons at {case:?}");
        assert!(error <= documented, "{name}: {error} at {case:?}");
    }
}

#[test]
fn double_precision() {
    search::<f64>(false, false);
}

#[test]
fn double_precision_on_a_base() {
    search::<f64>(true, false);
}

#[test]
fn double_precision_at_any_turn() {
    search::<f64>(false, true);
}

#[test]
fn single_precision() {
    search::<f32>(false, false);
}

#[test]
fn single_precision_on_a_base() {
    search::<f32>(true, false);
}

#[test]
fn single_precision_at_any_turn() {
    search::<f32>(false, true);
}
