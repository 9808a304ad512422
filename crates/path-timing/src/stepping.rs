//! From a knot to the next: what a [`LookAhead`](crate::LookAhead) and a
//! [`Playback`](crate::Playback) do at each row.

use crate::Axes;
use crate::segment::Segment;

/// The segment to the next knot and the one after that.
pub(crate) struct Ahead<'a, A: Axes> {
    pub(crate) segment: &'a Segment<A>,
    /// From the next knot on, unless the machine rests there.
    pub(crate) later: Option<&'a Segment<A>>,
    /// The highest speed at the next knot.
    pub(crate) ceiling: f64,
    /// A speed at the next knot that holds, as a ratio to the one here.
    pub(crate) ratio: f64,
}

impl<A: Axes> Ahead<'_, A> {
    /// The speed at the next knot that is nearest to the wanted one.
    pub(crate) fn toward(&self, speed: f64, wanted: f64) -> f64 {
        if self.ceiling <= 0.0 {
            return 0.0;
        }
        let wanted = wanted.min(self.ceiling);
        if speed <= 0.0 {
            return wanted.min(self.segment.speed_from_rest());
        }
        self.segment.toward(speed, wanted, speed * self.ratio)
    }

    /// The speed at the next knot towards a rest there or at the one after it.
    pub(crate) fn hold(&self, speed: f64) -> f64 {
        if speed <= 0.0 || self.ceiling <= 0.0 || self.segment.holds(speed, 0.0) {
            return 0.0;
        }
        let known = speed * self.ratio;
        let nearest = self.segment.slowest(speed, known);
        // Braking as hard as it can before, it would crawl to the knot after it.
        let rest = self.later.map_or(0.0, Segment::speed_to_rest);
        let highest = rest.min(speed).min(self.ceiling);
        if highest > nearest && self.segment.holds(speed, highest) {
            highest
        } else {
            nearest
        }
    }
}
