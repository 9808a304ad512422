//! `firmware/segments` against the crate's own player, step by step.

mod avr;
mod replay;

use pose2pulse::pvt_steps::{
    Direction, JoinedSegments, MinIntervals, PvtKnot, Segment, SegmentPlayer,
};

/// A row: its ticks, and where it ends, in steps and thousandths of a step per tick.
type Row = (u32, i64, i64);

/// Bytes of a wire, and the tick and the sign of each step that they stand for.
struct Wire {
    bytes: Vec<u8>,
    steps: Vec<(u64, char)>,
    /// Steps of each segment.
    counts: Vec<u16>,
}

impl Wire {
    fn of_rows(rows: &[Row]) -> Self {
        let knot = |steps: i64, thousandths: i64| PvtKnot {
            position: steps << 32,
            velocity: (thousandths << 56) / 1000,
        };
        let least = MinIntervals {
            step_ticks: 20,
            reversal_ticks: 40,
        };
        let mut axis = JoinedSegments::new(knot(0, 0), least);
        let mut wire = Self {
            bytes: Vec::new(),
            steps: Vec::new(),
            counts: Vec::new(),
        };
        for &(ticks, steps, thousandths) in rows {
            axis.push(ticks, knot(steps, thousandths)).unwrap();
            axis.by_ref().for_each(|segment| wire.push(&segment));
        }
        axis.finish();
        axis.for_each(|segment| wire.push(&segment));
        wire
    }

    fn push(&mut self, segment: &Segment) {
        let mut buffer = [0; Segment::MAX_ENCODED_LEN];
        self.bytes.extend_from_slice(segment.encode(&mut buffer));
        self.counts.push(segment.count());
        let sign = match segment.direction() {
            Direction::Positive => '+',
            Direction::Negative => '-',
        };
        let mut ticks = self.steps.last().map_or(0, |&(ticks, _)| ticks);
        let mut player = SegmentPlayer::new();
        let mut interval = Some(player.load(segment));
        while let Some(next) = interval {
            ticks += next;
            self.steps.push((ticks, sign));
            interval = player.next().map(u64::from);
        }
    }
}

/// Lines of a number and a sign.
fn steps_of(text: &str) -> Vec<(u64, char)> {
    let lines = text.lines().filter_map(|line| line.split_once(' '));
    let steps = lines.filter_map(|(number, sign)| Some((number.parse().ok()?, sign.parse().ok()?)));
    steps.collect()
}

/// A file of `firmware/segments`.
fn file(name: &str) -> String {
    format!("{}/firmware/segments/{name}", env!("CARGO_MANIFEST_DIR"))
}
