//! `reloads.c`: the edges of a table of timer periods.

use pose2pulse::pattern_codec::c_header::Dialect;
use pose2pulse::pattern_codec::engraving::{ReloadData, ReloadHeader, TimerPeriod};
use pose2pulse::stepper_sync::{Timer, Trains};

use super::engrave::{JITTER, bounds, lags, played};
use super::simulator::simulate;

#[test]
fn every_edge_of_a_table_of_periods_is_where_the_train_has_it() {
    // The slow axis of each pair: two periods an edge, a remainder, 65536 to the cycle, five
    // periods, the shortest.
    let pairs = [
        ([30, 1], 4096),
        ([13, 7], 997),
        ([16, 1], 4096),
        ([65, 1], 4096),
        ([9, 9], 250),
    ];
    let trains = pairs.map(|(pulses, half_period)| {
        let [_, slow] = Trains::new(pulses, half_period).unwrap().axes();
        slow
    });
    let intervals: Vec<u64> = trains.into_iter().flatten().collect();
    let timer = Timer::mcs51_mode1(12_000_000).unwrap();
    let periods = timer.reloads(intervals.iter().copied()).map(|reload| {
        let reload = reload.unwrap();
        TimerPeriod {
            reload: u16::try_from(reload.value).unwrap(),
            toggles: reload.toggles,
        }
    });
    let periods: Vec<_> = periods.collect();
    let mut text = String::new();
    let header = ReloadHeader {
        dialect: Dialect::Sdcc,
        ..ReloadHeader::DEFAULT
    };
    header.write(periods.iter().copied(), &mut text).unwrap();
    let read = ReloadData::read(&text, "reloads").unwrap();
    assert!(read.periods().eq(periods.iter().copied()));

    let Some(trace) = simulate("reloads.c", ("reloads.h", &text), &[]) else {
        return;
    };
    let mut moves = played(&trace);
    assert_eq!(moves.len(), 1);
    let [edges, ..] = moves.remove(0).edges;
    let places = intervals.iter().scan(0, |place, interval| {
        *place += interval;
        Some(*place)
    });
    let (least, most) = bounds(&lags(&edges, &places.collect::<Vec<_>>()));
    println!(
        "reloads.c: {} periods, {} edges, {least} to {most} cycles behind their places",
        periods.len(),
        edges.len()
    );
    assert!(most - least <= JITTER, "{least}..={most}");
}
