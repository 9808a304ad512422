//! What of a feed the rest of a table allows, looked at from its end before it runs.

use crate::leg::Leg;
use crate::number::LARGEST;
use crate::segment::Segment;
use crate::utilisation::{Of, stretch};
use crate::{Axes, Knot, Legs, PathPoint, PlanError, Table, profile};

/// Memory for one row of a table that runs: the highest feed from which the rest can be run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ahead {
    /// The highest feed at this row from which the rest can be run.
    pub(super) ceiling: f64,
    /// The feed at the next row that goes with it, as a ratio to this one.
    pub(super) after: f64,
}

impl<A: Axes, L: Legs<Axes = A>> Table<'_, L, A> {
    /// From the end: the highest feed at each row from which the rest can be run.
    pub(super) fn look_ahead(
        &self,
        max: f64,
        ahead: &mut [Ahead],
    ) -> Result<(), PlanError<L::Error>> {
        let mut slots = ahead.iter_mut().rev();
        let Some(mut later) = slots.next() else {
            return Ok(());
        };
        *later = Ahead {
            ceiling: max,
            after: 1.0,
        };
        let mut earlier = self.knots;
        for leg in self.chain().backward(&self.limits) {
            let leg = leg?;
            let (rest, own) = earlier.split_at(profile::last_leg(earlier).min(earlier.len()));
            earlier = rest;
            let mut own = own.iter().rev();
            let Some(last) = own.next() else { continue };
            later.ceiling = later.ceiling.min(self.corner_feed(&leg, last.speed));
            let mut end = self.velocities(&leg, last)?;
            for (knot, slot) in own.zip(&mut slots) {
                let start = self.velocities(&leg, knot)?;
                let duration_s = knot.duration_s * self.stretch;
                let segment = Segment::new(&self.limits, &start, &end, duration_s);
                *slot = look_back(&segment, [&start, &end], later.ceiling, max);
                (end, later) = (start, slot);
            }
        }
        Ok(())
    }

    /// The highest constant feed that the axes allow from end to end.
    pub(super) fn full_feed(&self) -> Result<f64, PlanError<L::Error>> {
        let stretch = stretch(&self.limits, &self.chain(), self.knots, Of::Axes)?;
        Ok(LARGEST.min(self.stretch / stretch))
    }

    /// The highest feed at which the velocities may jump at the end of a leg; 1 at least.
    fn corner_feed(&self, leg: &Leg<L::Leg>, speed: f64) -> f64 {
        if leg.joint().is_jump() {
            return (leg.joint().speed() * self.stretch / speed).max(1.0);
        }
        f64::INFINITY
    }

    /// A knot's point, slopes by time.
    fn velocities(
        &self,
        leg: &Leg<L::Leg>,
        knot: &Knot,
    ) -> Result<PathPoint<A>, PlanError<L::Error>> {
        let mut point = leg.checked_point(knot.s)?;
        point.slope = point.slope.scaled(knot.speed / self.stretch);
        Ok(point)
    }
}

/// What a segment allows at its start where its end allows `later`.
fn look_back<A: Axes>(
    segment: &Segment<A>,
    [start, end]: [&PathPoint<A>; 2],
    later: f64,
    max: f64,
) -> Ahead {
    let ceiling = if is_rest(start) {
        // Any feed is as good, since it makes no speed.
        max
    } else if is_rest(end) {
        segment.even().min(max)
    } else {
        segment.begin_evenly(later, max)
    };
    // The table itself holds.
    let ceiling = ceiling.max(max.min(1.0));
    Ahead {
        ceiling,
        after: later.min(ceiling) / ceiling,
    }
}

pub(super) fn is_rest<A: Axes>(point: &PathPoint<A>) -> bool {
    point.slope.as_slice().iter().all(|slope| *slope == 0.0)
}
