//! Random machines, paths, segments, windows, feeds and holds, judged by dense sampling with
//! formulas of this file:
//! `MOTIONS=100000 cargo test --release -p path-timing --test it attack:: -- --nocapture`.

mod machines;

use core::fmt::Debug;

use machines::{attack_arm, attack_delta, attack_platform, attack_points};
use path_timing::{
    Accuracy, Axes, AxisLimits, Corner, Curve, FeedCeiling, Knot, LookAhead, Path, PlanError, Row,
    Span, Table, segments_within,
};
use test_support::{Random, setting};

/// Of what is sampled from rounded rows.
const ROUNDING: f64 = 1.0 + 1e-7;

/// What positions round off, as a part of the machine's size.
const POSITION: f64 = 1e-9;

/// Places of a segment.
const PLACES: u32 = 24;

/// 150 %.
const MAX_FEED: f64 = 1.5;

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

/// No axis is above its speed, its acceleration or, at rows and inside, its jerk, times rise, and
/// velocities jump between paths alone, by what these allow.
fn check<P: Path>(
    paths: &[P],
    limits: &<P::Axes as Axes>::Of<AxisLimits>,
    rows: &[Row<P::Axes>],
    what: &str,
) {
    for (axis, limits) in P::Axes::each(limits).iter().enumerate() {
        let (mut before, mut before_s) = (0.0, 0.0);
        for pair in rows.windows(2) {
            let [from, to] = pair else { unreachable!() };
            if let (1, Corner::Jump(most)) = (to.leg - from.leg, paths[from.leg].corner())
                && from.position == to.position
            {
                let [v0, v1] = [from, to].map(|row| row.velocity.as_slice()[axis]);
                let (jump, most) = ((v1 - v0).abs(), most.as_slice()[axis]);
                assert!(jump <= most * ROUNDING, "{what}: {jump} {from:?} {to:?}");
                (before, before_s) = (0.0, 0.0);
                continue;
            }
            assert!(
                to.duration_s > 0.0 && to.time_s > from.time_s,
                "{what}: {to:?}"
            );
            let at = |tau| {
                let positions = [from, to].map(|row| row.position.as_slice()[axis]);
                let velocities = [from, to].map(|row| row.velocity.as_slice()[axis]);
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
    /// Tables within a departure, played with feeds and holds.
    departures: u64,
    refused: u64,
    rows: usize,
    slowest: f64,
    /// The largest departure, as a part of what was allowed.
    farthest: f64,
}

/// Where rows leave their path: a bound, and the departure itself at positions of a part of the
/// path.
struct Judge<'a, P, A: Axes> {
    bound: &'a dyn Fn(&P, &Span<A>) -> f64,
    off: &'a dyn Fn(&P, [f64; 2], &A) -> f64,
    size: f64,
}

/// The paths of a machine under random limits.
fn attack<P>(
    random: &mut Random,
    paths: &[P],
    scale: f64,
    judge: &Judge<'_, P, P::Axes>,
    tried: &mut Tried,
) where
    P: Path<Error: Debug + Clone> + Clone,
{
    let speed = scale * random.size(-1.0, 1.0);
    let acceleration = speed * random.size(0.0, 2.0);
    let has_jerk = random.below(4) == 0;
    let jerk = acceleration * random.size(0.7, 2.3);
    let mut limits = P::Axes::filled(AxisLimits {
        speed,
        acceleration,
        jerk: has_jerk.then_some(jerk),
    });
    for limits in P::Axes::each_mut(&mut limits) {
        limits.speed *= random.within(0.5, 1.0);
        limits.acceleration *= random.within(0.3, 1.0);
    }
    let most = [8, 100][usize::from(random.below(2) == 0)];
    let segments = 2 + u32::try_from(random.below(most)).unwrap();
    let mut knots = vec![Knot::default(); 60_000];
    let planned = Table::plan(paths.iter().cloned(), limits, |_| segments, &mut knots);
    match planned {
        Err(PlanError::TooCoarse { .. } | PlanError::Path { .. }) => tried.refused += 1,
        planned => {
            let table = planned.unwrap();
            let rows: Vec<_> = table.rows().collect();
            check(paths, &limits, &rows, "table");
            tried.tables += 1;
            tried.rows += rows.len();
            let rows = play(random, &table);
            check(paths, &limits, &rows, "playback");
            tried.playbacks += 1;
            let duration_s = table.duration_s();
            if !has_jerk {
                let mut fine = vec![Knot::default(); paths.len() * 401 + 1];
                let fine = Table::plan(paths.iter().cloned(), limits, |_| 400, &mut fine);
                if let Ok(fine) = fine {
                    tried.slowest = tried.slowest.max(duration_s / fine.duration_s());
                }
            }
        }
    }
    let max_feed = if has_jerk { 1.0 } else { MAX_FEED };
    stream(random, paths, limits, |_| Ok(segments), max_feed, tried);
    if random.below(4) == 0 {
        depart(random, paths, limits, judge, tried);
    }
    if random.below(4) == 0 {
        let allowed = judge.size * random.size(-4.0, -1.0);
        let segments = |path: &P| segments_within(path, 2, allowed, judge.bound);
        let rows = stream(random, paths, limits, segments, max_feed, tried);
        check_departure(paths, &rows, allowed, judge, tried);
    }
}

/// Rows within a departure, at any feed, with holds.
fn depart<P>(
    random: &mut Random,
    paths: &[P],
    limits: <P::Axes as Axes>::Of<AxisLimits>,
    judge: &Judge<'_, P, P::Axes>,
    tried: &mut Tried,
) where
    P: Path<Error: Debug + Clone> + Clone,
{
    let accuracy = Accuracy {
        min_segments: 2,
        max_departure: judge.size * random.size(-4.0, -1.0),
        max_time_ratio: f64::INFINITY,
    };
    let mut knots = vec![Knot::default(); 20_000];
    let paths_of = || paths.iter().cloned();
    let table =
        Table::plan_within_at_any_feed(paths_of(), limits, accuracy, judge.bound, &mut knots);
    let Ok(table) = table else {
        tried.refused += 1;
        return;
    };
    let rows = play(random, &table);
    check(paths, &limits, &rows, "within a departure");
    check_departure(paths, &rows, accuracy.max_departure, judge, tried);
    tried.rows += rows.len();
}

/// All rows keep within a departure.
fn check_departure<P: Path>(
    paths: &[P],
    rows: &[Row<P::Axes>],
    allowed: f64,
    judge: &Judge<'_, P, P::Axes>,
    tried: &mut Tried,
) {
    for pair in rows.windows(2) {
        let [from, to] = pair else { unreachable!() };
        if from.position == to.position {
            continue;
        }
        let start = if from.leg == to.leg { from.s } else { 0.0 };
        let path = &paths[to.leg];
        let span = Span {
            s: [start, to.s],
            rows: [*from, *to],
        };
        // A window of four or five knots may rest at one after the other.
        if from.is_at_rest() && to.is_at_rest() && to.s < path.length() {
            continue;
        }
        let bound = (judge.bound)(path, &span);
        assert!(
            bound <= allowed * ROUNDING,
            "{bound}, allowed {allowed}: {span:?}"
        );
        for place in 0..=PLACES {
            let tau = f64::from(place) / f64::from(PLACES);
            let mut at = from.position;
            for (axis, at) in at.as_mut_slice().iter_mut().enumerate() {
                let [q0, q1] = [from, to].map(|row| row.position.as_slice()[axis]);
                let [m0, m1] = [from, to].map(|row| row.velocity.as_slice()[axis] * to.duration_s);
                let rest = 1.0 - tau;
                *at = q0 * (1.0 + 2.0 * tau) * rest * rest
                    + m0 * tau * rest * rest
                    + q1 * tau * tau * (3.0 - 2.0 * tau)
                    - m1 * tau * tau * rest;
            }
            let off = (judge.off)(path, [start, to.s], &at);
            tried.farthest = tried.farthest.max(off / allowed);
            let most = allowed * ROUNDING + judge.size * POSITION;
            assert!(off <= most, "{off} off, allowed {allowed}: {from:?} {to:?}");
        }
    }
    tried.departures += 1;
}

/// The distance of a point from a part of a curve.
fn distance<const D: usize>(curve: &Curve<D>, [from, to]: [f64; 2], point: [f64; D]) -> f64 {
    let at = |s: f64| {
        let place = curve.at(s).point;
        let squares = place.iter().zip(&point).map(|(a, b)| (a - b) * (a - b));
        squares.sum::<f64>().sqrt()
    };
    let step = (to - from) / 16.0;
    let places = (0..=16).map(|n| from + f64::from(n) * step);
    let nearest = places.min_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap();
    let (mut low, mut high) = ((nearest - step).max(from), (nearest + step).min(to));
    for _ in 0..40 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if at(a) < at(b) { high = b } else { low = a }
    }
    at(low)
}

/// Feeds and holds at random rows.
fn play<A: Axes>(random: &mut Random, table: &Table<'_, A>) -> Vec<Row<A>> {
    let mut ceilings = vec![FeedCeiling::default(); table.len()];
    let mut playback = table.playback(MAX_FEED, &mut ceilings).unwrap();
    let mut rows = Vec::new();
    for _ in 0..random.below(6) {
        let feed = random.within(0.0, MAX_FEED);
        playback
            .set_feed(if feed < 0.4 { 0.0 } else { feed })
            .unwrap();
        let count = usize::try_from(1 + random.below(20)).unwrap();
        rows.extend(playback.by_ref().take(count));
    }
    playback.set_feed(1.0).unwrap();
    rows.extend(playback.by_ref());
    assert!(playback.is_finished() && rows.len() == table.len());
    rows
}

/// A window of any size, feeds and holds.
fn stream<P>(
    random: &mut Random,
    paths: &[P],
    limits: <P::Axes as Axes>::Of<AxisLimits>,
    segments: impl FnMut(&P) -> Result<u32, PlanError<P::Error>>,
    max_feed: f64,
    tried: &mut Tried,
) -> Vec<Row<P::Axes>>
where
    P: Path<Error: Debug + Clone> + Clone,
{
    let mut window = vec![Knot::default(); usize::try_from(4 + random.below(100)).unwrap()];
    let motion = LookAhead::new(paths.iter().cloned(), limits, segments, &mut window);
    let mut motion = motion.unwrap().with_max_feed(max_feed).unwrap();
    let mut rows = Vec::new();
    let mut wishes = random.below(6);
    loop {
        let (feed, count) = if wishes == 0 {
            (1.0, usize::MAX)
        } else {
            let feed = random.within(0.0, max_feed);
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
    check(paths, &limits, &rows, "stream");
    assert!(motion.is_at_rest());
    tried.streams += 1;
    tried.rows += rows.len();
    rows
}

#[test]
fn nothing_is_passed() {
    let motions = setting("MOTIONS", 40);
    let seed = setting("SEED", 1);
    let mut random = Random::new(seed);
    let mut tried = Tried::default();
    for _ in 0..motions {
        match random.below(4) {
            0 => attack_points(&mut random, &mut tried),
            1 => attack_arm(&mut random, &mut tried),
            2 => attack_delta(&mut random, &mut tried),
            _ => attack_platform(&mut random, &mut tried),
        }
    }
    println!("{motions} motions from seed {seed}: {tried:?}");
    assert!(tried.slowest <= SLOWEST, "{}", tried.slowest);
    assert!(tried.tables > motions / 4 && tried.streams > motions / 4);
}
