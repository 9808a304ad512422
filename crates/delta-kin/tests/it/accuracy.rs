//! What is claimed of rounding, as a search for the worst case. `DELTA_KIN_CASES` says how many
//! machines are tried, 2000 unless set; `--nocapture` shows what was found.

use astro_float_num::{BigFloat, Consts, RoundingMode};
use delta_kin::nalgebra::{self, Point3, RealField, Vector3};
use delta_kin::{ArmGeometry, AssemblyMode, Delta, Dimensions, ElbowSide, ForwardError, Trig};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use crate::common::reach::reach_margins;
use crate::common::uneven::{modes, uneven_arms};

/// By how much `inverse` misses the lower arms' lengths, in machine epsilons of the span.
const INVERSE: f64 = 4.0;
/// The same of `forward`, and of spheres that only just touch: 8 are taken as touching.
const FORWARD: f64 = 4.0;
const TOUCHING: f64 = 12.0;
/// By how much `forward` of `inverse` misses the point, in machine epsilons of the span over
/// `parallel_distance`, where that is not below so many roots of the machine epsilon.
const ROUND_TRIP: f64 = 4.0;
const SINGULAR: f64 = 64.0;

/// Bits of the arithmetic that checks: 75 more than `f64` has.
const BITS: usize = 128;
const NEAREST: RoundingMode = RoundingMode::ToEven;

/// A number of 128 bits.
#[derive(Clone)]
struct Wide(BigFloat);

impl From<f64> for Wide {
    fn from(value: f64) -> Self {
        Self(BigFloat::from_f64(value, BITS))
    }
}

impl Wide {
    fn plus(&self, other: &Self) -> Self {
        Self(self.0.add(&other.0, BITS, NEAREST))
    }

    fn minus(&self, other: &Self) -> Self {
        Self(self.0.sub(&other.0, BITS, NEAREST))
    }

    fn times(&self, other: &Self) -> Self {
        Self(self.0.mul(&other.0, BITS, NEAREST))
    }

    fn sin_cos(&self, consts: &mut Consts) -> [Self; 2] {
        [
            Self(self.0.sin(BITS, NEAREST, consts)),
            Self(self.0.cos(BITS, NEAREST, consts)),
        ]
    }

    fn value(&self) -> f64 {
        self.0.to_string().parse().unwrap()
    }
}

/// By how much a rod is longer than its lower arm.
fn miss(arm: &ArmGeometry, angle: f64, point: Point3<f64>, consts: &mut Consts) -> f64 {
    let [base, platform, upper, lower, zero, azimuth] = [
        arm.base,
        arm.platform,
        arm.upper,
        arm.lower,
        arm.zero,
        arm.azimuth,
    ]
    .map(Wide::from);
    let [x, y, z] = [point.x, point.y, point.z].map(Wide::from);
    let [sin, cos] = Wide::from(angle).plus(&zero).sin_cos(consts);
    let [sin_azimuth, cos_azimuth] = azimuth.sin_cos(consts);
    let out = base.minus(&platform).plus(&upper.times(&sin));
    let rod = [
        x.minus(&out.times(&cos_azimuth)),
        y.minus(&out.times(&sin_azimuth)),
        z.plus(&upper.times(&cos)),
    ];
    let [a, b, c] = rod.map(|part| part.times(&part));
    let length = Wide(a.plus(&b).plus(&c).0.sqrt(BITS, NEAREST));
    length.minus(&lower).value()
}

/// The worst that was found of one claim.
#[derive(Default)]
struct Worst {
    value: f64,
    tried: u32,
    found: String,
}

impl Worst {
    fn take(&mut self, value: f64, found: impl FnOnce() -> String) {
        self.tried += 1;
        if value > self.value {
            (self.value, self.found) = (value, found());
        }
    }

    fn is_within(&self, name: &str, claim: f64) {
        println!(
            "{name}: {:.2} in {} tries, {claim} claimed: {}",
            self.value, self.tried, self.found
        );
        assert!(self.tried > 50, "{name}: {} tries", self.tried);
        assert!(self.value <= claim, "{name}");
    }
}

/// A machine, and what it is asked.
#[derive(Debug, Clone, Copy)]
struct Case {
    arms: [ArmGeometry; 3],
    angles: [f64; 3],
    assembly_mode: AssemblyMode,
    working_mode: [ElbowSide; 3],
    direction: [f64; 3],
    /// How far along the direction, in what there is up to the edge of the reach.
    share: f64,
}

fn cases() -> impl Strategy<Value = Case> {
    let share = prop_oneof![
        Just(0.0),
        0.0..1.0f64,
        (-9.0..-1.0f64).prop_map(|e| 1.0 - 10f64.powf(e)),
    ];
    (
        uneven_arms(),
        prop::array::uniform3(-3.1..3.1f64),
        modes(),
        prop::array::uniform3(-1.0..1.0f64),
        share,
    )
        .prop_map(
            |(arms, angles, (assembly_mode, working_mode), direction, share)| Case {
                arms,
                angles,
                assembly_mode,
                working_mode,
                direction,
                share,
            },
        )
}

#[derive(Default)]
struct Search {
    inverse: Worst,
    forward: Worst,
    touching: Worst,
    round_trip: Worst,
}

impl Search {
    /// In the arithmetic of `T`, whose numbers are all numbers of `f64`.
    fn run<T: RealField + Trig>(&mut self, case: &Case, consts: &mut Consts) {
        let arms = case.arms.map(|arm| ArmGeometry {
            azimuth: narrow(arm.azimuth),
            base: narrow(arm.base),
            platform: narrow(arm.platform),
            upper: narrow(arm.upper),
            lower: narrow(arm.lower),
            zero: narrow(arm.zero),
        });
        let Ok(delta) = Delta::from_arms(arms) else {
            return;
        };
        let delta = delta.with_assembly_mode(case.assembly_mode);
        let exact = arms.map(|arm| ArmGeometry {
            azimuth: wide(arm.azimuth),
            base: wide(arm.base),
            platform: wide(arm.platform),
            upper: wide(arm.upper),
            lower: wide(arm.lower),
            zero: wide(arm.zero),
        });
        let unit = wide(delta.span()) * wide(T::default_epsilon());
        let mut misses = |angles: Vector3<T>, point: Point3<T>| {
            let mut worst = 0f64;
            for (arm, angle) in exact.iter().zip(&angles) {
                worst = worst.max(miss(arm, wide(*angle), point.map(wide), consts).abs());
            }
            worst / unit
        };
        let angles = Vector3::from(case.angles.map(narrow::<T>));
        let Ok(pose) = delta.pose_of(angles) else {
            return;
        };
        let singular = SINGULAR * wide(T::default_epsilon()).sqrt();
        if wide(pose.parallel_distance()) > singular {
            let missed = misses(angles, pose.point());
            self.forward.take(missed, || format!("{case:?}"));
        }
        if let Some(touching) = last_that_touch(&delta, angles, case) {
            let missed = misses(touching, delta.forward(touching).unwrap());
            self.touching.take(missed, || format!("{case:?}"));
        }

        let Some(point) = towards_the_edge(&exact, pose.point().map(wide), case) else {
            return;
        };
        let point = point.map(narrow::<T>);
        if reach_margins(&exact, point.map(wide)).min() < 0.0 {
            return;
        }
        let delta = delta.with_working_mode(case.working_mode);
        let Ok(pose) = delta.pose_at(point) else {
            return;
        };
        let missed = misses(pose.angles(), point);
        self.inverse.take(missed, || format!("{case:?}"));
        let sine = wide(pose.parallel_distance());
        if sine > singular {
            let made = delta.forward(pose.angles()).unwrap();
            let off = (made - point).map(wide).norm();
            self.round_trip
                .take(off * sine / unit, || format!("{case:?}"));
        }
    }

    fn is_within_claims(&self) {
        self.inverse.is_within("inverse", INVERSE);
        self.forward.is_within("forward", FORWARD);
        self.round_trip.is_within("forward of inverse", ROUND_TRIP);
        self.touching.is_within("touching", TOUCHING);
    }
}

/// The last angles on a way to where the rods do not meet.
fn last_that_touch<T: RealField + Trig>(
    delta: &Delta<T>,
    from: Vector3<T>,
    case: &Case,
) -> Option<Vector3<T>> {
    let to = Vector3::from(case.direction.map(|part| narrow(part * 3.0)));
    let at = |share: f64| from + (to - from) * narrow::<T>(share);
    let (mut inside, mut outside) = (0.0, 1.0);
    if !matches!(delta.forward(to), Err(ForwardError::Apart { .. })) {
        return None;
    }
    for _ in 0..60 {
        let middle = f64::midpoint(inside, outside);
        match delta.forward(at(middle)) {
            Ok(_) => inside = middle,
            Err(_) => outside = middle,
        }
    }
    Some(at(inside))
}

fn narrow<T: RealField>(value: f64) -> T {
    nalgebra::convert(value)
}

fn wide<T: RealField>(value: T) -> f64 {
    nalgebra::try_convert(value).unwrap()
}

fn towards_the_edge(
    arms: &[ArmGeometry; 3],
    from: Point3<f64>,
    case: &Case,
) -> Option<Point3<f64>> {
    let direction = Vector3::from(case.direction).try_normalize(1e-3)?;
    let span = arms
        .map(|arm| arm.base + arm.platform + arm.upper + arm.lower)
        .into_iter()
        .fold(0.0, f64::max);
    let (mut inside, mut outside) = (0.0, 3.0 * span);
    for _ in 0..60 {
        let middle = f64::midpoint(inside, outside);
        if reach_margins(arms, from + direction * middle).min() > 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    Some(from + direction * (inside * case.share))
}

fn search<T: RealField + Trig>() {
    let machines = std::env::var("DELTA_KIN_CASES").map_or(2000, |text| text.parse().unwrap());
    let mut runner = TestRunner::deterministic();
    let mut consts = Consts::new().unwrap();
    let mut search = Search::default();
    for _ in 0..machines {
        let case = cases().new_tree(&mut runner).unwrap().current();
        search.run::<T>(&case, &mut consts);
    }
    search.is_within_claims();
}

#[test]
fn double_precision_is_as_exact_as_claimed() {
    search::<f64>();
}

#[test]
fn single_precision_is_as_exact_as_claimed() {
    search::<f32>();
}

/// The two machines on which earlier forms of the formulas lost a digit: rods much shorter than
/// the upper arms, and rods of very different lengths.
#[test]
fn short_and_unequal_rods_keep_their_digits() {
    let mut consts = Consts::new().unwrap();
    let short = Delta::new(Dimensions {
        base: 23.06,
        platform: 29.57,
        upper: 94.54,
        lower: 7.80,
    })
    .unwrap()
    .with_assembly_mode(AssemblyMode::Upper);
    let point = Point3::new(0.402, -3.630, -90.38);
    let angles = short.inverse(point).unwrap();
    let unit = f64::EPSILON * short.span();
    for (arm, angle) in short.arms().iter().zip(&angles) {
        let off = miss(arm, *angle, point, &mut consts);
        assert!(off.abs() <= INVERSE * unit, "{off:e}");
    }
    let mut arms = *Delta::new(Dimensions {
        base: 30.0,
        platform: 25.0,
        upper: 20.0,
        lower: 154.6,
    })
    .unwrap()
    .arms();
    arms[0].upper = 130.0;
    arms[1].lower = 30.9;
    arms[2].lower = 11.4;
    let (mut seen, unequal) = (0, Delta::from_arms(arms).unwrap());
    let unit = f64::EPSILON * unequal.span();
    for k in 0..4000u32 {
        let at = |step: f64| (f64::from(k) * step).fract() * 6.2 - 3.1;
        let angles = Vector3::new(at(0.618_034), at(0.754_878), at(0.569_84));
        let Ok(point) = unequal.forward(angles) else {
            continue;
        };
        seen += 1;
        for (arm, angle) in arms.iter().zip(&angles) {
            let off = miss(arm, *angle, point, &mut consts);
            assert!(off.abs() <= FORWARD * unit, "{off:e}");
        }
    }
    assert!(seen > 50, "{seen}");
}
