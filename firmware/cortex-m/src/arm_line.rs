//! A line of a two-link arm from rest to rest, as segments of steps for each joint.

use path_timing::{AxisLimits, Curve, Knot, Path, Table};
use pvt_steps::{AxisSegments, JoinedSegments, PvtQuantiser, PvtRow, Segment, SegmentPlayer};
use scara_kin::{Arm, ArmPath, Elbow};
use stepper_sync::{Direction, MinIntervals, Rate, StepScale};

/// Ticks of the player's timers.
pub const TICK_HZ: u32 = 25_000_000;
/// Room for the segments of one joint.
pub const MAX_BYTES: usize = 8192;
/// And how many they are at most.
const MAX_SEGMENTS: usize = 512;

/// Segments of the table.
pub const ROWS: usize = 100;
pub const STEPS_PER_TURN: f64 = 32_000.0;
pub const START_MM: [f64; 2] = [60.0, 150.0];
pub const END_MM: [f64; 2] = [200.0, -50.0];
/// The most by which the tool may leave the line.
pub const TOLERANCE_MM: f64 = 0.01;
/// Of both joints, in radians.
pub const JOINT: AxisLimits = AxisLimits {
    speed: 3.0,
    acceleration: 30.0,
    jerk: None,
};
/// Two interrupts fit in between: 32 us at 31 million instructions a second.
pub const LEAST: MinIntervals = MinIntervals {
    step_ticks: 800,
    reversal_ticks: 800,
};

/// Who plans: each has its own way to segments.
#[derive(Clone, Copy, Debug)]
pub enum Planner {
    /// A PC, which has the time to join steps over many rows.
    Pc,
    /// The microcontroller itself, row by row.
    Board,
}

/// # Panics
/// Never, as the next ones: the line is within reach.
#[must_use]
pub fn arm() -> Arm {
    Arm::new(132.0, 132.0).expect("good lengths")
}

#[must_use]
pub fn path() -> ArmPath {
    let line = Curve::line(START_MM, END_MM).expect("has a length");
    arm().path(line, Elbow::Right).expect("within reach")
}

/// At rest at the start of the path.
#[must_use]
pub fn quantiser(path: &ArmPath) -> PvtQuantiser<2> {
    let scale = StepScale::new(STEPS_PER_TURN / core::f64::consts::TAU).expect("not zero");
    let rate = Rate::from_hz(TICK_HZ).expect("not zero");
    let first = path.point(0.0).expect("within reach").position;
    PvtQuantiser::new(rate, [scale; 2], first).expect("in range")
}

/// Plans the line; the segments of shoulder and elbow as bytes, one after the other, go into the
/// buffers. Says how many bytes.
///
/// # Panics
/// Never: the line is within reach and slow enough.
pub fn plan(planner: Planner, wire: &mut [[u8; MAX_BYTES]; 2]) -> [usize; 2] {
    let path = path();
    let mut knots = [Knot::default(); ROWS + 1];
    let table = match planner {
        Planner::Pc => {
            Table::plan([path], [JOINT; 2], |_| ROWS as u32, &mut knots).expect("good limits")
        }
        Planner::Board => plan_in_f32(&path, &mut knots),
    };

    let mut quantiser = quantiser(&path);
    let mut steps = match planner {
        Planner::Pc => Quantised::joined(&quantiser),
        Planner::Board => Quantised::by_row(&quantiser),
    };
    let mut lens = [0; 2];
    for row in table.rows().skip(1) {
        let row = quantiser
            .row(row.time_s, row.position, row.velocity)
            .expect("in order");
        steps.push(&row, wire, &mut lens);
    }
    steps.finish(wire, &mut lens);
    lens
}

/// The table that the microcontroller plans, the departure looked at.
///
/// # Panics
/// Never: the line is within reach, and its rows are dense.
pub fn plan_in_f32<'k>(path: &ArmPath, knots: &'k mut [Knot<[f64; 2]>]) -> Table<'k, [f64; 2]> {
    let path = path.in_f32().expect("lengths of f32");
    let table = Table::plan_in_f32([path], [JOINT; 2], |_| ROWS as u32, knots);
    let table = table.expect("good limits");
    let departures = table.spans().map(|span| path.departure(&span));
    assert!(departures.fold(0.0, f64::max) <= TOLERANCE_MM);
    table
}

/// Both joints' rows on their way to segments.
enum Quantised {
    Joined([JoinedSegments; 2]),
    ByRow([AxisSegments; 2]),
}

impl Quantised {
    fn joined(start: &PvtQuantiser<2>) -> Self {
        Self::Joined(start.knots().map(|knot| JoinedSegments::new(knot, LEAST)))
    }

    fn by_row(start: &PvtQuantiser<2>) -> Self {
        Self::ByRow(start.knots().map(|knot| AxisSegments::new(knot, LEAST)))
    }

    fn push(&mut self, row: &PvtRow<2>, wire: &mut [[u8; MAX_BYTES]; 2], lens: &mut [usize; 2]) {
        for joint in 0..2 {
            let mut append = appender(&mut wire[joint], &mut lens[joint]);
            match self {
                Self::Joined(axes) => {
                    axes[joint]
                        .push(row.ticks, row.knots[joint])
                        .expect("slow enough");
                    axes[joint].by_ref().for_each(&mut append);
                }
                Self::ByRow(axes) => {
                    axes[joint]
                        .push(row.ticks, row.knots[joint])
                        .expect("slow enough");
                    axes[joint].by_ref().for_each(&mut append);
                }
            }
        }
    }

    fn finish(self, wire: &mut [[u8; MAX_BYTES]; 2], lens: &mut [usize; 2]) {
        if let Self::Joined(axes) = self {
            for (joint, mut axis) in axes.into_iter().enumerate() {
                axis.finish();
                axis.for_each(appender(&mut wire[joint], &mut lens[joint]));
            }
        }
    }
}

/// Appends segments to a buffer.
fn appender<'a>(wire: &'a mut [u8; MAX_BYTES], len: &'a mut usize) -> impl FnMut(Segment) + 'a {
    |segment| {
        let mut buffer = [0; Segment::MAX_ENCODED_LEN];
        let bytes = segment.encode(&mut buffer);
        wire[*len..*len + bytes.len()].copy_from_slice(bytes);
        *len += bytes.len();
    }
}

/// A joint's segments, decoded. Their times are checked here, step by step: too long for an
/// interrupt.
#[derive(Clone, Debug)]
pub struct Segments([Option<Segment>; MAX_SEGMENTS]);

impl Segments {
    /// # Panics
    /// For bytes that [`plan`] has not made.
    #[must_use]
    pub fn decoded(mut wire: &[u8]) -> Self {
        let mut segments = [None; MAX_SEGMENTS];
        for place in &mut segments {
            if wire.is_empty() {
                break;
            }
            let (segment, rest) = Segment::decode(wire).expect("encoded by this program");
            (*place, wire) = (Some(segment), rest);
        }
        assert!(wire.is_empty(), "more than {MAX_SEGMENTS} segments");
        Self(segments)
    }

    #[must_use]
    pub const fn steps(self) -> Steps {
        Steps {
            segments: self,
            next: 0,
            player: SegmentPlayer::new(),
            direction: Direction::Positive,
        }
    }
}

/// The steps of a joint's segments: ticks since the step before, and direction.
#[derive(Clone, Debug)]
pub struct Steps {
    segments: Segments,
    next: usize,
    player: SegmentPlayer,
    direction: Direction,
}

impl Iterator for Steps {
    type Item = (u32, Direction);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        if let Some(ticks) = self.player.next() {
            return Some((ticks, self.direction));
        }
        let segment = self.segments.0.get(self.next)?.as_ref()?;
        self.next += 1;
        self.direction = segment.direction();
        let ticks = self.player.load(segment);
        Some((ticks.try_into().ok()?, self.direction))
    }
}
