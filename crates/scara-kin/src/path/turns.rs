//! An angle along a path, at its whole turn.

/// Places at which an angle is known; from each to the next it turns by less than half a turn.
const ANCHORS: usize = 16;

/// How far an angle turns from a known place before the next is noted, in radians.
const FAR: f64 = 1.4;

/// The whole turns of an angle along a path: what is continuous when it is walked along stays so
/// when places are asked for in any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turns {
    /// Parameter and angle in radians, in their order.
    anchors: [(f64, f64); ANCHORS],
    used: usize,
}

impl Turns {
    /// From the angle at the start on.
    pub(super) const fn new(angle: f64) -> Self {
        Self {
            anchors: [(0.0, angle); ANCHORS],
            used: 1,
        }
    }

    /// An angle within half a turn of that at `s`.
    pub(super) fn near(&self, s: f64) -> f64 {
        let known = self.anchors.iter().take(self.used);
        let [(_, first), ..] = self.anchors;
        known
            .take_while(|(at, _)| *at <= s)
            .last()
            .map_or(first, |(_, angle)| *angle)
    }

    /// Takes the angle of the next place in, at most a radian from the one before; whether there
    /// was room for it.
    pub(super) fn add(&mut self, s: f64, angle: f64) -> bool {
        if (angle - self.near(s)).abs() < FAR {
            return true;
        }
        let Some(free) = self.anchors.get_mut(self.used) else {
            return false;
        };
        *free = (s, angle);
        self.used = self.used.saturating_add(1);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::Turns;

    #[test]
    fn an_angle_is_found_at_its_turn() {
        let mut turns = Turns::new(3.0);
        let angle = |s: f64| 3.0 + s;
        let mut s = 0.0;
        while turns.add(s, angle(s)) {
            s += 0.9;
        }
        assert!(s > 21.0, "{s}");
        for number in 0..1000 {
            let at = s * f64::from(number) / 1000.0;
            assert!((turns.near(at) - angle(at)).abs() < 2.4, "{at}");
        }
    }
}
