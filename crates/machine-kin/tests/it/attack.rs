//! Random paths on random machines, half of them through limits, singular poses and ends of
//! branches: what dense sampling finds wrong is refused, what it finds right is not.
//!
//! `MACHINE_KIN_PATHS` says how many.

use core::f64::consts::TAU;

use machine_kin::path_timing::{Curve, Knot, Path, Table, ToolLimits};
use machine_kin::{
    CarriageSide, CoreXy, Elbow, FiveBar, HangingPlotter, LinearDelta, Machine, Polar, Scara, WithZ,
};
use test_support::{Random, setting};

use crate::common::{apart, cubics, distance, forward, limits, slopes, within};

/// Places of a curve that are looked at.
const SAMPLES: u32 = 400;

/// How far all places round a sample have to be good for a path to be good, as a part of its size:
/// ten times what paths stay away from edges by.
const MARGIN: f64 = 1e-5;

/// By how much a position may be beyond a range: what is allowed to paths that touch it.
const RANGE_SLACK: f64 = 1e-8;

/// Of places of machines of some hundred mm.
const ROUNDING: f64 = 1e-9;

/// Of a thousand good paths, those that may be refused.
const NEEDLESS: u32 = 10;

#[derive(Debug, Default)]
struct Tally {
    good: u32,
    bad: u32,
    /// Neither, by the margin.
    close: u32,
    needless: u32,
    unplanned: u32,
    segments: usize,
}

/// What sampling says of a curve.
#[derive(Debug, PartialEq)]
enum Finding {
    Good,
    Close,
    Bad(&'static str),
}

/// Whether the tool may be at a place, and the sign of the determinant there.
fn sign_at<M: Machine<N>, const N: usize>(
    machine: &M,
    tool: [f64; N],
    branch: M::Branch,
) -> Option<bool> {
    let (_, slopes) = slopes(machine, tool, branch)?;
    let areas = machine.area();
    let is_inside = tool
        .iter()
        .zip(areas)
        .all(|(x, area)| *x >= area.start() - RANGE_SLACK && *x <= area.end() + RANGE_SLACK);
    let volume = sign_of(slopes.map(|slope| slope));
    is_inside.then_some(volume)
}

fn sign_of<const N: usize>(matrix: scara_kin::nalgebra::SMatrix<f64, N, N>) -> bool {
    // By elimination: nalgebra's determinant knows no N.
    let (mut m, mut is_positive) = (matrix, true);
    for column in 0..N {
        let pivot = (column..N)
            .max_by(|a, b| m[(*a, column)].abs().total_cmp(&m[(*b, column)].abs()))
            .unwrap();
        if pivot != column {
            m.swap_rows(pivot, column);
            is_positive = !is_positive;
        }
        is_positive ^= m[(column, column)] < 0.0;
        for row in column + 1..N {
            let factor = m[(row, column)] / m[(column, column)];
            for k in column..N {
                m[(row, k)] -= factor * m[(column, k)];
            }
        }
    }
    is_positive
}

fn sampled<M: Machine<N>, const N: usize>(
    machine: &M,
    curve: &Curve<N>,
    branch: M::Branch,
) -> Finding {
    let axes = machine.axes();
    let reach = |point: [f64; N]| point.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let margin = MARGIN * (curve.length() + reach(curve.start()).max(reach(curve.end())));
    let (mut last, mut first_sign, mut is_close) = (None::<[f64; N]>, None, false);
    for number in 0..=SAMPLES {
        let point = curve
            .at(curve.length() * f64::from(number) / f64::from(SAMPLES))
            .point;
        let Some(sign) = sign_at(machine, point, branch) else {
            return Finding::Bad("out of reach");
        };
        if *first_sign.get_or_insert(sign) != sign {
            return Finding::Bad("singular");
        }
        for coordinate in 0..N {
            for by in [-margin, margin] {
                let mut near = point;
                near[coordinate] += by;
                is_close |= sign_at(machine, near, branch) != Some(sign);
            }
        }
        let positions = machine.inverse(point, branch).unwrap();
        // Angles go on from the turn nearest to the middle of their range.
        let positions: [f64; N] = core::array::from_fn(|axis| {
            let range = axes[axis].range();
            let before = last.map_or_else(
                || {
                    let middle = range.start() * 0.5 + range.end() * 0.5;
                    if middle.is_finite() { middle } else { 0.0 }
                },
                |last| last[axis],
            );
            before + apart(&axes[axis], positions[axis] - before)
        });
        for (axis, position) in axes.iter().zip(positions) {
            let range = axis.range();
            if position < range.start() - RANGE_SLACK || position > range.end() + RANGE_SLACK {
                return Finding::Bad("beyond a range");
            }
            is_close |= position < range.start() + margin || position > range.end() - margin;
        }
        last = Some(positions);
    }
    if is_close {
        Finding::Close
    } else {
        Finding::Good
    }
}

impl Tally {
    fn try_path<M: Machine<N>, const N: usize>(
        &mut self,
        random: &mut Random,
        machine: &M,
        curve: Curve<N>,
        branch: M::Branch,
    ) {
        let curve = curve.with_tool(ToolLimits {
            feed: random.within(20.0, 400.0),
            acceleration: Some(random.within(500.0, 10_000.0)),
        });
        let finding = sampled(machine, &curve, branch);
        let path = machine.path(curve, branch);
        match finding {
            Finding::Good => self.good += 1,
            Finding::Close => self.close += 1,
            Finding::Bad(reason) => {
                self.bad += 1;
                assert!(path.is_err(), "{reason}: {curve:?} {branch:?}");
            }
        }
        let path = match path {
            Ok(path) => path,
            Err(error) => {
                if finding == Finding::Good {
                    self.needless += 1;
                    println!(
                        "refused needlessly: {error}; clearance {}",
                        machine.clearance(curve.at(0.0).point, branch)
                    );
                }
                return;
            }
        };
        let tolerance = random.size(-3.0, -1.0);
        let limits = limits(machine);
        let mut knots = vec![Knot::default(); 4000];
        let departure = machine_kin::MachinePath::departure;
        let table = Table::plan_within(
            [&path],
            limits,
            within(tolerance),
            |path, span| departure(path, span),
            &mut knots,
        );
        let table = match table {
            Ok(table) => table,
            Err(error) => {
                if finding == Finding::Good {
                    self.unplanned += 1;
                    println!("not planned: {error}");
                }
                return;
            }
        };
        let axes = machine.axes();
        for span in table.spans() {
            self.segments += 1;
            path.check(&span).unwrap();
            let bound = path.departure(&span);
            assert!(bound <= tolerance);
            // From each place to the next: near singular poses Newton needs a near start.
            let mut near = curve.at(span.s[0]).point;
            for number in 0..=40 {
                let share = f64::from(number) / 40.0;
                let at = span.s[0] + (span.s[1] - span.s[0]) * share;
                let positions = cubics(&span).map(|cubic| cubic.position(share));
                for (axis, position) in axes.iter().zip(positions) {
                    let range = axis.range();
                    assert!(
                        position >= range.start() - RANGE_SLACK
                            && position <= range.end() + RANGE_SLACK
                    );
                }
                let tool = forward(machine, &axes, positions, branch, near);
                let tool = tool.expect("the tool is on its branch");
                near = tool;
                let off = distance(&curve, tool, at);
                assert!(
                    off <= bound + ROUNDING,
                    "{off} {bound} {machine:?} {curve:?} {span:?}"
                );
                for (x, area) in tool.iter().zip(machine.area()) {
                    assert!(*x >= area.start() - RANGE_SLACK && *x <= area.end() + RANGE_SLACK);
                }
            }
        }
    }
}

/// A line, an arc or a Bézier curve between points of a box.
fn any_curve<const N: usize>(random: &mut Random, low: [f64; N], high: [f64; N]) -> Curve<N> {
    loop {
        let mut point = || core::array::from_fn(|k| random.within(low[k], high[k]));
        let [a, b, c, d]: [[f64; N]; 4] = [point(), point(), point(), point()];
        let way = core::array::from_fn(|k| c[k] - d[k]);
        let curve = match random.below(3) {
            0 => Curve::line(a, b),
            1 => Curve::arc(a, b, way, random.within(0.1, 5.0)),
            // Parts of the box, so that not all leave it.
            _ => Curve::bezier([a, b, c, d]),
        };
        if let Ok(curve) = curve {
            return curve;
        }
    }
}

fn elbow(random: &mut Random) -> Elbow {
    if random.below(2) == 0 {
        Elbow::Left
    } else {
        Elbow::Right
    }
}

/// A range of angles, or none.
fn angles(random: &mut Random) -> [f64; 2] {
    if random.below(2) == 0 {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let middle = random.within(-2.0, 2.0);
    let half = random.within(0.5, TAU / 2.0);
    [middle - half, middle + half]
}

fn any_path(random: &mut Random, tally: &mut Tally) {
    match random.below(6) {
        0 => {
            let (rod, radius) = (random.within(200.0, 300.0), random.within(60.0, 140.0));
            let top = random.within(300.0, 500.0);
            let machine = LinearDelta::new(rod, radius, 0.0..=top).unwrap();
            let by = random.within(40.0, 160.0);
            let curve = any_curve(random, [-by, -by, 0.0], [by, by, 200.0]);
            tally.try_path(random, &machine, curve, ());
        }
        1 => {
            let sizes = [
                random.within(10.0, 120.0),
                random.within(80.0, 140.0),
                random.within(100.0, 200.0),
            ];
            let [base, upper, fore] = sizes;
            let ranges = [angles(random), angles(random)];
            let machine = FiveBar::new(base, upper, fore)
                .unwrap()
                .with_ranges(ranges[0], ranges[1]);
            let branch = if random.below(2) == 0 {
                [Elbow::Left, Elbow::Right]
            } else {
                [elbow(random), elbow(random)]
            };
            let curve = any_curve(random, [-100.0, 40.0], [100.0, 260.0]);
            tally.try_path(random, &machine, curve, branch);
        }
        2 => {
            let machine = Polar::new(random.within(-150.0, 40.0)..=random.within(50.0, 200.0));
            let side = if random.below(2) == 0 {
                CarriageSide::Front
            } else {
                CarriageSide::Behind
            };
            let curve = any_curve(random, [-120.0; 2], [120.0; 2]);
            tally.try_path(random, &machine, curve, side);
        }
        3 => {
            let area = || 0.0..=250.0;
            let machine = WithZ::new(CoreXy::new(area(), area()), 0.0..=50.0);
            let curve = any_curve(random, [-5.0; 3], [255.0, 255.0, 52.0]);
            tally.try_path(random, &machine, curve, ());
        }
        4 => {
            let machine = HangingPlotter::new(
                1200.0,
                random.within(100.0, 500.0)..=random.within(1000.0, 1500.0),
            )
            .unwrap();
            let curve = any_curve(random, [-20.0, -10.0], [1220.0, 900.0]);
            tally.try_path(random, &machine, curve, ());
        }
        _ => {
            let (upper, fore) = (random.within(120.0, 200.0), random.within(120.0, 200.0));
            let ranges = [
                angles(random),
                angles(random),
                [-10.0, 60.0],
                angles(random),
            ];
            let machine = Scara::new(upper, fore, 30.0)
                .unwrap()
                .with_ranges(ranges.map(|[min, max]| min..=max));
            let by = random.within(150.0, 320.0);
            let curve = any_curve(random, [-by, -by, -11.0, -60.0], [by, by, 61.0, 60.0]);
            let branch = elbow(random);
            tally.try_path(random, &machine, curve, branch);
        }
    }
}

#[test]
fn what_sampling_finds_wrong_is_refused_and_nothing_else() {
    let paths = setting("MACHINE_KIN_PATHS", 100);
    let mut random = Random::new(setting("MACHINE_KIN_SEED", 1));
    let mut tally = Tally::default();
    for _ in 0..paths {
        any_path(&mut random, &mut tally);
    }
    println!("{tally:?}");
    let needless = tally.needless + tally.unplanned;
    assert!(needless * 1000 <= tally.good * NEEDLESS);
    assert!(tally.good * 5 > tally.bad && tally.bad * 5 > tally.good);
}
