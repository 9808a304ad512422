//! Rows written by hand, and the steps that they make.

use pvt_steps::{AxisSegments, Direction, MinIntervals, PvtKnot, SegmentPlayer};

/// One step in 2^-32 steps, and one step a tick in 2^-56.
pub(crate) const STEP: i64 = 1 << 32;
pub(crate) const STEP_A_TICK: i64 = 1 << 56;

pub(crate) const LEAST: MinIntervals = MinIntervals {
    step_ticks: 10,
    reversal_ticks: 30,
};

pub(crate) const fn knot(position: i64, velocity: i64) -> PvtKnot {
    PvtKnot { position, velocity }
}

/// Ticks since the start and directions, as +1 and -1, of the steps of one axis.
pub(crate) fn steps(start: PvtKnot, rows: &[(u32, PvtKnot)]) -> Vec<(u64, i64)> {
    let mut axis = AxisSegments::new(start, LEAST);
    let mut player = SegmentPlayer::new();
    let mut made = Vec::new();
    let mut ticks = 0;
    for &(row, knot) in rows {
        axis.push(row, knot).unwrap();
        for segment in axis.by_ref() {
            let sign = match segment.direction() {
                Direction::Positive => 1,
                Direction::Negative => -1,
            };
            ticks += player.load(&segment);
            made.push((ticks, sign));
            for interval in player.by_ref() {
                ticks += u64::from(interval);
                made.push((ticks, sign));
            }
        }
    }
    assert_eq!(
        axis.steps(),
        i64::from(start.position >= STEP / 2) + made.iter().map(|step| step.1).sum::<i64>()
    );
    made
}
