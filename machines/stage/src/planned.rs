//! The rows of a machine whose load or modes are known: within the torque of its motors, and
//! shaped.

extern crate alloc;

use alloc::collections::VecDeque;

use anyhow::Result;
use known_load::{TorqueUsed, off, shape, with_room, within_share};
use path_timing::{Corner, Path, PathPoint, Row, Shaper, Table, ToolLimits};

use crate::machine::Machine;
use crate::timed::{ChainCurve, ChainPath};

/// A motion from rest to rest.
#[derive(Debug)]
pub(crate) struct Planned {
    pub(crate) rows: Vec<Row<[f64; 2]>>,
    /// Of shaped rows, a proven bound on how far they are off those that are not, later by the
    /// shapers' delay.
    pub(crate) shaped_mm: Option<f64>,
    /// Seconds after which shaping has let all of a motion pass.
    pub(crate) delay_s: f64,
}

impl Planned {
    /// Along a chain, as fast as torque and the tolerance for shaping allow.
    pub(crate) fn new(machine: &Machine, path: &ChainPath) -> Result<Self> {
        within_share(|share| {
            let mut planned = Self {
                rows: fastest(machine, path, share)?,
                shaped_mm: None,
                delay_s: 0.0,
            };
            let mut most = 0.0_f64;
            if let Some(shapers) = machine.shapers() {
                most = planned.shape(shapers)? / path.limits.shaped_mm;
            }
            if let Some(load) = &machine.load {
                let mut torque = TorqueUsed::none(load.reserve);
                torque.add(load, &planned.rows, 0.0);
                most = most.max(torque.most_of_planned());
            }
            Ok((planned, most))
        })
    }

    /// Shapes both axes; the most by which one is off its place then.
    fn shape(&mut self, shapers: [Shaper; 2]) -> Result<f64> {
        let [x, y] = off(&self.rows, &shapers);
        self.shaped_mm = Some(x.hypot(y));
        let shaped = shape(&self.rows, shapers)?;
        (self.rows, self.delay_s) = (shaped.rows, shaped.delay_s);
        Ok(x.max(y))
    }

    /// What tells of each row on which motions the stage is.
    pub(crate) const fn felt(&self) -> Felt {
        Felt {
            delay_s: self.delay_s,
            recent: VecDeque::new(),
        }
    }
}

/// The curves that are felt at a time: that on which a row ends, and those whose motion shaping has
/// not let pass.
#[derive(Debug)]
pub(crate) struct Felt {
    delay_s: f64,
    /// When the rows of a curve have ended, and the motion on which it begins.
    recent: VecDeque<(f64, usize)>,
}

impl Felt {
    /// The first and the last motion of those felt in a row, which ends on a curve.
    pub(crate) fn motions(&mut self, row: &Row<[f64; 2]>, curve: &ChainCurve) -> [usize; 2] {
        let [first, last] = curve.motions;
        match self.recent.back_mut() {
            Some((end_s, begun)) if *begun == first => *end_s = row.time_s,
            _ => self.recent.push_back((row.time_s, first)),
        }
        let since_s = row.time_s - row.duration_s - self.delay_s;
        while self
            .recent
            .front()
            .is_some_and(|(end_s, _)| *end_s < since_s)
        {
            self.recent.pop_front();
        }
        let earliest = self.recent.front().map_or(first, |(_, first)| *first);
        [earliest.min(first), last]
    }
}

/// The fastest rows with a share of the motors' torque and of the limits, verified.
fn fastest(machine: &Machine, path: &ChainPath, share: f64) -> Result<Vec<Row<[f64; 2]>>> {
    if path.curves.is_empty() {
        return Ok(Vec::new());
    }
    let limits = path.limits.at(share);
    let cut = path.curves.iter().map(|curve| {
        Ok(Cut {
            curve: curve.within(&limits),
            segments: curve.segments()?,
        })
    });
    let cut = cut.collect::<Result<Vec<_>>>()?;
    let segments = |cut: &&Cut| cut.segments;
    let torque = match &machine.load {
        Some(load) if machine.shapers().is_some() => Some(load.straight().limits_at(share)?),
        Some(load) => Some(load.limits_at(share)?),
        None => None,
    };
    let rows: Vec<_> = with_room(|knots| {
        let curves = cut.iter();
        match &torque {
            Some(torque) => torque
                .plan(curves, limits.axes, segments, knots)
                .map(|table| table.rows().collect()),
            None => Table::plan(curves, limits.axes, segments, knots)
                .map(|table| table.rows().collect()),
        }
    })?;
    let mut verifier = path.verifier();
    for row in &rows {
        path.verify(&mut verifier, row)?;
    }
    Ok(rows)
}

/// A curve with what it is cut into.
struct Cut {
    curve: ChainCurve,
    segments: u32,
}

impl Path for Cut {
    type Axes = [f64; 2];
    type Error = <ChainCurve as Path>::Error;

    fn length(&self) -> f64 {
        self.curve.length()
    }

    fn point(&self, s: f64) -> Result<PathPoint<[f64; 2]>, Self::Error> {
        self.curve.point(s)
    }

    fn tool(&self) -> Option<ToolLimits> {
        self.curve.tool()
    }

    fn tool_rate(&self, s: f64) -> f64 {
        self.curve.tool_rate(s)
    }

    fn corner(&self) -> Corner<[f64; 2]> {
        self.curve.corner()
    }
}
