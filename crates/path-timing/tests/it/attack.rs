//! Random machines, paths, segments, windows, feeds and holds, judged by dense sampling with formulas
//! of this file: `MOTIONS=100000 cargo test --release -p path-timing --test it attack:: -- --nocapture`.

use core::fmt::Debug;

use delta_kin::Delta;
use path_timing::{
    AxisLimits, Curve, FeedCeiling, Knot, LookAhead, Path, PlanError, Row, Table, ToolLimits,
};
use scara_kin::{Arm, Elbow};
use test_support::{Random, setting};

use crate::support::polyline::smoothed;

/// Of what is sampled from rounded rows.
const ROUNDING: f64 = 1.0 + 1e-7;

/// Places of a segment.
const PLACES: u32 = 24;

/// The most that a plan takes over one with 400 segments.
const SLOWEST: f64 = 3.0;

/// Position, speed and acceleration of Hermite's cubic by its four basis functions.
fn hermite([q0, q1]: [f64; 2], [v0, v1]: [f64; 2], duration_s: f64, tau: f64) -> [f64; 2] {
    let (m0, m1) = (v0 * duration_s, v1 * duration_s);
    let first = 6.0 * tau * (tau - 1.0) * (q0 - q1)
        + (1.0 - tau) * (1.0 - 3.0 * tau) * m0
        + tau * (3.0 * tau - 2.0) * m1;
    let second =
        6.0 * (2.0 * tau - 1.0) * (q0 - q1) + (6.0 * tau - 4.0) * m0 + (6.0 * tau - 2.0) * m1;
    [first / duration_s, second / (duration_s * duration_s)]
}

/// No axis is above its speed, its acceleration or, at rows and inside, its jerk, and times rise.
fn check<const N: usize>(limits: &[AxisLimits; N], rows: &[Row<[f64; N]>], what: &str) {
    for (axis, limits) in limits.iter().enumerate() {
        let (mut before, mut before_s) = (0.0, 0.0);
        for pair in rows.windows(2) {
            let [from, to] = pair else { unreachable!() };
            assert!(
                to.duration_s > 0.0 && to.time_s > from.time_s,
                "{what}: {to:?}"
            );
            let at = |tau| {
                let positions = [from.position[axis], to.position[axis]];
                let velocities = [from.velocity[axis], to.velocity[axis]];
                hermite(positions, velocities, to.duration_s, tau)
            };
            for place in 0..=PLACES {
                let [speed, acceleration] = at(f64::from(place) / f64::from(PLACES));
                let speeds = speed.abs() / limits.speed;
                let accelerations = acceleration.abs() / limits.acceleration;
                assert!(
                    speeds <= ROUNDING && accelerations <= ROUNDING,
                    "{what}: axis {axis} at {} s: {speeds} {accelerations}",
                    from.time_s
                );
            }
            let Some(jerk) = limits.jerk else { continue };
            let ([_, begin], [_, end]) = (at(0.0), at(1.0));
            if from.is_at_rest() {
                (before, before_s) = (0.0, 0.0);
            }
            let step = (begin - before).abs() / ((before_s + to.duration_s) * 0.5);
            let inside = (end - begin).abs() / to.duration_s;
            assert!(
                step.max(inside) <= jerk * ROUNDING,
                "{what}: axis {axis} at {} s: jerk {step} {inside} of {jerk}",
                from.time_s
            );
            (before, before_s) = (end, to.duration_s);
        }
    }
}

/// What was tried, and what was refused as too coarse or out of reach.
#[derive(Debug, Default)]
struct Tried {
    tables: u64,
    playbacks: u64,
    streams: u64,
    refused: u64,
    rows: usize,
    slowest: f64,
}

/// The paths of a machine under random limits.
fn attack<const N: usize, P>(random: &mut Random, paths: &[P], scale: f64, tried: &mut Tried)
where
    P: Path<Axes = [f64; N], Error: Debug + Clone> + Clone,
{
    let speed = scale * random.size(-1.0, 1.0);
    let acceleration = speed * random.size(0.0, 2.0);
    let has_jerk = random.below(4) == 0;
    let jerk = acceleration * random.size(0.7, 2.3);
    let limits = core::array::from_fn::<_, N, _>(|_| AxisLimits {
        speed: speed * random.within(0.5, 1.0),
        acceleration: acceleration * random.within(0.3, 1.0),
        jerk: has_jerk.then_some(jerk),
    });
    let most = [8, 100][usize::from(random.below(2) == 0)];
    let segments = 2 + u32::try_from(random.below(most)).unwrap();
    let mut knots = vec![Knot::default(); 60_000];
    let planned = Table::plan(paths.iter().cloned(), limits, |_| segments, &mut knots);
    match planned {
        Err(PlanError::TooCoarse { .. } | PlanError::Path { .. }) => tried.refused += 1,
        planned => {
            let table = planned.unwrap();
            let rows: Vec<_> = table.rows().collect();
            check(&limits, &rows, "table");
            tried.tables += 1;
            tried.rows += rows.len();
            play(random, &table, &limits, tried);
            let duration_s = table.duration_s();
            let mut fine = vec![Knot::default(); paths.len() * 401 + 1];
            let fine = Table::plan(paths.iter().cloned(), limits, |_| 400, &mut fine);
            if let (false, Ok(fine)) = (has_jerk, fine) {
                tried.slowest = tried.slowest.max(duration_s / fine.duration_s());
            }
        }
    }
    if !has_jerk {
        stream(random, paths, limits, segments, tried);
    }
}

/// Feeds and holds at random rows.
fn play<const N: usize>(
    random: &mut Random,
    table: &Table<'_, [f64; N]>,
    limits: &[AxisLimits; N],
    tried: &mut Tried,
) {
    let mut ceilings = vec![FeedCeiling::default(); table.len()];
    let mut playback = table.playback(1.5, &mut ceilings).unwrap();
    let mut rows = Vec::new();
    for _ in 0..random.below(6) {
        let feed = random.within(0.0, 1.5);
        playback
            .set_feed(if feed < 0.4 { 0.0 } else { feed })
            .unwrap();
        let count = usize::try_from(1 + random.below(20)).unwrap();
        rows.extend(playback.by_ref().take(count));
    }
    playback.set_feed(1.0).unwrap();
    rows.extend(playback.by_ref());
    assert!(playback.is_finished() && rows.len() == table.len());
    check(limits, &rows, "playback");
    tried.playbacks += 1;
}

/// A window of any size, feeds and holds.
fn stream<const N: usize, P>(
    random: &mut Random,
    paths: &[P],
    limits: [AxisLimits; N],
    segments: u32,
    tried: &mut Tried,
) where
    P: Path<Axes = [f64; N], Error: Debug + Clone> + Clone,
{
    let mut window = vec![Knot::default(); usize::try_from(4 + random.below(100)).unwrap()];
    let motion = LookAhead::new(paths.iter().cloned(), limits, |_| Ok(segments), &mut window);
    let mut motion = motion.unwrap().with_max_feed(1.5).unwrap();
    let mut rows = Vec::new();
    let mut wishes = random.below(6);
    loop {
        let (feed, count) = if wishes == 0 {
            (1.0, usize::MAX)
        } else {
            let feed = random.within(0.0, 1.5);
            let feed = if feed < 0.4 { 0.0 } else { feed };
            (feed, usize::try_from(1 + random.below(20)).unwrap())
        };
        motion.set_feed(feed).unwrap();
        for row in motion.by_ref().take(count) {
            match row {
                Err(PlanError::TooCoarse { .. } | PlanError::Path { .. }) => tried.refused += 1,
                row => rows.push(row.unwrap()),
            }
        }
        let Some(left) = wishes.checked_sub(1) else {
            break;
        };
        wishes = left;
    }
    check(&limits, &rows, "stream");
    assert!(motion.is_at_rest());
    tried.streams += 1;
    tried.rows += rows.len();
}

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

#[test]
fn nothing_is_passed() {
    let motions = setting("MOTIONS", 40);
    let seed = setting("SEED", 1);
    let mut random = Random::new(seed);
    let mut tried = Tried::default();
    for _ in 0..motions {
        match random.below(3) {
            0 => {
                let count = 3 + random.below(20);
                let step = random.size(-1.0, 1.5);
                let mut at = [0.0; 3];
                let points: Vec<_> = (0..count)
                    .map(|_| {
                        at = at.map(|x| x + random.within(-step, step));
                        at
                    })
                    .collect();
                let curves = smoothed(&points, random.size(-3.0, 0.0));
                attack(&mut random, &curves, 100.0, &mut tried);
            }
            1 => {
                let arm = Arm::new(132.0, random.within(80.0, 160.0)).unwrap();
                let at = [random.within(-150.0, 150.0), random.within(60.0, 180.0)];
                let elbow = if random.below(2) == 0 {
                    Elbow::Left
                } else {
                    Elbow::Right
                };
                let size = random.size(0.5, 2.0);
                let path = curve(&mut random, at, size).and_then(|it| arm.path(it, elbow).ok());
                match path {
                    Some(path) => attack(&mut random, &[path], 3.0, &mut tried),
                    None => tried.refused += 1,
                }
            }
            _ => {
                let delta = Delta::new(42.0, 18.0, 120.0, 243.0).unwrap();
                let at = [
                    random.within(-60.0, 60.0),
                    random.within(-60.0, 60.0),
                    -250.0,
                ];
                let size = random.size(0.5, 1.8);
                let path = curve(&mut random, at, size).and_then(|it| delta.path(it).ok());
                match path {
                    Some(path) => attack(&mut random, &[path], 3.0, &mut tried),
                    None => tried.refused += 1,
                }
            }
        }
    }
    println!("{motions} motions from seed {seed}: {tried:?}");
    assert!(tried.slowest <= SLOWEST, "{}", tried.slowest);
    assert!(tried.tables > motions / 4 && tried.streams > motions / 4);
}
