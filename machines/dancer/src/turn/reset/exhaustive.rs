//! Turns that would be refused, searched once more: everything that any speeds of the last frames
//! make of a motor.

use std::collections::HashMap;

use super::{ENDING, Plan};
use crate::motor::Motor;

/// Highest number of frames at the end of a turn whose speeds are searched.
const MAX_ENDING: u16 = 12;

/// Highest number of frames that are tried out: some tens of milliseconds on a PC.
const MAX_TRIED: u32 = 1 << 21;

/// Position and accumulator.
type State = (i64, i64);

/// How a state is reached best, compared in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Arrival {
    /// How far off the easing together, in parts of a half step.
    off_easing: u64,
    magnitude: u8,
    before: State,
}

/// All states that can be after a frame; whichever is looked at first, the best arrivals are the
/// same.
type Layer = HashMap<State, Arrival>;

/// The magnitudes of a plan that ends within one half step: tracked at first, from any speeds at
/// last, of as few frames as find the end.
pub(super) fn magnitudes(plan: &Plan) -> Option<Vec<u8>> {
    let mut left = MAX_TRIED;
    let fewest = ENDING.min(plan.frames);
    for ending in fewest..=plan.frames.min(MAX_ENDING) {
        let first = plan.frames - ending;
        let motor = plan.before(first);
        let layers = layers(plan, &motor, first, &mut left)?;
        if let Some(found) = best(plan, &layers) {
            // The frames before are tracked: `first` is not after the plan's own ending.
            let mut magnitudes = plan.magnitudes(first);
            magnitudes.extend(found);
            return Some(magnitudes);
        }
    }
    None
}

/// What the frames from `first` on can make; `None` where too many frames would have to be tried.
fn layers(plan: &Plan, motor: &Motor, first: u16, left: &mut u32) -> Option<Vec<Layer>> {
    let start = Arrival {
        off_easing: 0,
        magnitude: 0,
        before: motor.state(),
    };
    let mut layer = Layer::from([(motor.state(), start)]);
    let mut layers = Vec::new();
    for next in first + 1..=plan.frames {
        let (wanted, reach) = (plan.wanted(next), plan.reach(next));
        let mut after = Layer::new();
        for (&before, arrival) in &layer {
            let motor = motor.with_state(before);
            for magnitude in 0..=motor.max_speed() {
                *left = left.checked_sub(1)?;
                let motor = plan.after(&motor, magnitude);
                let distance = plan.distance(&motor);
                // No speed leads back, and the next ones go further.
                if distance > plan.half_steps + 1 {
                    break;
                }
                // The highest speed to the end is not enough.
                if distance + reach < plan.half_steps - 1 {
                    continue;
                }
                let off = plan.parts(&motor).abs_diff(wanted);
                let arrival = Arrival {
                    off_easing: arrival.off_easing + off,
                    magnitude,
                    before,
                };
                let known = after.entry(motor.state()).or_insert(arrival);
                *known = arrival.min(*known);
            }
        }
        layers.push(core::mem::replace(&mut layer, after));
    }
    layers.push(layer);
    Some(layers)
}

/// The magnitudes to the state nearest to the end, of these to the one that kept the easing best.
fn best(plan: &Plan, layers: &[Layer]) -> Option<Vec<u8>> {
    let (last, before) = layers.split_last()?;
    let end = plan.start.position() + plan.half_steps * i64::from(plan.direction);
    let off_end = |position: i64| position.abs_diff(end);
    let best = last
        .iter()
        .min_by_key(|((position, _), arrival)| (off_end(*position), **arrival));
    let mut arrival = best.map(|(_, arrival)| *arrival)?;
    let mut magnitudes = vec![arrival.magnitude];
    for layer in before.iter().skip(1).rev() {
        arrival = *layer.get(&arrival.before)?;
        magnitudes.push(arrival.magnitude);
    }
    magnitudes.reverse();
    Some(magnitudes)
}
