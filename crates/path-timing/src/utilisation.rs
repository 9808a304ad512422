//! Utilisation of the limits by a motion along legs, segment by segment.

use crate::chain::Chain;
use crate::demand::Demand;
use crate::leg::Leg;
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot, Legs, Path, PlanError, Row};

/// A motion from rest along legs, given knot after knot.
pub(crate) struct Utilisation<'a, A: Axes, P: Path, I> {
    limits: &'a Reciprocals<A>,
    /// Those that have not begun.
    legs: I,
    leg: Option<Leg<P>>,
    demand: Demand<A>,
    /// The knot given last: its parameter, its speed, and all axes there.
    from: Option<(f64, f64, Row<A>)>,
}

/// Whether the limits of the tool count, or those of the axes alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Of {
    AxesAndTool,
    Axes,
}

impl<'a, A: Axes, P: Path<Axes = A>, I> Utilisation<'a, A, P, I>
where
    I: Iterator<Item = Result<Leg<P>, PlanError<P::Error>>>,
{
    pub(crate) fn new(limits: &'a Reciprocals<A>, legs: I) -> Self {
        Self {
            limits,
            legs,
            leg: None,
            demand: Demand::at_rest(),
            from: None,
        }
    }

    /// The factor of the time with which the segment to the next knot just keeps all limits; 0 where
    /// a leg begins.
    pub(crate) fn next(
        &mut self,
        of: Of,
        [s, speed]: [f64; 2],
        duration_s: f64,
    ) -> Result<f64, PlanError<P::Error>> {
        let begins = s <= 0.0;
        let mut stretch = 0.0;
        if begins {
            stretch = self.stop_at_rest();
            self.leg = self.legs.next().transpose()?;
        }
        let Some(leg) = &self.leg else {
            return Ok(stretch);
        };
        let row = Row::new(&leg.checked_point(s)?, speed, 0.0, duration_s);
        if let (false, Some((from_s, from_speed, from))) = (begins, self.from) {
            self.demand = self.demand.fresh();
            self.demand.add(self.limits, &from, &row);
            if let (Of::AxesAndTool, Some(tool)) = (of, leg.tool()) {
                let motion = [[from_s, s], [from_speed, speed]];
                self.demand.add_tool(tool, motion, duration_s);
            }
            stretch = self.demand.stretch();
        }
        self.from = Some((s, speed, row));
        Ok(stretch)
    }

    /// The same for the standstill after the last segment, where there is one.
    pub(crate) fn stop_at_rest(&mut self) -> f64 {
        match self.from {
            Some((_, speed, _)) if speed <= 0.0 => {
                self.demand = self.demand.fresh();
                self.demand.stop(self.limits);
                let stretch = self.demand.stretch();
                self.demand = Demand::at_rest();
                stretch
            }
            _ => 0.0,
        }
    }
}

/// The factor of the time with which the motion of all knots just keeps all limits.
pub(crate) fn stretch<L: Legs>(
    limits: &Reciprocals<L::Axes>,
    legs: &Chain<L>,
    knots: &[Knot],
    of: Of,
) -> Result<f64, PlanError<L::Error>> {
    let mut motion = Utilisation::new(limits, legs.forward(limits));
    let (mut stretch, mut duration_s) = (0.0_f64, 0.0);
    for knot in knots {
        let segment = motion.next(of, [knot.s, knot.speed], duration_s)?;
        stretch = stretch.max(segment);
        duration_s = knot.duration_s;
    }
    Ok(stretch.max(motion.stop_at_rest()))
}
