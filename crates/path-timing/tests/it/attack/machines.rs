//! The four kinds of machines, each with random paths.

use delta_kin::{Delta, DeltaPath, Dimensions};
use path_timing::{Corner, Curve, ToolLimits};
use pose_pt::nalgebra::{Isometry3, Vector3};
use pose_pt::{BodyPath, Interpolation, Locator, Platform};
use scara_kin::{Arm, ArmPath, Elbow, Joints};
use test_support::Random;

use super::{Judge, Tried, attack, distance};
use crate::support::polyline::smoothed;

/// A random curve near a place, at a feed or none.
fn curve<const D: usize>(random: &mut Random, centre: [f64; D], size: f64) -> Option<Curve<D>> {
    let near = |random: &mut Random| centre.map(|x| x + random.within(-size, size));
    let curve = match random.below(3) {
        0 => Curve::line(near(random), near(random)),
        1 => {
            let (start, about, way) = (near(random), near(random), near(random));
            Curve::arc(start, about, way, random.within(0.05, 5.0))
        }
        _ => Curve::bezier([near(random), near(random), near(random), near(random)]),
    };
    let tool = ToolLimits {
        feed: size * random.size(-1.0, 1.0),
        acceleration: (random.below(2) == 0).then_some(size * random.size(0.0, 2.0)),
    };
    let curve = curve.ok()?;
    Some(if random.below(2) == 0 {
        curve.with_tool(tool)
    } else {
        curve
    })
}

/// A gantry along points: smoothed, or with velocities that jump.
pub(super) fn attack_points(random: &mut Random, tried: &mut Tried) {
    let (count, step) = (3 + random.below(20), random.size(-1.0, 2.5));
    let mut at = [0.0; 3];
    let points: Vec<_> = (0..count)
        .map(|_| {
            at = at.map(|x| x + random.within(-step, step));
            at
        })
        .collect();
    let curves = if random.below(3) == 0 {
        let speed = random.size(-2.0, 2.0);
        let line = |ends: &[[f64; 3]]| Curve::line(ends[0], ends[1]).unwrap();
        let lines = points.windows(2).map(line);
        let lines = lines.map(|line| line.with_corner(Corner::Jump([speed; 3])));
        lines.collect()
    } else {
        smoothed(&points, random.size(-5.0, 0.0))
    };
    let judge = Judge {
        bound: &Curve::departure,
        off: &|curve: &Curve<3>, part, at: &[f64; 3]| distance(curve, part, *at),
        size: 100.0,
    };
    attack(random, &curves, 100.0, &judge, tried);
}

pub(super) fn attack_arm(random: &mut Random, tried: &mut Tried) {
    let arm = Arm::new(132.0, random.within(80.0, 160.0)).unwrap();
    let at = [random.within(-150.0, 150.0), random.within(60.0, 180.0)];
    let elbow = [Elbow::Left, Elbow::Right][usize::from(random.below(2) == 0)];
    let size = random.size(0.5, 2.0);
    let path = curve(random, at, size).and_then(|it| arm.path(it, elbow).ok());
    let judge = Judge {
        bound: &ArmPath::departure,
        off: &|path: &ArmPath, part, at: &[f64; 2]| {
            let tool = arm.forward(Joints::new(at[0], at[1]));
            distance(path.curve(), part, tool.into())
        },
        size: 250.0,
    };
    match path {
        Some(path) => attack(random, &[path], 3.0, &judge, tried),
        None => tried.refused += 1,
    }
}

pub(super) fn attack_delta(random: &mut Random, tried: &mut Tried) {
    let delta = Delta::new(Dimensions {
        base: 42.0,
        platform: 18.0,
        upper: 120.0,
        lower: 243.0,
    })
    .unwrap();
    let [x, y] = [(); 2].map(|()| random.within(-60.0, 60.0));
    let size = random.size(0.5, 1.8);
    let path = curve(random, [x, y, -250.0], size).and_then(|it| delta.path(it).ok());
    let judge = Judge {
        bound: &DeltaPath::departure,
        off: &|path: &DeltaPath, part, at: &[f64; 3]| {
            let tool = delta.forward(Vector3::from(*at)).unwrap();
            distance(path.curve(), part, tool.into())
        },
        size: 250.0,
    };
    match path {
        Some(path) => attack(random, &[path], 3.0, &judge, tried),
        None => tried.refused += 1,
    }
}

/// A body on three locators, through some poses; the distances between the locators are to stay.
pub(super) fn attack_platform(random: &mut Random, tried: &mut Tried) {
    let limits = [pose_pt::LocatorAxis {
        min: -9e3,
        max: 9e3,
        speed: 20.0,
        acceleration: 100.0,
        jerk: None,
    }; 3];
    let anchors = [
        [-1500.0, -1000.0, 0.0],
        [1500.0, -1000.0, 50.0],
        [0.0, 1000.0, -20.0],
    ];
    let held = anchors.map(|anchor| {
        let anchor = anchor.map(|x| x + random.within(-300.0, 300.0));
        Locator::new(anchor.into(), anchor.into(), limits)
    });
    let platform: Platform<3> = Platform::new(held).unwrap();
    let (way, turn) = (random.size(-1.0, 2.5), random.size(-4.0, -0.3));
    let three = |random: &mut Random, most: f64| {
        Vector3::from([(); 3].map(|()| random.within(-most, most)))
    };
    let poses: Vec<_> = (0..2 + random.below(3))
        .map(|_| Isometry3::new(three(random, way), three(random, turn)))
        .collect();
    let path = pose_pt::PosePath::new(&poses, Interpolation::Straight).unwrap();
    let blend = pose_pt::Blend {
        distance: way * random.within(0.0, 0.1),
        rotation_rad: turn * random.within(0.0, 0.1),
    };
    let blends = vec![blend; poses.len() - 2];
    let path = path.with_blends(&blends).unwrap();
    let judge = Judge {
        bound: &BodyPath::departure,
        off: &|_: &BodyPath<'_, 3>, _, at: &[[f64; 3]; 3]| {
            let places = platform.locator_positions(&at.map(Vector3::from));
            let pairs = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| {
                let anchors = platform.anchors();
                ((places[a] - places[b]).norm() - (anchors[a] - anchors[b]).norm()).abs()
            });
            pairs.into_iter().fold(0.0, f64::max)
        },
        size: 3000.0,
    };
    let paths: Vec<_> = platform.paths(&path).collect();
    attack(random, &paths, 50.0, &judge, tried);
}
