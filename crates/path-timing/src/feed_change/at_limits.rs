//! Changes of the speed by three phases, at the limits that the axes have where these begin.

use super::change::{Change, Kind};
use super::phases::{Ends, HEADS, Phases, State, TAILS, TAILS_OF_STOPS, Way};
use super::{At, Course};
use crate::Axes;

/// The parts of the axes' limits that the phases are tried with. The first that keeps them is the
/// quickest; of all lengths few do where the machine gains speed, for it has a limit, too.
const OF_LIMITS: [f64; 8] = [1.0, 0.995, 0.99, 0.98, 0.96, 0.93, 0.9, 0.85];

impl<A: Axes> Course<'_, A> {
    /// The change by three phases that begins here.
    pub(super) fn by_phases(&self, at: At, to: f64, way: Way) -> Option<Change> {
        let ahead = self.knots.get(at.index.saturating_add(1))?;
        let [head, late] = HEADS.map(|head| -head * ahead.ds);
        if at.speed <= 0.0 {
            return self.at_limits(at, &[(State::REST, head)], to, way);
        }
        // What the segment before has in its middle, and what the table has at the knot.
        let [here, between] = [self.state(at), self.state_between(at)];
        match way {
            Way::Slower => self.at_limits(at, &[(here, 0.0), (between, 0.0)], to, way),
            Way::Faster => {
                // Near to rest as from it.
                let table = self.planned_state(at.index, at.speed / self.planned(at.index));
                let starts = [(here, 0.0), (between, 0.0), (table, head), (table, late)];
                self.at_limits(at, &starts, to, way)
            }
        }
    }

    /// The same that began at one of these, so far ago, and uses most of the limits that the axes
    /// have here.
    pub(super) fn at_limits(
        &self,
        at: At,
        starts: &[(State, f64)],
        to: f64,
        way: Way,
    ) -> Option<Change> {
        let slope = self.knots.get(at.index)?.point.slope;
        let ahead = self.knots.get(at.index.saturating_add(1))?;
        let axes = self.limits.axes().iter().zip(slope.as_slice());
        let tool = ahead.tool.times(self.tool_times());
        let of_tool = [1.0 / tool.acceleration, 0.0];
        let inverse = axes.fold(of_tool, |[acceleration, jerk], (limits, slope)| {
            let slope = slope.abs();
            [
                acceleration.max(slope * limits.acceleration),
                jerk.max(slope * limits.jerk),
            ]
        });
        let tails = if to > 0.0 {
            &TAILS[..]
        } else {
            &TAILS_OF_STOPS
        };
        OF_LIMITS.iter().find_map(|part| {
            let limits @ [_, jerk] = inverse.map(|inverse| part / inverse);
            // What gains its highest speed first needs all of the jerk for that.
            let shapes = [None, Some(jerk)].into_iter().flat_map(|first| {
                (starts.iter())
                    .flat_map(move |start| tails.iter().map(move |tail| (first, *start, *tail)))
            });
            shapes
                .filter_map(|(first, (start, begun), tail)| {
                    self.within(at, (start, way, begun), [to, tail], limits, first)
                })
                .find(|change| self.holds(at, *change))
        })
    }

    /// What ends at the first knot by which it has come to a feed within an acceleration and a jerk,
    /// from where it began so far ago.
    fn within(
        &self,
        at: At,
        (start, way, begun): (State, Way, f64),
        [to, tail]: [f64; 2],
        limits: [f64; 2],
        first: Option<f64>,
    ) -> Option<Change> {
        let (mut left, mut length) = (0_usize, begun);
        let ahead = self.knots.iter().enumerate();
        for (index, knot) in ahead.skip(at.index.saturating_add(1)) {
            left = left.saturating_add(usize::from(knot.ds > 0.0));
            length += knot.ds;
            let end = self.planned_state(index, to);
            // The course rests, for as long as it is not known how it goes on: no feed ends there.
            if end.speed <= 0.0 && to > 0.0 {
                break;
            }
            let ends = Ends { start, end, way };
            let taken = length - knot.ds * tail;
            if let Some(kappa) = ends.kappa(taken, limits) {
                let phases = Phases::new(&ends, taken, kappa, first)?.having_reached(begun);
                let kind = match way {
                    Way::Slower => Kind::Slower(phases),
                    Way::Faster => Kind::Faster(phases),
                };
                return Some(Change { kind, to, left });
            }
            // There the course rests itself.
            if knot.speed <= 0.0 {
                break;
            }
        }
        None
    }
}
