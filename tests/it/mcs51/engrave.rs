//! `engrave.c`: the edges of a pattern, and where the trains of two axes end.

use pose2pulse::pattern_codec::c_header::Dialect;
use pose2pulse::pattern_codec::engraving::{
    Axis, AxisCodes, ByteOrder, Fast, Format, JointPulses, PatternHeader, PerAxis, Record, Slow,
};
use pose2pulse::stepper_sync::{AxisTrain, CounterWidth, Rounding, Trains};

use super::simulator::{Port, Write, simulate};

/// Half period of [Engraver 2000], in machine cycles.
const T: u64 = 4096;

/// Most cycles from an edge's place to the edge: what starts the timers, the longest handler of the
/// other timer, then the way to the port in its own.
const HANDLER: u64 = 100;

/// As many cycles may one latency be longer than another where no handler is waited for: an
/// instruction of two ends first.
pub(super) const JITTER: u64 = 1;

/// Axes that turn at once: their index at the port, and their signed pulses.
type Move = Vec<(usize, i32)>;

/// Edges of one axis: cycles since the start of the move.
pub(super) type Edges = Vec<u64>;

fn slow(disc: i32, elbow: i32, shoulder: i32) -> Record {
    Record::Slow(
        Slow::new(JointPulses {
            elbow,
            shoulder,
            disc,
        })
        .unwrap(),
    )
}

fn fast(axis: Axis, pulses: i32) -> Record {
    Record::Fast(Fast::new(axis, pulses).unwrap())
}

/// What `engrave.c` does for a record: disc before the arms, nothing where nothing turns.
fn moves(record: Record) -> Vec<Move> {
    let mut moves = match record {
        Record::Fast(fast) => {
            let axis = Axis::ALL.iter().position(|&axis| axis == fast.axis());
            vec![vec![(axis.unwrap(), fast.pulses())]]
        }
        Record::Slow(slow) => {
            let pulses = slow.pulses();
            let arms = vec![(0, pulses.elbow), (1, pulses.shoulder)];
            vec![vec![(2, pulses.disc)], arms]
        }
    };
    for axes in &mut moves {
        axes.retain(|&(_, pulses)| pulses != 0);
    }
    moves.retain(|axes| !axes.is_empty());
    moves
}

/// One move at the port.
pub(super) struct Played {
    /// P1.4 to P1.7 when it begins.
    directions: u8,
    /// P1.0 to P1.3.
    pub(super) edges: [Edges; 4],
}

/// The moves of a trace: each begins where P0.0 rises, with all step pins low.
pub(super) fn played(trace: &[Write]) -> Vec<Played> {
    let mut moves: Vec<Played> = Vec::new();
    let (mut port, mut start) = (0, None);
    for write in trace {
        match (write.port, write.value) {
            (Port::P0, 1) => {
                start = Some(write.cycle);
                moves.push(Played {
                    directions: port >> 4,
                    edges: Default::default(),
                });
            }
            (Port::P0, _) => start = None,
            (Port::P1, value) => {
                let changed = core::mem::replace(&mut port, value) ^ value;
                match (start, moves.last_mut()) {
                    (Some(start), Some(played)) => {
                        assert_eq!(changed.count_ones(), 1, "{write:?}");
                        let axis = changed.trailing_zeros() as usize;
                        played.edges[axis].push(write.cycle - start);
                    }
                    _ => assert_eq!(changed & 15, 0, "a step outside of a move: {write:?}"),
                }
            }
            _ => {}
        }
    }
    assert_eq!(port & 15, 0, "a step pin stays high");
    moves
}

fn engrave(records: &[Record], format: Format, defines: &[&str]) -> Option<Vec<Played>> {
    let mut text = String::new();
    let header = PatternHeader {
        dialect: Dialect::Sdcc,
        ..PatternHeader::new(format)
    };
    header.write(records.iter().copied(), &mut text).unwrap();
    let trace = simulate("engrave.c", ("pattern.h", &text), defines)?;
    Some(played(&trace))
}

/// One slow record of both arms; the edges of elbow and shoulder.
fn arms(pulses: [i32; 2], defines: &[&str]) -> Option<[Edges; 2]> {
    let [elbow, shoulder] = pulses;
    let mut moves = engrave(&[slow(0, elbow, shoulder)], Format::default(), defines)?;
    assert_eq!(moves.len(), 1);
    let [edges1, edges2, ..] = moves.remove(0).edges;
    Some([edges1, edges2])
}

/// By how many cycles the edges of one axis are behind their places: none is early, none more than
/// `HANDLER` late.
pub(super) fn lags(measured: &[u64], places: &[u64]) -> Vec<u64> {
    assert_eq!(measured.len(), places.len());
    let lags = measured.iter().zip(places).map(|(&edge, &place)| {
        let lag = edge.checked_sub(place);
        lag.unwrap_or_else(|| panic!("edge at {edge}, its place is {place}"))
    });
    let lags: Vec<u64> = lags.collect();
    assert!(bounds(&lags).1 <= HANDLER, "{lags:?}");
    lags
}

pub(super) fn bounds(numbers: &[u64]) -> (u64, u64) {
    let ends = (numbers.iter().min(), numbers.iter().max());
    (*ends.0.unwrap(), *ends.1.unwrap())
}

/// The places of all edges of both axes of a move, by [`Trains`].
fn places(axes: &Move, half_period: u64) -> Vec<Edges> {
    let mut pulses = [0; 2];
    for (place, &(_, signed)) in pulses.iter_mut().zip(axes) {
        *place = signed;
    }
    let trains = Trains::new(pulses, half_period).unwrap();
    let places_of = |train: AxisTrain| {
        train.scan(0, |place, interval| {
            *place += interval;
            Some(*place)
        })
    };
    let axes = trains.axes().into_iter().take(axes.len());
    axes.map(|train| places_of(train).collect()).collect()
}

/// Whether no handler of another axis runs near a place: none at its edges, nor half way between
/// them, where an interval of two periods is cut.
fn is_calm(place: u64, other: &Edges) -> bool {
    let ends = core::iter::once(&0).chain(other);
    let mut busy = ends
        .zip(other)
        .flat_map(|(&from, &to)| [from.midpoint(to), to]);
    busy.all(|busy| busy.abs_diff(place) > 2 * HANDLER)
}

/// Plays records with the driver as it should be, and compares edge by edge with [`Trains`]. Edges
/// of two axes that are more than `HANDLER` apart then have their order, too.
fn assert_plays(records: &[Record], format: Format, half_period: u64) {
    let define = format!("HALF_PERIOD={half_period}");
    let Some(measured) = engrave(records, format, &[&define]) else {
        return;
    };
    let expected: Vec<Move> = records.iter().copied().flat_map(moves).collect();
    assert_eq!(measured.len(), expected.len());
    let (mut all, mut calm) = (Vec::new(), Vec::new());
    for (axes, played) in expected.iter().zip(&measured) {
        let places = places(axes, half_period);
        for (index, &(axis, pulses)) in axes.iter().enumerate() {
            let negative = played.directions >> axis & 1 == 1;
            assert_eq!(negative, pulses < 0, "{axes:?}");
            let lags = lags(&played.edges[axis], &places[index]);
            let calm_lags = places[index].iter().zip(&lags).filter(|(place, _)| {
                let mut others = (0..axes.len()).filter(|&other| other != index);
                others.all(|other| is_calm(**place, &places[other]))
            });
            calm.extend(calm_lags.map(|(_, lag)| *lag));
            all.extend(lags);
        }
        let moving = |axis| axes.iter().any(|&(moving, _)| moving == axis);
        assert!((0..4).all(|axis| moving(axis) || played.edges[axis].is_empty()));
    }
    let (least, most) = bounds(&all);
    let (least_calm, most_calm) = bounds(&calm);
    println!(
        "engrave.c, compensated, distributed: {} moves, {} edges, {least} to {most} cycles behind \
         their places; {} edges far from the other axis', {least_calm} to {most_calm}",
        expected.len(),
        all.len(),
        calm.len(),
    );
    assert!(most_calm - least_calm <= JITTER);
}

#[test]
fn every_edge_of_a_pattern_is_where_the_trains_have_it() {
    let records = [
        fast(Axis::Vertical, -300),
        fast(Axis::Elbow, 40),
        fast(Axis::Disc, 3),
        slow(2, 30, -1),
        slow(-3, 17, 1),
        slow(0, -1, 16),
        slow(30, 30, 29),
        slow(0, 7, 13),
        slow(0, -13, 0),
        slow(5, 0, 0),
        slow(-1, 0, 11),
        slow(0, 8, 8),
        fast(Axis::Shoulder, -25),
        fast(Axis::Vertical, 300),
    ];
    assert_plays(&records, Format::default(), T);
}

#[test]
fn other_codes_byte_order_and_half_period() {
    let codes = AxisCodes::new(PerAxis {
        elbow: 3,
        shoulder: 0,
        disc: 1,
        vertical: 2,
    });
    let format = Format::default()
        .with_axis_codes(codes.unwrap())
        .with_byte_order(ByteOrder::LittleEndian);
    let mut records = vec![
        fast(Axis::Elbow, -259),
        fast(Axis::Shoulder, 2),
        fast(Axis::Disc, -2),
        fast(Axis::Vertical, 258),
    ];
    records.extend((1..=30).map(|n| slow(0, n, 31 - n)));
    assert_plays(&records, format, 997);
}

#[test]
fn a_fast_train_keeps_its_mean_interval_to_the_cycle() {
    let records = [fast(Axis::Elbow, 400)];
    // Cycles from the first to the last edge, beyond 799 intervals.
    let excess = |defines: &[&str]| {
        let moves = engrave(&records, Format::default(), defines)?;
        let edges = &moves[0].edges[0];
        assert_eq!(edges.len(), 800);
        Some((edges[799] - edges[0]).cast_signed() - 799 * T.cast_signed())
    };
    let Some(kept) = excess(&[]) else {
        return;
    };
    assert!(kept.unsigned_abs() <= JITTER, "{kept}");
    // The plain reload: each interval is longer by the latency.
    let written = excess(&["RESTART=RESTART_WRITE"]).unwrap();
    let latency = written as f64 / 799.0;
    println!(
        "engrave.c, 799 intervals of 4096: {kept} cycles too long compensated, {written} with the \
         plain reload, {latency:.2} each"
    );
    assert!((7.0..30.0).contains(&latency), "{latency}");
}

/// Cycles from the place of one edge to the next under one reload of 16 bits for all.
fn single_reloads(pulses: [i32; 2]) -> [u64; 2] {
    let single = Trains::new(pulses, T)
        .unwrap()
        .single_reload(Rounding::Down);
    single.map(|reload| reload.kept_by(CounterWidth::Bits16).interval_ticks())
}

fn multiples(interval: u64, edges: u64) -> Edges {
    (1..=edges).map(|k| k * interval).collect()
}

#[test]
fn thirty_to_one_ends_at_47_percent_in_16_bits_and_together_with_two_periods() {
    let Some([fast, slow]) = arms([30, 1], &["SINGLE_RELOAD"]) else {
        return;
    };
    // 122,880 - 65,536.
    let [lead, kept] = single_reloads([30, 1]);
    assert_eq!((lead, kept), (4096, 57_344));
    lags(&fast, &multiples(lead, 60));
    lags(&slow, &multiples(kept, 2));
    let percent = 100.0 * slow[1] as f64 / fast[59] as f64;
    println!("engrave.c, 30:1: the slow arm ends at {percent:.1} % in 16 bits");
    assert!((percent - 46.7).abs() < 0.05);

    let [fast, slow] = arms([30, 1], &[]).unwrap();
    println!(
        "engrave.c, 30:1: both arms end at {} and {}",
        fast[59], slow[1]
    );
    assert!(fast[59].abs_diff(slow[1]) <= HANDLER);
}

#[test]
fn sixteen_to_one_loads_0_for_65536() {
    let Some([fast, slow]) = arms([1, 16], &["SINGLE_RELOAD"]) else {
        return;
    };
    assert_eq!(single_reloads([1, 16]), [65_536, 4096]);
    lags(&fast, &multiples(65_536, 2));
    lags(&slow, &multiples(4096, 32));
}

#[test]
fn latency_parts_the_ends_of_the_paper_s_program_and_not_of_ours() {
    let defines = ["SINGLE_RELOAD", "RESTART=RESTART_WRITE"];
    let Some([fast, slow]) = arms([30, 20], &defines) else {
        return;
    };
    assert_eq!(single_reloads([30, 20]), [4096, 6144]);
    // What each overflow costs, from the axis that never waits for the other.
    let latency = (fast[59] - fast[0] - 59 * 4096) as f64 / 59.0;
    let skew = fast[59] - slow[39];
    // 2 latency (n1 - n2), and at most one wait for the other's handler at the ends.
    let expected = 2.0 * latency * 10.0;
    println!("engrave.c, 30:20, the paper's: latency {latency:.2}, ends {skew} cycles apart");
    assert!(
        (skew as f64 - expected).abs() < HANDLER as f64,
        "{skew}, {expected}"
    );
    assert!(skew > HANDLER);

    let [fast, slow] = arms([30, 20], &[]).unwrap();
    let skew = fast[59].abs_diff(slow[39]);
    println!("engrave.c, 30:20, ours: ends {skew} cycles apart");
    assert!(skew <= HANDLER);
}
