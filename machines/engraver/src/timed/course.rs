//! Rows that are shaped along their course: the tool stays on its curves.
//!
//! Goal: a motion that leaves a mode of the tool at rest, and no curve. Method: the length along
//! all legs of a run is an axis, and its course over time is shaped; where a row of that is, and
//! where a leg ends, shoulder, elbow and disc are where the legs have them.

use anyhow::{Context, Result};
use path_timing::{Cubic, Path as _, Row, Shaper};

use super::leg::Leg;

/// Of the place at which a leg ends on a cubic, by halves.
const HALVES: u32 = 60;
/// Rows nearer to each other, in s, are one.
const SAME_S: f64 = 1e-9;

/// A run with the lengths at which its legs begin.
struct Course<'a> {
    run: &'a [Leg],
    starts: Vec<f64>,
    /// The leg on which the rows so far end.
    leg: usize,
    rows: Vec<Row<[f64; 3]>>,
}

/// The rows along a run, from rest to rest, with its course shaped.
pub(super) fn shaped(
    run: &[Leg],
    rows: &[Row<[f64; 3]>],
    shaper: &Shaper,
) -> Result<Vec<Row<[f64; 3]>>> {
    let starts = run.iter().scan(0.0, |end, leg| {
        let start = *end;
        *end += leg.length();
        Some(start)
    });
    let mut course = Course {
        run,
        starts: starts.collect(),
        leg: 0,
        rows: Vec::new(),
    };
    // The speed along the course does not jump where those of joints do.
    let along = rows.iter().enumerate();
    let along = along.filter(|(number, row)| *number == 0 || row.duration_s > 0.0);
    let along = along.map(|(_, row)| course.along(row));
    let along = along.collect::<Result<Vec<_>>>()?;
    let shaped = known_load::shape(&along, [*shaper])?.rows;
    let mut before = None;
    for row in shaped {
        match before {
            Some(before) => course.add_segment(&before, &row)?,
            None => course.add(&row)?,
        }
        before = Some(row);
    }
    Ok(course.rows)
}

impl Course<'_> {
    fn along(&self, row: &Row<[f64; 3]>) -> Result<Row<[f64; 1]>> {
        let start = self.starts.get(row.leg);
        let (start, leg) = start
            .zip(self.run.get(row.leg))
            .context("a row has its leg")?;
        Ok(Row {
            position: [start + row.s],
            ..row.course(leg)?
        })
    }

    /// A row of the leg on which the rows end.
    fn add(&mut self, row: &Row<[f64; 1]>) -> Result<()> {
        let start = self.starts.get(self.leg);
        let (start, leg) = start
            .zip(self.run.get(self.leg))
            .context("a row has its leg")?;
        let [along] = row.position;
        let local = Row {
            position: [along - start],
            leg: self.leg,
            ..*row
        };
        let row = local.on(leg)?;
        self.rows.push(row);
        Ok(())
    }

    /// The rows after one up to another, those between legs with them.
    fn add_segment(&mut self, from: &Row<[f64; 1]>, to: &Row<[f64; 1]>) -> Result<()> {
        let mut from = *from;
        while let Some(end) = self.starts.get(self.leg + 1).copied() {
            let [place] = to.position;
            if place < end {
                break;
            }
            let mut there = passage(&from, to, end);
            let is_last = to.time_s - there.time_s <= SAME_S;
            if is_last {
                (there.time_s, there.duration_s) = (to.time_s, to.time_s - from.time_s);
            }
            self.add(&there)?;
            self.leg += 1;
            there.duration_s = 0.0;
            self.add(&there)?;
            if is_last {
                return Ok(());
            }
            from = there;
        }
        let duration_s = to.time_s - from.time_s;
        self.add(&Row { duration_s, ..*to })
    }
}

/// The row at which a course that does not turn back comes to a place.
fn passage(from: &Row<[f64; 1]>, to: &Row<[f64; 1]>, place: f64) -> Row<[f64; 1]> {
    let mut there = Row {
        position: [place],
        ..*to
    };
    for cubic in Cubic::between(from, to) {
        let [mut low, mut high] = [0.0, 1.0];
        for _ in 0..HALVES {
            let middle = f64::midpoint(low, high);
            if cubic.position(middle) < place {
                low = middle;
            } else {
                high = middle;
            }
        }
        let [a0, a1] = cubic.accelerations();
        let mean = a0 + (a1 - a0) * high * 0.5;
        there.duration_s = high * (to.time_s - from.time_s);
        there.time_s = from.time_s + there.duration_s;
        there.velocity = [cubic.v0 + mean * there.duration_s];
    }
    there
}
