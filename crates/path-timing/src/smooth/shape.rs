//! Speeds lowered before the average is taken, so that its time need be stretched less: low ones held
//! for longer, tops cut.

use crate::Knot;

/// The highest speed of the motion at each knot, in `after`: a factor times the one in `duration_s`,
/// each held for a time before its knot and after it.
pub(super) fn hold_low_speeds(knots: &mut [Knot], factor: f64, time_s: f64) {
    for knot in &mut *knots {
        knot.after = knot.duration_s * factor;
    }
    hold(knots.iter_mut(), 1.0, factor, time_s);
    hold(knots.iter_mut().rev(), -1.0, factor, time_s);
}

/// Holds each low speed up to the first knot that is later; then the speed of the next knot counts.
fn hold<'k>(knots: impl Iterator<Item = &'k mut Knot>, direction: f64, factor: f64, time_s: f64) {
    let (mut speed, mut left, mut before) = (f64::INFINITY, 0.0, 0.0);
    for knot in knots {
        let own = knot.duration_s * factor;
        if left <= 0.0 || own <= speed {
            (speed, left) = (own, own * time_s);
        } else {
            // Nothing from one leg to the next.
            left -= ((knot.s - before) * direction).max(0.0);
        }
        knot.after = knot.after.min(speed);
        before = knot.s;
    }
}

/// Lowers the speeds around each top so that the motion stays at one speed there for a time: its
/// acceleration changes in two steps.
pub(super) fn cut_tops(knots: &mut [Knot], time_s: f64) {
    let mut from = 1;
    while let Some(top) = next_top(knots, from) {
        from = cut_top(knots, top, time_s).saturating_add(1);
    }
}

/// The first knot from one on that is faster than the one before and no slower than the one after.
fn next_top(knots: &[Knot], from: usize) -> Option<usize> {
    let before = from.saturating_sub(1);
    let mut triples = knots.get(before..)?.windows(3);
    let top = triples.position(|knots| match knots {
        [before, top, after] => top.speed > before.speed && top.speed >= after.speed,
        _ => false,
    });
    Some(from.saturating_add(top?))
}

/// Goes down both sides of a top until the motion at the speed reached takes the time to the other
/// side. The last knot that is lowered.
fn cut_top(knots: &mut [Knot], top: usize, time_s: f64) -> usize {
    let knot_at = |index: Option<usize>| knots.get(index?).copied();
    let (mut start, mut end) = (top, top);
    let mut speed = knot_at(Some(top)).map_or(0.0, |knot| knot.speed);
    let mut distance = 0.0;
    loop {
        let [first, last] = [start, end].map(|index| knot_at(Some(index)).unwrap_or_default());
        let before = knot_at(start.checked_sub(1)).unwrap_or_default();
        let after = knot_at(end.checked_add(1)).unwrap_or_default();
        let next = before.speed.max(after.speed);
        if next > speed || next <= 0.0 {
            break;
        }
        let short = speed * time_s - distance;
        if before.speed >= after.speed {
            start = start.saturating_sub(1);
            distance += (first.s - before.s).max(0.0);
        } else {
            end = end.saturating_add(1);
            distance += (after.s - last.s).max(0.0);
        }
        let over = distance - next * time_s;
        if over >= 0.0 {
            // Between the two speeds, in proportion.
            let sum = short + over;
            speed = if sum > 0.0 {
                speed + (next - speed) * (short / sum)
            } else {
                next
            };
            break;
        }
        speed = next;
    }
    for knot in knots.get_mut(start..=end).unwrap_or_default() {
        knot.speed = knot.speed.min(speed);
    }
    end
}

#[cfg(test)]
mod tests {
    use super::{cut_tops, hold_low_speeds};
    use crate::Knot;

    /// Knots at each mm with these speeds, as highest ones and as those of the motion.
    fn knots<const N: usize>(speeds: [f64; N]) -> [Knot; N] {
        let mut s = 0.0;
        speeds.map(|speed| {
            let knot = Knot {
                s,
                speed,
                duration_s: speed,
                after: 0.0,
            };
            s += 1.0;
            knot
        })
    }

    /// 2 mm/s are held for 1.5 s: up to the knot after 3 mm.
    #[test]
    fn a_low_speed_is_held_on_both_sides() {
        let mut knots = knots([9.0, 9.0, 9.0, 9.0, 9.0, 2.0, 5.0, 9.0, 9.0, 9.0, 9.0]);
        hold_low_speeds(&mut knots, 1.0, 1.25);
        let held = [9.0, 9.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 9.0, 9.0];
        assert_eq!(
            knots.map(|knot| knot.after.to_bits()),
            held.map(f64::to_bits)
        );
        hold_low_speeds(&mut knots, 0.5, 0.0);
        assert_eq!(knots[6].after.to_bits(), 2.5_f64.to_bits());
    }

    /// From 3 mm to 5 mm at 4 mm/s is half a second; a top that is long enough stays.
    #[test]
    fn a_top_is_cut_where_it_is_long_enough() {
        let speeds = [0.0, 3.0, 3.0, 4.0, 6.0, 4.0, 2.0, 5.0, 5.0, 5.0, 5.0, 0.0];
        let mut knots = knots(speeds);
        cut_tops(&mut knots, 0.5);
        let cut = [0.0, 3.0, 3.0, 4.0, 4.0, 4.0, 2.0, 5.0, 5.0, 5.0, 5.0, 0.0];
        assert_eq!(
            knots.map(|knot| knot.speed.to_bits()),
            cut.map(f64::to_bits)
        );
    }
}
